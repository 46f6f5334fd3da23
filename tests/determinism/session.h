// session.h - random sessions of a game: a world of everything at once, and a user who does anything with it
// at any time, by calls, commands, systems and hooks.
//
// What is done follows from the seed and the world's state alone: a session that is begun twice takes the
// same calls. Where memory runs out, where the world goes back to an image, and what is asked in between is
// the caller's business.
#ifndef SESSION_H
#define SESSION_H

#include "plumb/plumb.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { SESSION_BODIES = 24, SESSION_JOINTS = 12, SESSION_MATERIALS = 4 };

typedef struct session {
    plumb_world *world;
    uint32_t seed; // of what is done next
    bool wrapped;
    plumb_body body[SESSION_BODIES];
    plumb_joint joint[SESSION_JOINTS];
    plumb_material material[SESSION_MATERIALS];
    plumb_component mark, tag, late;
    bool has_systems;
} session;

// A world by the seed. `settings`: allocator, threads, width and capacities are taken from it; may be null.
void session_begin(session *s, uint32_t seed, const plumb_world_desc *settings);
// The same with nothing in it: what an image of the session can be restored into. `like`: whose registrations.
void session_twin(session *s, const session *like, const plumb_world_desc *settings);
// What the user does before a step: some calls, from none to many.
void session_act(session *s);
// [s] of the next step.
plumb_real session_dt(session *s);
void session_end(session *s);

#endif
