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
// O(those that attract x all that are coupled), where some of them are slow or asleep.
#include "effects/laws.h"

#include "world/island.h"
#include "world/push.h"

#include <math.h>

// A coupled body, and what the others give it.
typedef struct pulled {
    pl_pole pole;
    double x, y, torque; // [N], [N m]
    bool asked;          // it is held, and slow or asleep
} pulled;

bool pl_law_rest_reserve(plumb_world *world)
{
    pl_law_step *s = &world->laws.step;
    const size_t count = s->source_count > 0 ? s->coupled_count : 0;
    return pl_buffer_reserve(&world->memory, &s->pulled, count * sizeof(pulled));
}

static bool is_free(const plumb_world *world, const pl_law_body *body)
{
    return body->mass > 0 && pl_law_way_of(world, body->row) < PL_LAW_HELD;
}

// Whether anybody is to be asked.
static bool gather(const plumb_world *world, pulled *all)
{
    const pl_law_step *s = &world->laws.step;
    bool any = false;
    for (uint32_t i = 0; i < s->coupled_count; ++i) {
        const pl_law_body *body = &pl_law_bodies(world)[i];
        const bool slow = body->mass == 0 || world->bodies.rest_time[body->row] >= 0;
        all[i] = (pulled){ .pole = pl_pole_of(world, body),
                           .asked = i < s->source_count && slow && !is_free(world, body) };
        any |= all[i].asked;
    }
    return any;
}

static void add_pair(const pl_law_now *law, pulled *a, pulled *b)
{
    const double dx = b->pole.x - a->pole.x, dy = b->pole.y - a->pole.y;
    const double f =
        pl_law_pair(law, a->pole.body, b->pole.body) * pl_law_falloff(law, dx * dx + dy * dy);
    const pl_dipole_push more = pl_dipole_pair(law, &a->pole, &b->pole);
    const double x = more.fx - f * dx, y = more.fy - f * dy;
    b->x += x, b->y += y, b->torque += more.torque;
    a->x -= x, a->y -= y, a->torque += more.answer;
}

static void add_pairs(const pl_law_step *s, const pl_law_now *law, pulled *all)
{
    for (uint32_t i = 0; i < s->source_count && law->desc->kind == PLUMB_LAW_MUTUAL; ++i) {
        for (uint32_t k = i + 1; k < s->coupled_count; ++k) {
            if (all[i].asked || all[k].asked) {
                add_pair(law, &all[i], &all[k]);
            }
        }
    }
}

// The pull is not the one under which it rests; from now on it is.
static bool is_pulled_anew(plumb_world *world, const pulled *p)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t row = p->pole.body->row;
    // Who attracts has a record: of a charge, a dipole, an attraction.
    pl_body_settings *t = (pl_body_settings *)world->settings.items.data + b->settings[row] - 1;
    const double ease = (double)b->inv_mass[row];
    const double now[] = { ease * p->x, ease * p->y,
                           p->torque * (double)(b->inv_inertia[row] * b->extent[row]) };
    const double x = now[0] - (double)t->pull_x, y = now[1] - (double)t->pull_y,
                 tip = now[2] - (double)t->pull_tip;
    const double least = (double)pl_push_tolerance(world);
    const double share =
        (double)PL_EVEN * sqrt(now[0] * now[0] + now[1] * now[1] + now[2] * now[2]);
    const double most = share > least ? share : least;
    if (x * x + y * y + tip * tip <= most * most) {
        return false;
    }
    t->pull_x = (real)now[0], t->pull_y = (real)now[1], t->pull_tip = (real)now[2];
    return true;
}

static void rest_held(plumb_world *world)
{
    const pl_law_step *s = &world->laws.step;
    pulled *all = s->pulled.data;
    if (s->source_count == 0 || !gather(world, all)) {
        return;
    }
    for (uint32_t k = 0; k < s->law_count; ++k) {
        add_pairs(s, &pl_laws_now(world)[k], all);
    }
    for (uint32_t i = 0; i < s->source_count; ++i) {
        if (all[i].asked && is_pulled_anew(world, &all[i])) {
            pl_sleep_disturb(world, all[i].pole.body->row);
        }
    }
}

void pl_law_rest(plumb_world *world)
{
    const pl_law_step *s = &world->laws.step;
    real *rest_time = world->bodies.rest_time;
    rest_held(world);
    for (uint32_t i = 0; i < s->source_count && s->coupled_count > 1; ++i) {
        const pl_law_body *body = &pl_law_bodies(world)[i];
        if (is_free(world, body)) {
            rest_time[body->row] = PL_NOT_RESTING;
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
