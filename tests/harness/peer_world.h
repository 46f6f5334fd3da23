/// peer_world.h - what peer.c and peer_build.c know of a scene that another engine moves.
#ifndef HARNESS_PEER_WORLD_H
#define HARNESS_PEER_WORLD_H

#include "harness/engine.h"
#include "plumb/engine_session.h"

enum { PEER_JOINTS = 4096 };

/// A body here and there.
struct pair {
    plumb_body body;
    int other; ///< < 0: destroyed
    bool dynamic, moves;
    double v[3]; ///< as written back last
};

/// A joint here and there, and its motor as it was brought over last.
struct tie {
    plumb_joint joint;
    int other;
    bool motor;
    double speed, max;
};

struct peer {
    const struct engine *engine;
    struct engine_world *world;
    engine_mover mover;
    struct pair *pairs;
    int count;
    int ground; ///< a static body of the peer that stands for the world
    struct tie ties[PEER_JOINTS];
    int tie_count;
    bool bare;     ///< nobody looks: only the peer's own step is taken
    bool diverged; ///< its motion is no longer finite
    double dt;
    double last;      ///< [s] the last step that it was asked for
    bool stirred;     ///< another one than before
    char reason[128]; ///< why the scene cannot be brought over
};

/// Says why; false.
bool pl_peer_refuse(struct peer *p, const char *reason);
/// Makes the peer's world out of the scene's. False: p->reason.
bool pl_peer_build(struct peer *p, const engine_settings *settings, const scene *s);

#endif
