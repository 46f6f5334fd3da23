// fall.c - falling asleep: for how long each body has rested, and which islands rest as a whole.
//
// A body rests while it is slower than sleep_speed and goes evenly: from one half of sleep_time to
// the next, its way must not change by more than a fiftieth of what sleep_speed makes in
// sleep_time. A block that begins to slide, or a large slow pendulum at its turning point, is slow
// and not at rest; a heap that creeps is. In the defaults, what accelerates by 8 mm/s^2 stays
// awake. Turning counts by the farthest point: sqrt(v^2 + (w r)^2), and the way likewise.
//
// Islands are looked for eight times in sleep_time, by the world's clock, so that none falls
// asleep sooner or later for what others do, and only when some body has rested for sleep_time:
// union-find with path halving (Tarjan 1983) over the bodies that are candidates, by the contacts of
// this step and the joints. A contact or joint of a candidate with one that is not, or with a
// kinematic one that moves, holds its island awake; so does what drives it (driven.c). An island that
// touches nothing fixed and is joined to nothing fixed floats: nothing would stop it, so it is at rest only if it
// stands still.
//
// What falls asleep is taken out of pair list and manifolds, of which it is the last to see this
// step, and its rows change partition: nothing after this pass knows of it. Reads: velocities,
// pairs, joints. Writes: times of rest; islands, rows, pairs, manifolds, sleep events. Order: after
// the narrow phase, before anything has moved. Cost: a dozen instructions an awake body and step;
// O(pairs + joints) when islands are looked for.
#include "world/push.h"
#include "world/marks.h"
#include "world/island.h"
#include "joints/joint.h"
#include "internal_edges/internal_edges.h"
#include "sleep/sleep.h"
#include "core/quad.h"
#include "narrow/surface.h"
#include "world/check.h"
#include "world/rows.h"

#define LOOKS 8 // [-] for islands, in sleep_time

// [-] of sleep_speed, below which what floats stands still: by default 3 mm a minute.
#define STILL ((real)1e-3)

// Of a member, in `held`.
#define HELD     1u // something keeps it awake
#define ANCHORED 2u // it touches, or is joined to, what is fixed

//---- rest ----------------------------------------------------------------------------------------

static real square(real v)
{
    return v * v;
}

// Rested for two samples, half of sleep_time each.
static bool is_candidate(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return b->rest_samples[row] >= 2 && b->rest_time[row] >= 0 &&
           (b->flags[row] & PL_BODY_NO_SLEEP) == 0;
}

static void begin_sample(pl_bodies *b, uint32_t row)
{
    b->rest_time[row] = 0;
    b->rest_x[row] = b->center_x[row];
    b->rest_y[row] = b->center_y[row];
    b->rest_c[row] = b->c[row];
    b->rest_s[row] = b->s[row];
    pl_push_keep(b, row);
}

// Half of sleep_time after the last sample: compares the way since with the one before.
static void take_sample(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    real x = b->center_x[row] - b->rest_x[row], y = b->center_y[row] - b->rest_y[row];
    real turn = b->s[row] * b->rest_c[row] - b->c[row] * b->rest_s[row];
    real change = square(x - b->rest_dx[row]) + square(y - b->rest_dy[row]) +
                  square((turn - b->rest_turn[row]) * b->extent[row]);
    real way = square(x) + square(y) + square(turn * b->extent[row]);
    real even = PL_EVEN * world->desc.sleep_speed * world->desc.sleep_time;
    real slow = world->desc.sleep_speed * b->rest_time[row];
    pl_push_sample(world, row);
    bool goes_on =
        b->rest_samples[row] > 0 && !pl_push_differs(world, row, pl_push_tolerance(world));
    b->rest_samples[row] = goes_on && change <= square(even) && way <= square(slow) ? 2 : 1;
    b->rest_dx[row] = x;
    b->rest_dy[row] = y;
    b->rest_turn[row] = turn;
    begin_sample(b, row);
    if (is_candidate(world, row)) {
        // Until it has been looked at again, and more.
        world->sleep.candidate_in = world->desc.sleep_time;
    }
}

// Four rows at once: this is all that sleeping costs who is awake. What lies behind the last row is
// in columns that are longer than that, and means nothing.
// `a` where the mask is set, else `b`.
#define EITHER(mask, a, b) ((pl_quad)(((mask) & (pl_quad_mask)(a)) | (~(mask) & (pl_quad_mask)(b))))

