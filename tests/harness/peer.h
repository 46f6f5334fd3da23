/// peer.h - other engines behind the table that the command line sees Plumb through (tools/plumb/engine.h).
///
/// A peer loads a scene as Plumb does, builds the same bodies, shapes and joints in the other engine, and moves by that
/// engine's steps. After each, motion is written back into the scene's world (double), so that handlers and closed
/// forms and expectations see it. What the peer has no words for is refused by `open`, with the reason in the error's text.
#ifndef HARNESS_PEER_H
#define HARNESS_PEER_H

#include "plumb/engine.h"

/// Settings: substeps are shorter steps (of Box2D 3 its own), iterations those of velocities; `solver` 0 is the engine
/// as it comes, 1 the stiffest that its manual offers (engine_options.stiff). Where expectations are asked for, bodies may
/// sleep as the scene says; else nobody does.
#define PEER_SOLVERS "usual,stiff"

extern const engine_api peer_box2d2, peer_chipmunk;
extern const engine_api peer_box2d3; ///< only in builds with BOX2D3=/prefix

#endif
