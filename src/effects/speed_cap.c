// speed_cap.c - bodies that are never faster than they may be, nor spin faster.
//
// As a row of the substep: the acceleration is cut so that it leads to the cap and no farther. What contacts then add
// is cut when the body takes over what the solver made of it; in free flight see flight.c.
//
// Reads: settings, solver bodies. Writes: accelerations, velocities. Order: behind all that accelerates.
// Cost: O(capped bodies) a substep.
#include "effects/gather.h"
#include "plumb/math.h"
#include "world/substep.h"
#include "world/state.h"

typedef struct pl_capper {
    real max_speed, max_spin; // [m/s], [rad/s] in the world's time; 0: none
    uint32_t slot;
} pl_capper;

bool pl_caps_find(plumb_world *world)
{
    pl_effects *e = &world->effects;
    const pl_solver *s = &world->solver;
    const pl_body_settings *settings = world->settings.items.data;
    const uint32_t slots = s->slot_count > 0 ? s->dynamic_slots : 0;
    if (!pl_buffer_reserve(&world->memory, &e->cappers,
                           (size_t)world->settings.count * sizeof(pl_capper))) {
        return false;
    }
    const uint32_t *rows = s->rows.data, *records = world->bodies.settings;
    pl_capper *cappers = e->cappers.data;
    e->capper_count = 0;
    for (uint32_t slot = 0; slot < slots; ++slot) {
        const uint32_t record = records[rows[slot]];
        const pl_body_settings *t = record == 0 ? NULL : &settings[record - 1];
        if (t != NULL && (t->max_speed > 0 || t->max_spin > 0) && t->time_scale > 0) {
            cappers[e->capper_count++] =
                (pl_capper){ t->time_scale * t->max_speed, t->time_scale * t->max_spin, slot };
        }
    }
    return true;
}

static void cap(const pl_capper *c, const pl_solver_body *body, pl_solver_motion *motion, real h)
{
    plumb_vec2 v = { body->vx + h * motion->ax, body->vy + h * motion->ay };
    real speed = plumb_vec2_magnitude(v);
    if (c->max_speed > 0 && speed > c->max_speed) {
        real share = c->max_speed / speed;
        motion->ax = (near_real)((share * v.x - body->vx) / h);
        motion->ay = (near_real)((share * v.y - body->vy) / h);
    }
    real spin = body->w + h * motion->aw, most = c->max_spin;
    if (c->max_spin > 0 && plumb_abs(spin) > most) {
        motion->aw = (near_real)((plumb_clamp(spin, -most, most) - body->w) / h);
    }
}

void pl_caps_row(pl_substep *s)
{
    const plumb_world *world = s->world;
    const pl_effects *e = &world->effects;
    const pl_capper *cappers = e->cappers.data;
    const pl_share mine =
        pl_substep_share(cappers, sizeof(pl_capper), offsetof(pl_capper, slot), e->capper_count, s);
    for (uint32_t i = mine.first; i < mine.end; ++i) {
        const uint32_t slot = cappers[i].slot;
        cap(&cappers[i], &pl_solver_bodies(&world->solver)[slot],
            &pl_solver_motions(&world->solver)[slot], (real)s->h);
    }
}

void pl_caps_take_over(plumb_world *world, uint32_t row, const pl_body_settings *t)
{
    pl_bodies *b = &world->bodies;
    real speed = plumb_vec2_magnitude(plumb_v2(b->vx[row], b->vy[row]));
    if (!world->effects.caps) {
        return;
    }
    if (t->max_speed > 0 && speed > t->max_speed) {
        b->vx[row] *= t->max_speed / speed;
        b->vy[row] *= t->max_speed / speed;
    }
    if (t->max_spin > 0) {
        b->w[row] = plumb_clamp(b->w[row], -t->max_spin, t->max_spin);
    }
}