// The time of each row goes on, begins (0) or is void. True when one begins, or a sample is due.
static bool go_on(const pl_bodies *b, uint32_t count, real slow, real half, real passed)
{
    const pl_quad *vx = (const pl_quad *)b->vx, *vy = (const pl_quad *)b->vy,
                  *w = (const pl_quad *)b->w;
    const pl_quad *extent = (const pl_quad *)b->extent;
    pl_quad *rest_time = (pl_quad *)b->rest_time;
    const pl_quad zero = { 0 }, not_resting = zero + PL_NOT_RESTING;
    pl_quad_mask due = { 0 };
    for (uint32_t i = 0; i < (count + 3) / 4; ++i) {
        pl_quad tip = w[i] * extent[i];
        pl_quad speed = vx[i] * vx[i] + vy[i] * vy[i] + tip * tip;
        pl_quad time = EITHER(rest_time[i] < zero, zero, rest_time[i] + passed);
        time = EITHER(speed <= zero + slow, time, not_resting);
        rest_time[i] = time;
        due |= (time == zero) | (time >= zero + half);
    }
    return (due[0] | due[1] | due[2] | due[3]) != 0;
}

// `passed` [s]: the step before.
static void time_bodies(plumb_world *world, real passed)
{
    pl_bodies *b = &world->bodies;
    const real half = world->desc.sleep_time / 2;
    if (!go_on(b, world->dynamic_count, square(world->desc.sleep_speed), half, passed)) {
        return;
    }
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (b->rest_time[row] >= half) {
            take_sample(world, row);
        } else if (b->rest_time[row] == 0) {
            begin_sample(b, row);
            b->rest_samples[row] = 0;
        }
    }
}

// In a step that is taken anew: those that began to rest anew when a body was taken out begin now, as they would
// have, had it gone before the step.
static void time_unsettled(plumb_world *world)
{
    pl_bodies *b = &world->bodies;
    const real slow = square(world->desc.sleep_speed);
    for (uint32_t row = 0; row < (world->dynamic_count + 3) / 4 * 4; ++row) { // as go_on does
        const real tip = b->w[row] * b->extent[row];
        if (b->rest_time[row] < 0 &&
            square(b->vx[row]) + square(b->vy[row]) + square(tip) <= slow) {
            b->rest_time[row] = 0;
            if (row < world->dynamic_count) {
                begin_sample(b, row);
                b->rest_samples[row] = 0;
            }
        }
    }
}

//---- links ---------------------------------------------------------------------------------------

// A contact of the last narrow phase, or one whose end event is still to come.
static bool is_linked(const pl_pair *pair)
{
    return pair->manifold != PL_NONE || (pair->flags & PL_PAIR_TOUCHING) != 0;
}

// Body rows of a pair; false when one of its pieces has gone or changed since the pair was made.
static bool rows_of(const plumb_world *world, const pl_pair *pair, uint32_t *a, uint32_t *b)
{
    const pl_pieces *p = &world->pieces;
    *a = p->body[pair->a];
    *b = p->body[pair->b];
    return p->kind[pair->a] != PL_PIECE_FREE && p->serial[pair->a] <= world->broad.serial &&
           p->kind[pair->b] != PL_PIECE_FREE && p->serial[pair->b] <= world->broad.serial;
}

// What touches an immovable body that was changed begins to rest anew.
static void unsettle_around_changed(plumb_world *world, uint32_t pair_count)
{
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    pl_bodies *b = &world->bodies;
    const uint32_t now = (uint32_t)(world->step_count + 1);
    if (world->sleep.changed_step != world->step_count + 1) {
        return;
    }
    for (uint32_t i = 0; i < pair_count; ++i) {
        uint32_t r = pairs[i].body_a, q = pairs[i].body_b;
        if (is_linked(&pairs[i]) && (b->changed_step[r] == now || b->changed_step[q] == now)) {
            b->rest_time[r] = b->rest_time[q] = PL_NOT_RESTING;
        }
    }
}

//---- islands -------------------------------------------------------------------------------------

static uint32_t root_of(uint32_t *parents, uint32_t row)
{
    while (parents[row] != row) {
        row = parents[row] = parents[parents[row]];
    }
    return row;
}

// The lower row becomes the root: parents never lie above their children.
static void unite(uint32_t *parents, uint32_t a, uint32_t b)
{
    a = root_of(parents, a);
    b = root_of(parents, b);
    if (a < b) {
        parents[b] = a;
    } else {
        parents[a] = b;
    }
}

static bool moves(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return b->vx[row] != 0 || b->vy[row] != 0 || b->w[row] != 0;
}

// Keeps nobody awake: static, kinematic and at rest, or the world.
static bool is_calm(const plumb_world *world, uint32_t row)
{
    return row >= world->dynamic_count + world->kinematic_count ||
           (row >= world->dynamic_count && !moves(world, row));
}

