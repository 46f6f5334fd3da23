// law_formula.c - laws that are formulas: bodies in blocks, for each law the places that it sees in columns, what comes of them.
//
// A law sees a body from its own place, along axes that are turned by its angle and go with its carrier, which within a step
// goes on evenly and turns evenly. A velocity is what x and y change by: without that of the carrier, w x d included.
// Bodies that the law does not reach take no lane; a few are taken one by one, with the same bits.
//
// What is not finite, or above MOST, counts as nothing.
//
// Reads: laws and bodies of the step. Writes: accelerations; times of rest. Cost: O(bodies steps) a formula.
#include "effects/laws.h"

#include "math/trig.h"
#include "world/island.h"
#include "world/push.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

// [m/s^2], [N/C] or [1/s]: what other laws may have at the most.
#define MOST 1e30
// So few bodies are asked one by one: a column costs as much whether it is full or not.
#define FEW 4

// A formula at a moment.
typedef struct view {
    const plumb_world *world;
    const pl_law_now *law;
    double x, y, c, s, time; // where it is, how its axes are turned
    double constants[PL_FORMULA_CONSTANTS];
} view;

// Bodies that it acts on, by their numbers in the block.
typedef struct block {
    uint32_t lanes[PL_LAW_BLOCK];
    uint32_t count;
    double columns[PL_FORMULA_REGISTERS][PL_FORMULA_LANES];
    double results[PL_FORMULA_RESULTS][PL_FORMULA_LANES]; // that are in no column
    const double *result[PL_FORMULA_RESULTS];
} block;

static void look(view *v, const plumb_world *world, const pl_law_now *law, double time)
{
    v->world = world;
    v->law = law;
    v->x = law->x + law->vx * time;
    v->y = law->y + law->vy * time;
    v->c = law->c, v->s = law->s;
    if (law->w != 0) {
        double s, c;
        pl_sincos(law->w * time, &s, &c);
        v->c = law->c * c - law->s * s;
        v->s = law->s * c + law->c * s;
    }
    pl_formula_begin(law->formula, world->time + time, v->constants);
}

// What the formula has of a body: from `to` on x, y, vx, vy, so far apart.
static void see(const view *v, const pl_law_state *at, double *to, size_t apart)
{
    const pl_law_now *law = v->law;
    const double dx = at->x - v->x, dy = at->y - v->y;
    to[PL_FORMULA_X * apart] = v->c * dx + v->s * dy;
    to[PL_FORMULA_Y * apart] = v->c * dy - v->s * dx;
    if (law->formula->uses_velocity != 0) {
        const double vx = at->vx - law->vx + law->w * dy, vy = at->vy - law->vy - law->w * dx;
        to[PL_FORMULA_VX * apart] = v->c * vx + v->s * vy;
        to[PL_FORMULA_VY * apart] = v->c * vy - v->s * vx;
    }
}

static double usable(double value)
{
    return fabs(value) <= MOST ? value : 0; // not of what is no number
}

//---- a block -------------------------------------------------------------------------------------

// The lanes that are free are what the first is.
static void fill_up(block *b, int inputs)
{
    for (int k = 0; k < inputs; ++k) {
        for (uint32_t i = b->count; i < PL_FORMULA_LANES; ++i) {
            b->columns[k][i] = b->columns[k][0];
        }
    }
}

static void run_together(const view *v, block *b, bool whole, int results)
{
    const pl_formula *f = v->law->formula;
    fill_up(b, f->uses_velocity != 0 ? PL_FORMULA_INPUTS : PL_FORMULA_Y + 1);
    pl_formula_columns_of(v->world->desc.simd_width)(f, v->constants, b->columns, whole);
    for (int k = 0; k < results; ++k) {
        const uint8_t at = f->results[k];
        b->result[k] = at < PL_FORMULA_CONSTANT ? b->columns[at] : b->results[k];
        for (uint32_t i = 0; i < b->count && at >= PL_FORMULA_CONSTANT; ++i) {
            b->results[k][i] = v->constants[at - PL_FORMULA_CONSTANT];
        }
    }
}

