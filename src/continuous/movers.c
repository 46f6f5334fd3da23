// movers.c - which bodies are swept: those that moved fast, noted by the solver, and slow ones over which
// a fast kinematic body may have swept or that are pressed deep into something.
//
// The list is sorted by body row; what joins is marked by a flag of its row and merged in from
// the back, so that nothing is sorted. Reads: movers, grid of moving pieces, manifolds. Writes: movers. Cost:
// O(movers), of fast kinematic bodies also O(dynamic bodies).
#include "continuous/movers.h"

#include "broad/images.h"

// So many movers are worth a thread.
#define LEAST 256

// A body deeper than this share of its slack is swept even if it moves slowly.
#define PRESSED_SHARE ((real)0.5)

pl_mover *pl_mover_find(const plumb_world *world, uint32_t row)
{
    pl_mover *movers = pl_movers(&world->continuous);
    // In order of rows: at most as many are missing before it as rows are not movers.
    uint32_t count = world->continuous.count;
    uint32_t missing = world->dynamic_count + world->kinematic_count - count;
    uint32_t low = row > missing ? row - missing : 0, high = row < count ? row + 1 : count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (movers[middle].row < row) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < count && movers[low].row == row ? &movers[low] : NULL;
}

pl_swept_motion pl_mover_motion(const plumb_world *world, uint32_t row, real dt, double ox,
                                double oy)
{
    const pl_mover *mover = pl_mover_find(world, row);
    return mover != NULL ? pl_swept_motion_of_mover(world, mover, ox, oy)
                         : pl_swept_motion_of_row(world, row, dt, ox, oy);
}

// Tells the movers whose way leaves the boxes in which the grid has them: no search of the grid
// finds those. Where they began they were within; so is the way if the end is, but for the bulge of an arc.
static void find_strays(void *context, uint32_t first, uint32_t count)
{
    const plumb_world *world = context;
    const pl_pieces *pieces = &world->pieces;
    for (uint32_t i = first; i < first + count; ++i) {
        pl_mover *m = &pl_movers(&world->continuous)[i];
        real angle = m->angle < 0 ? -m->angle : m->angle;
        real bulge = world->bodies.extent[m->row] * angle * angle / 8;
        m->stray = !(angle < 1);
        for (uint32_t p = world->bodies.first_piece[m->row]; p != PL_NONE && !m->stray;
             p = pieces->next_in_body[p]) {
            pl_box end = pl_piece_tight_box(world, p);
            end = (pl_box){ end.min_x - bulge, end.min_y - bulge, end.max_x + bulge,
                            end.max_y + bulge };
            m->stray = !pl_box_contains(&pieces->fat[p], &end);
        }
    }
}

// What a kinematic body may have come across: movers are told so, slow dynamic bodies are marked if
// it is fast.
typedef struct sweeper {
    plumb_world *world;
    const pl_mover *fast; // NULL: it moves slowly
    uint32_t row;
    uint32_t recruits;
} sweeper;

static bool visit_swept(void *context, const pl_grid_entry *entry)
{
    sweeper *s = context;
    const plumb_world *world = s->world;
    uint32_t row = world->pieces.body[entry->piece];
    uint16_t *flags = &world->bodies.flags[row];
    if (row >= world->dynamic_count || (*flags & PL_BODY_RECRUITED) != 0) {
        return true;
    }
    pl_mover *mover = pl_mover_find(world, row);
    if (mover != NULL) {
        mover->beside = true;
    } else if (s->fast != NULL &&
               s->fast->moved > world->bodies.slack[s->row] + world->bodies.slack[row]) {
        *flags |= PL_BODY_RECRUITED;
        ++s->recruits;
    }
    return true;
}

// Goes through all kinematic bodies if movers are many, else only through fast ones: few movers
// search the grid themselves.
static uint32_t mark_swept(plumb_world *world, real dt)
{
    pl_continuous *c = &world->continuous;
    const bool few = c->count < world->kinematic_count;
    sweeper s = { .world = world };
    for (uint32_t i = 0; i < c->count; ++i) {
        pl_movers(c)[i].beside = world->kinematic_count > 0 && (few || pl_movers(c)[i].stray);
    }
    for (uint32_t k = 0; k < world->kinematic_count && c->count > 0; ++k) {
        s.row = world->dynamic_count + k;
        s.fast = pl_mover_find(world, s.row);
        if (few && s.fast == NULL) {
            continue;
        }
        pl_swept_motion motion =
            pl_mover_motion(world, s.row, dt, (double)world->bodies.center_x[s.row],
                            (double)world->bodies.center_y[s.row]);
        for (uint32_t p = world->bodies.first_piece[s.row]; p != PL_NONE;
             p = world->pieces.next_in_body[p]) {
            pl_swept swept = pl_swept_motion_piece(world, p, &motion);
            pl_world_query(world, &world->broad.moving, pl_swept_motion_box(&motion, &swept),
                           visit_swept, &s);
        }
    }
    return s.recruits;
}

// Slow bodies that are pressed deep into what dynamics does not move might be through it in a step or
// two: they are held as fast ones are.
static uint32_t mark_pressed(plumb_world *world)
{
    uint32_t count = 0;
    const pl_bodies *b = &world->bodies;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        bool a_moves = m->body_a < world->dynamic_count, b_moves = m->body_b < world->dynamic_count;
        uint32_t row = a_moves ? m->body_a : m->body_b;
        real s0 = m->point[0].separation, s1 = m->point[1].separation;
        real depth = s0 < s1 ? -s0 : -s1;
        if (a_moves != b_moves && depth > b->slack[row] * PRESSED_SHARE &&
            (b->flags[row] & PL_BODY_RECRUITED) == 0 && pl_mover_find(world, row) == NULL) {
            b->flags[row] |= PL_BODY_RECRUITED;
            ++count;
        }
    }
    return count;
}

static pl_mover recruit(plumb_world *world, uint32_t row, real dt)
{
    pl_swept_motion motion = pl_swept_motion_of_row(world, row, dt, 0, 0);
    pl_place start = pl_swept_motion_place(world, row, &motion, 0);
    world->bodies.flags[row] &= (uint16_t)~PL_BODY_RECRUITED;
    return (pl_mover){ .row = row,
                       .x = (real)start.x,
                       .y = (real)start.y,
                       .c = (real)start.c,
                       .s = (real)start.s,
                       .angle = (real)motion.angle,
                       .beside = true,
                       .stop = 1 };
}

// Merges the marked bodies into the list, from the back.
static void join_recruits(plumb_world *world, real dt, uint32_t count)
{
    pl_mover *movers = pl_movers(&world->continuous);
    uint32_t from = world->continuous.count;
    world->continuous.count += count;
    uint32_t row = world->dynamic_count;
    for (uint32_t to = world->continuous.count; to > from;) {
        if (from > 0 && movers[from - 1].row >= row) {
            movers[--to] = movers[--from];
        } else if ((world->bodies.flags[--row] & PL_BODY_RECRUITED) != 0) {
            movers[--to] = recruit(world, row, dt);
        }
    }
}

void pl_movers_complete(plumb_world *world, real dt)
{
    const pl_continuous *c = &world->continuous;
    uint32_t recruits = 0;
    if (c->count > 0 && (world->kinematic_count > 0 || world->continuous_bodies > 0)) {
        pl_tasks_ranges(world->tasks, c->count, LEAST, find_strays, world);
        recruits = mark_swept(world, dt);
    }
    if (world->narrow.overlaps.max_penetration > c->least_slack * PRESSED_SHARE) {
        recruits += mark_pressed(world);
    }
    join_recruits(world, dt, recruits);
}