// A contact or joint of two rows; PL_NONE: the world. Only members have a parent.
static void link_rows(plumb_world *world, uint32_t a, uint32_t b)
{
    uint32_t *parents = world->sleep.parents.data;
    uint8_t *held = world->sleep.held.data;
    bool member_a = a < world->dynamic_count && parents[a] != PL_NONE;
    bool member_b = b < world->dynamic_count && parents[b] != PL_NONE;
    if (member_a && member_b) {
        unite(parents, a, b);
    } else if (member_a && !is_calm(world, b)) {
        held[a] |= HELD;
    } else if (member_b && !is_calm(world, a)) {
        held[b] |= HELD;
    }
}

static void hold_rows(plumb_world *world, uint32_t a, uint32_t b)
{
    const uint32_t *parents = world->sleep.parents.data, members = world->dynamic_count;
    uint8_t *held = world->sleep.held.data;
    if (a < members && parents[a] != PL_NONE) {
        held[a] |= HELD;
    }
    if (b < members && parents[b] != PL_NONE) {
        held[b] |= HELD;
    }
}

// What is fixed bears or ties a member.
static void anchor_rows(plumb_world *world, uint32_t a, uint32_t b)
{
    const uint32_t *parents = world->sleep.parents.data, members = world->dynamic_count;
    uint8_t *held = world->sleep.held.data;
    if (a < members && b >= members && parents[a] != PL_NONE) {
        held[a] |= ANCHORED;
    } else if (b < members && a >= members && parents[b] != PL_NONE) {
        held[b] |= ANCHORED;
    }
}

static uint32_t row_of(const plumb_world *world, plumb_body body)
{
    return plumb_is_null(body) ? PL_NONE : pl_body_row(world, body);
}

// Unites the members that are linked; afterwards the parent of each is its root.
static void link_members(plumb_world *world, uint32_t pair_count)
{
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const pl_manifold *m = pl_manifolds(&world->narrow);
    uint32_t a, b;
    for (uint32_t i = 0; i < pair_count; ++i) {
        if (is_linked(&pairs[i]) && rows_of(world, &pairs[i], &a, &b)) {
            link_rows(world, a, b);
            if ((pairs[i].flags & PL_PAIR_TOUCHING) != 0) {
                anchor_rows(world, a, b);
            }
            if (pairs[i].manifold < world->narrow.manifold_count &&
                pl_sleep_is_carried(world, &m[pairs[i].manifold])) {
                hold_rows(world, a, b);
            }
        }
    }
    uint32_t joint_count = pl_joints_awake(world);
    for (uint32_t i = 0; i < joint_count; ++i) {
        const pl_joint *j = pl_joint_awake(&world->joints, i);
        a = row_of(world, j->a.body), b = row_of(world, j->b.body);
        link_rows(world, a, b);
        anchor_rows(world, a, b);
        if (pl_sleep_is_driven(world, j)) {
            hold_rows(world, a, b);
        }
    }
    uint32_t *parents = world->sleep.parents.data;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (parents[row] != PL_NONE) {
            parents[row] = parents[parents[row]];
        }
    }
}

static bool reserve_members(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    return pl_buffer_reserve(&world->memory, &s->parents,
                             world->dynamic_count * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &s->held, world->dynamic_count);
}

// Whom a character pushes or weighs on is up with it. Returns how many members that were.
static uint32_t leave_out_pushed_by_characters(plumb_world *world)
{
    uint32_t *parents = world->sleep.parents.data, count = 0;
    const pl_shove *pushes = world->characters.pushes.data;
    for (uint32_t i = 0; world->characters.moved && i < world->characters.push_count; ++i) {
        const uint32_t row = pl_body_row(world, pushes[i].body);
        if (row < world->dynamic_count && parents[row] != PL_NONE && pl_is_pushed(world, row)) {
            parents[row] = PL_NONE;
            ++count;
        }
    }
    return count;
}

static bool stands_still(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return square(b->vx[row]) + square(b->vy[row]) + square(b->w[row] * b->extent[row]) <=
           square(STILL * world->desc.sleep_speed);
}

// What keeps a member awake keeps its island; what floats is kept by its own motion.
static void hold_islands(plumb_world *world)
{
    const uint32_t *parents = world->sleep.parents.data;
    uint8_t *held = world->sleep.held.data;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (parents[row] != PL_NONE) {
            held[parents[row]] |= held[row];
        }
    }
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (parents[row] != PL_NONE && !(held[parents[row]] & ANCHORED) &&
            !stands_still(world, row)) {
            held[parents[row]] |= HELD;
        }
    }
}