static void run_alone(const view *v, block *b, bool whole, int results)
{
    const pl_formula *f = v->law->formula;
    for (uint32_t i = 0; i < b->count; ++i) {
        double registers[PL_FORMULA_REGISTERS];
        for (int k = 0; k < PL_FORMULA_INPUTS; ++k) {
            registers[k] = b->columns[k][i];
        }
        pl_formula_at(f, v->constants, registers, whole);
        for (int k = 0; k < results; ++k) {
            b->results[k][i] =
                pl_formula_result_at(f, v->constants, registers, (pl_formula_result)k);
        }
    }
    for (int k = 0; k < results; ++k) {
        b->result[k] = b->results[k];
    }
}

// R J R^T, R the turn of the axes.
static void add_slopes(const view *v, const block *b, uint32_t i, double share, double out[4])
{
    const double c = v->c, s = v->s;
    double j[4];
    for (int k = 0; k < 4; ++k) {
        j[k] = share * usable(b->result[PL_FORMULA_AX_VX + k][i]);
    }
    const double xx = c * j[0] - s * j[2], xy = c * j[1] - s * j[3];
    const double yx = s * j[0] + c * j[2], yy = s * j[1] + c * j[3];
    out[0] += xx * c - xy * s, out[1] += xx * s + xy * c;
    out[2] += yx * c - yy * s, out[3] += yx * s + yy * c;
}

static void add_force(const view *v, const block *b, uint32_t i, double share, double out[2])
{
    const double fx = b->result[PL_FORMULA_AX][i], fy = b->result[PL_FORMULA_AY][i];
    const bool both = fabs(fx) <= MOST && fabs(fy) <= MOST;
    const double ax = both ? share * fx : 0, ay = both ? share * fy : 0;
    out[0] += v->c * ax - v->s * ay;
    out[1] += v->s * ax + v->c * ay;
}

// What a block of bodies, from `first` on, has of a law.
static void act(const view *v, block *b, const pl_law_system *system, uint32_t first, double *out,
                double *slopes)
{
    const pl_formula *f = v->law->formula;
    const bool drags = slopes != NULL && f->uses_velocity != 0;
    const int results = drags ? PL_FORMULA_RESULTS : PL_FORMULA_AY + 1;
    (b->count < FEW ? run_alone : run_together)(v, b, drags, results);
    for (uint32_t i = 0; i < b->count; ++i) {
        const uint32_t k = first + b->lanes[i];
        const pl_law_body *body = &system->bodies[k];
        const double hold = pl_law_hold_of(v->law->desc, body) / body->mass;
        add_force(v, b, i, f->is_potential ? -hold : hold, &out[2 * k]);
        if (drags) {
            add_slopes(v, b, i, hold, &slopes[4 * k]);
        }
    }
}

//---- who is acted on -----------------------------------------------------------------------------

// A law of higher priority replaces another there.
static bool is_replaced(const pl_law_system *system, const pl_law_now *law,
                        const pl_law_state *states, uint32_t i, double time)
{
    const pl_law_now *other = system->laws;
    for (; other < law && other->desc->priority > law->desc->priority; ++other) {
        if (other->desc->combine == PLUMB_LAW_REPLACE && other->desc->hold == law->desc->hold &&
            pl_law_acts(system, other, states, i, time)) {
            return true;
        }
    }
    return false;
}

// Those of a block, from `first` on.
static void gather(const view *v, block *b, const pl_law_system *system, const pl_law_state *states,
                   uint32_t first, double time)
{
    const pl_law_now *law = v->law;
    const bool ends = law->desc->half.x > 0 || law->reach < INFINITY;
    const uint32_t left = system->count - first, count = left < PL_LAW_BLOCK ? left : PL_LAW_BLOCK;
    b->count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const pl_law_body *body = &system->bodies[first + i];
        if (body->mass > 0 && pl_law_hold_of(law->desc, body) != 0 &&
            (!ends || pl_law_acts(system, law, states, first + i, time)) &&
            !(system->replaces && is_replaced(system, law, states, first + i, time))) {
            see(v, &states[first + i], &b->columns[0][b->count], PL_FORMULA_LANES);
            b->lanes[b->count++] = i;
        }
    }
}

