// law_rest.c - rest under laws: who attracts others and is held by something rests while their pull on it stays.
//
// Bodies that attract go on moving others, and each other, so those that nothing holds never rest. The pull on one that a contact,
// a joint or a lock holds is taken down. It is the same while it differs by less than what samples of rest do not see
// (world/push.c), or by less than that share of it by which bodies that count as at rest may move: PL_EVEN. Changes that creep add
// up, as of forces, since the pull is compared with what was taken down, awake and asleep. So a chain of magnets falls asleep, and
// wakes when another comes near, turns, changes or goes.
//
// A needle on a pin that is damped creeps to where it belongs, slow and even as what rests is, and nothing but the field stops it: it
// rests when it stands still, as what floats does.
//
// Reads: laws and bodies of the step. Writes: records of bodies, times of rest. Order: when nothing can fail any more. Cost:
// O(those that attract and are held x all that are coupled).
#include "effects/laws.h"

#include "world/island.h"
#include "world/push.h"

#include <math.h>

// [m/s^2] of the centre; of the farthest point, by the turn.
typedef struct pull {
    double x, y, tip;
} pull;

static pull pull_on(const plumb_world *world, const pl_law_body *body)
{
    const pl_law_step *s = &world->laws.step;
    const pl_bodies *b = &world->bodies;
    const pl_pole here = pl_pole_of(world, body);
    pull p = { 0, 0, 0 };
    for (uint32_t k = 0; k < s->law_count; ++k) {
        const pl_law_now *law = &pl_laws_now(world)[k];
        for (uint32_t i = 0; i < s->coupled_count && law->desc->kind == PLUMB_LAW_MUTUAL; ++i) {
            const pl_law_body *other = &pl_law_bodies(world)[i];
            if (other->row == body->row) {
                continue;
            }
            const pl_pole there = pl_pole_of(world, other);
            const double dx = there.x - here.x, dy = there.y - here.y;
            const double f = pl_law_pair(law, body, other) * pl_law_falloff(law, dx * dx + dy * dy);
            const pl_dipole_push more = pl_dipole_pair(law, &there, &here);
            p.x += f * dx + more.fx, p.y += f * dy + more.fy;
            p.tip += more.torque;
        }
    }
    const double ease = (double)b->inv_mass[body->row];
    p.x *= ease, p.y *= ease;
    p.tip *= (double)(b->inv_inertia[body->row] * b->extent[body->row]);
    return p;
}

// The pull is not the one under which it rests; from now on it is.
static bool is_pulled_anew(plumb_world *world, const pl_law_body *body)
{
    // Who attracts has a record: of a charge, a dipole, an attraction.
    pl_body_settings *t =
        (pl_body_settings *)world->settings.items.data + world->bodies.settings[body->row] - 1;
    const pull now = pull_on(world, body);
    const double x = now.x - (double)t->pull_x, y = now.y - (double)t->pull_y,
                 tip = now.tip - (double)t->pull_tip;
    const double least = (double)pl_push_tolerance(world);
    const double share = (double)PL_EVEN * sqrt(now.x * now.x + now.y * now.y + now.tip * now.tip);
    const double most = share > least ? share : least;
    if (x * x + y * y + tip * tip <= most * most) {
        return false;
    }
    t->pull_x = (real)now.x, t->pull_y = (real)now.y, t->pull_tip = (real)now.tip;
    return true;
}

void pl_law_rest(plumb_world *world)
{
    const pl_law_step *s = &world->laws.step;
    real *rest_time = world->bodies.rest_time;
    for (uint32_t i = 0; i < s->source_count; ++i) {
        const pl_law_body *body = &pl_law_bodies(world)[i];
        const bool free = body->mass > 0 && pl_law_way_of(world, body->row) < PL_LAW_HELD;
        if (free && s->coupled_count > 1) {
            rest_time[body->row] = PL_NOT_RESTING;
        } else if (!free && is_pulled_anew(world, body)) {
            pl_sleep_disturb(world, body->row);
        }
    }
    for (uint32_t i = 0; i < s->body_count && world->settings.dipoles > 0; ++i) {
        const pl_law_body *body = &pl_law_bodies(world)[i];
        if (body->mass > 0 && pl_law_has_dipole(body) &&
            pl_law_way_of(world, body->row) < PL_LAW_TOUCHES &&
            !pl_stands_still(world, body->row)) {
            rest_time[body->row] = PL_NOT_RESTING;
        }
    }
}