// Leaves parents only to the bodies that fall asleep; returns how many they are.
static uint32_t find_sleepers(plumb_world *world, uint32_t pair_count)
{
    uint32_t *parents = world->sleep.parents.data, count = 0;
    uint8_t *held = world->sleep.held.data;
    const real tolerance = pl_push_tolerance(world);
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        // Of a force that has come since nothing is to be seen yet.
        const bool rests = is_candidate(world, row) && !pl_push_differs(world, row, tolerance);
        parents[row] = rests ? row : PL_NONE;
        held[row] = 0;
        count += rests;
    }
    count -= leave_out_pushed_by_characters(world);
    if (count == 0) {
        return 0;
    }
    count = 0;
    link_members(world, pair_count);
    hold_islands(world);
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (parents[row] != PL_NONE) {
            parents[row] = held[parents[row]] & HELD ? PL_NONE : parents[row];
            count += parents[row] != PL_NONE;
        }
    }
    return count;
}

//---- lying down ----------------------------------------------------------------------------------

// The island of a pair that falls asleep; PL_NONE: it stays.
static uint32_t island_of(const plumb_world *world, const pl_pair *pair)
{
    const uint32_t *parents = world->sleep.parents.data;
    uint32_t a, b;
    if (!rows_of(world, pair, &a, &b)) {
        return PL_NONE;
    }
    uint32_t row = a < world->dynamic_count && parents[a] != PL_NONE   ? a
                   : b < world->dynamic_count && parents[b] != PL_NONE ? b
                                                                       : PL_NONE;
    return row == PL_NONE ? PL_NONE : parents[row];
}

static bool reserve_islands(plumb_world *world, uint32_t pair_count, uint32_t bodies)
{
    pl_sleep *s = &world->sleep;
    const uint32_t *parents = s->parents.data;
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t islands = 0, contacts = 0;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        islands += parents[row] == row;
    }
    for (uint32_t i = 0; i < pair_count; ++i) {
        contacts += is_linked(&pairs[i]) && island_of(world, &pairs[i]) != PL_NONE;
    }
    size_t events = ((size_t)s->sleep_event_count + bodies) * sizeof(plumb_body);
    size_t places = world->internal_edges.pair_count > 0 ? pair_count * sizeof(uint32_t) : 0;
    return pl_islands_reserve(world, islands, contacts) &&
           pl_buffer_reserve(&world->memory, &s->places, places) &&
           pl_buffer_reserve(&world->memory, &s->sleep_events, events);
}

// Takes the pairs of sleepers out of the list, and their manifolds; those that are contacts are
// kept.
static void take_out_pairs(plumb_world *world, uint32_t pair_count, bool steps)
{
    pl_pair_list *list = &world->broad.pairs;
    pl_pair *pairs = pl_pairs(list);
    pl_narrow *narrow = &world->narrow;
    pl_manifold *m = pl_manifolds(narrow);
    const uint8_t *kind = world->pieces.kind;
    const uint32_t own = narrow->manifold_count, all = own + narrow->borne_count;
    uint32_t *places = world->internal_edges.pair_count > 0 ? world->sleep.places.data : NULL;
    uint32_t kept = 0, kept_manifolds = 0, taken[PL_PIECE_KIND_COUNT][PL_PIECE_KIND_COUNT] = { 0 };
    for (uint32_t i = 0; i < pair_count; ++i) {
        pl_pair *pair = &pairs[i];
        // Manifolds lie in the order of their pairs.
        pl_manifold *its = pair->manifold < all ? &m[pair->manifold] : NULL;
        uint32_t root = island_of(world, pair);
        if (places != NULL) {
            places[i] = root == PL_NONE ? kept : PL_NONE;
        }
        if (root != PL_NONE) {
            if (is_linked(pair)) {
                pl_island_keep(world, world->bodies.island[root], pair, its, steps);
            }
            ++taken[kind[pair->a]][kind[pair->b]];
            continue;
        }
        if (pair->manifold < own) {
            its->pair = kept;
            pair->manifold = kept_manifolds;
            m[kept_manifolds++] = *its;
        }
        pairs[kept++] = *pair;
    }
    uint32_t first = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            list->first[a][b] = first;
            list->size[a][b] -= taken[a][b];
            first += list->size[a][b];
        }
    }
    list->count = kept;
    narrow->manifold_count = kept_manifolds;
    narrow->ends_stale = true; // rows move next
    if (places != NULL) {
        pl_internal_edges_follow(world, places, own);
    }
    pl_narrow_summarise(narrow);
}