static void pull(const view *v, const pl_law_system *system, const pl_law_state *states,
                 double time, double *out, double *slopes)
{
    for (uint32_t first = 0; first < system->count; first += PL_LAW_BLOCK) {
        block b;
        gather(v, &b, system, states, first, time);
        if (b.count > 0) {
            act(v, &b, system, first, out, slopes);
        }
    }
}

void pl_formulas_pull(const pl_law_system *system, const pl_law_state *states, double time,
                      double *out, double *slopes)
{
    if (system->others) {
        pl_laws_pull_plain(system, states, time, out);
    } else {
        memset(out, 0, 2 * (size_t)system->count * sizeof *out);
    }
    if (slopes != NULL) {
        memset(slopes, 0, 4 * (size_t)system->count * sizeof *slopes);
    }
    for (uint32_t k = 0; k < system->law_count; ++k) {
        view v;
        if (system->laws[k].formula != NULL) {
            look(&v, system->world, &system->laws[k], time);
            pull(&v, system, states, time, out, slopes);
        }
    }
}

//---- energy --------------------------------------------------------------------------------------

double pl_formula_potential(const plumb_world *world, const pl_law_now *law, double x, double y)
{
    const pl_law_state at = { x, y, 0, 0 };
    double registers[PL_FORMULA_REGISTERS];
    view v;
    look(&v, world, law, 0);
    see(&v, &at, registers, 1);
    pl_formula_at(law->formula, v.constants, registers, true);
    return usable(pl_formula_result_at(law->formula, v.constants, registers, PL_FORMULA_POTENTIAL));
}

//---- rest ----------------------------------------------------------------------------------------

// [s] for which what rests does not feel a change.
#define LONG 100

// Rows that rest, and what a law gives them.
typedef struct sleepers {
    pl_law_body bodies[PL_LAW_BLOCK];
    pl_law_state states[PL_LAW_BLOCK];
    double now[2 * PL_LAW_BLOCK], then[2 * PL_LAW_BLOCK];
    uint32_t count;
} sleepers;

static void heed_block(plumb_world *world, const pl_law_now *law, sleepers *s, double dt)
{
    const pl_law_system one = { .world = world,
                                .laws = law,
                                .law_count = 1,
                                .bodies = s->bodies,
                                .count = s->count,
                                .replaces = true,
                                .formulas = true,
                                .others = true };
    const double least = (double)pl_push_tolerance(world) * dt / LONG;
    pl_laws_pull(&one, s->states, 0, s->now, NULL);
    pl_laws_pull(&one, s->states, dt, s->then, NULL);
    for (uint32_t i = 0; i < s->count; ++i) {
        const double ax = s->then[2 * i] - s->now[2 * i],
                     ay = s->then[2 * i + 1] - s->now[2 * i + 1];
        const uint32_t row = s->bodies[i].row;
        if (ax * ax + ay * ay <= least * least) {
            continue;
        }
        if (row < world->dynamic_count) {
            world->bodies.rest_time[row] = PL_NOT_RESTING;
        } else {
            pl_sleep_disturb(world, row);
        }
    }
    s->count = 0;
}

void pl_formulas_heed(plumb_world *world, double dt)
{
    const pl_law_step *step = &world->laws.step;
    const uint32_t sleeping = pl_partition_first(world, PL_PART_ASLEEP);
    const uint32_t all = world->dynamic_count + world->asleep_count;
    for (uint32_t k = 0; k < step->law_count; ++k) {
        pl_law_now law = pl_laws_now(world)[k];
        sleepers s;
        s.count = 0;
        if (law.formula == NULL || !law.formula->uses_time) {
            continue;
        }
        law.vx = law.vy = law.w = 0; // where it goes, laws.c heeds
        for (uint32_t i = 0; i < all; ++i) {
            const uint32_t row =
                i < world->dynamic_count ? i : sleeping + (i - world->dynamic_count);
            if (row < sleeping && world->bodies.rest_time[row] < 0) {
                continue; // it does not rest as it is
            }
            s.bodies[s.count] = pl_law_body_of(world, row);
            s.states[s.count++] = pl_law_state_of(world, row);
            if (s.count == PL_LAW_BLOCK) {
                heed_block(world, &law, &s, dt);
            }
        }
        heed_block(world, &law, &s, dt);
    }
}
