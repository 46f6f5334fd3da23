/// plumb.h - everything: include this one.
#ifndef PLUMB_PLUMB_H
#define PLUMB_PLUMB_H

#include "plumb/base.h"
#include "plumb/types.h"
#include "plumb/math.h"
#include "plumb/matrix.h"
#include "plumb/geometry.h"
#include "plumb/world.h"
#include "plumb/schema.h"
#include "plumb/material.h"
#include "plumb/body.h"
#include "plumb/shape.h"
#include "plumb/joint.h"
#include "plumb/character.h"
#include "plumb/ecs.h"
#include "plumb/event.h"
#include "plumb/sleep.h"
#include "plumb/query.h"
#include "plumb/snapshot.h"
#include "plumb/batch.h"
#include "plumb/record.h"
#include "plumb/effect.h"
#include "plumb/law.h"
#include "plumb/fracture.h"
#include "plumb/liquid.h"
#include "plumb/loop.h"
#include "plumb/accuracy.h"
#include "plumb/measure.h"
#include "plumb/watchdog.h"
#include "plumb/draw.h"

#endif