// Rows of what is left, after rows have moved.
static void look_up_rows(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    pl_manifold *m = pl_manifolds(&world->narrow);
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        pairs[i].body_a = world->pieces.body[pairs[i].a];
        pairs[i].body_b = world->pieces.body[pairs[i].b];
    }
    for (uint32_t i = 0; i < world->narrow.manifold_count + world->narrow.borne_count; ++i) {
        m[i].body_a = pairs[m[i].pair].body_a;
        m[i].body_b = pairs[m[i].pair].body_b;
    }
}

// Puts everybody to sleep who has a parent; `steps`: in a step, not by a call. Room must be reserved.
static void lie_down(plumb_world *world, uint32_t pair_count, bool steps)
{
    pl_sleep *s = &world->sleep;
    const uint32_t *parents = s->parents.data;
    uint32_t rows = world->dynamic_count;
    for (uint32_t row = 0; row < rows; ++row) {
        if (parents[row] != PL_NONE) {
            uint32_t root = parents[row];
            uint32_t island = root == row ? pl_island_open(world) : world->bodies.island[root];
            pl_island_add(world, island, row);
        }
    }
    if (pair_count > 0) {
        take_out_pairs(world, pair_count, steps);
    }
    // From the last on: what fills a gap stays awake.
    for (uint32_t row = rows; row-- > 0;) {
        if (parents[row] != PL_NONE) {
            pl_push_begin_sleep(world, row, steps);
            pl_sleep_put_down(world, row);
        }
    }
    look_up_rows(world);
    s->near_stale = true;
    pl_sensing_note_rest(world);
    world->joints.awake_stale = true;
    world->pairs_dirty = true;
}

static void tell_sleepers(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    const uint32_t *parents = s->parents.data;
    plumb_body *events = s->sleep_events.data;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (parents[row] != PL_NONE) {
            events[s->sleep_event_count++] = world->bodies.entity[row];
        }
    }
}

//---- the pass ------------------------------------------------------------------------------------

bool pl_sleep_fall(plumb_world *world, real dt)
{
    pl_sleep *s = &world->sleep;
    const uint64_t step = world->step_count + 1;
    const uint32_t pair_count = s->tested_step == step ? world->broad.pairs.count : 0;
    if (s->timed_step != step) {
        s->timed_step = step;
        s->since += s->passed;
        s->candidate_in -= s->passed;
        time_bodies(world, s->passed);
        s->passed = dt;
        world->quarantine.since = s->since;
    } else if (world->quarantine.attempt > 0) {
        time_unsettled(world);
    }
    unsettle_around_changed(world, pair_count);
    if (s->since * LOOKS < world->desc.sleep_time) {
        return true;
    }
    if (s->candidate_in <= 0) {
        s->since = 0;
        return true;
    }
    if (!reserve_members(world)) {
        return false;
    }
    uint32_t sleepers = find_sleepers(world, pair_count);
    if (sleepers > 0) {
        if (!reserve_islands(world, pair_count, sleepers)) {
            return false;
        }
        tell_sleepers(world);
        lie_down(world, pair_count, true);
        world->rows_moved = false; // pairs and manifolds know
    }
    s->since = 0;
    return true;
}

//---- by command ----------------------------------------------------------------------------------

plumb_result pl_sleep_put_to_sleep(plumb_world *world, const char *function, uint32_t row)
{
    // Contacts are those of the last step, if it had any.
    const uint32_t pair_count =
        world->sleep.tested_step == world->step_count ? world->broad.pairs.count : 0;
    if (!reserve_members(world)) {
        return pl_fail_memory(world, function);
    }
    uint32_t *parents = world->sleep.parents.data;
    for (uint32_t r = 0; r < world->dynamic_count; ++r) {
        parents[r] = r;
    }
    link_members(world, pair_count);
    const uint32_t root = parents[row];
    uint32_t count = 0;
    for (uint32_t r = 0; r < world->dynamic_count; ++r) {
        bool member = parents[r] == root;
        count += member;
        if (member && (world->bodies.flags[r] & PL_BODY_NO_SLEEP) != 0) {
            return pl_fail(world, PLUMB_E_STATE, function,
                           "body is in an island with one that may not sleep (%u:%u)",
                           (unsigned)world->bodies.entity[r].entity.index,
                           (unsigned)world->bodies.entity[r].entity.generation);
        }
    }
    for (uint32_t r = 0; r < world->dynamic_count; ++r) {
        parents[r] = parents[r] == root ? root : PL_NONE;
    }
    if (!reserve_islands(world, pair_count, count)) {
        return pl_fail_memory(world, function);
    }
    lie_down(world, pair_count, false);
    return PLUMB_OK;
}
