// walker.c - a point among grown obstacles: where a way ends, how to get out of an overlap.
//
// An obstacle that the walker does not approach never stops it, however deep the two overlap: what is
// inside of something can always leave. One-way shapes count where they hold, and there with the
// faces that hold alone. Reads: obstacles. Writes: the walker's place, hits. Cost: O(obstacles).
#include "character/walker.h"

#include "query/query.h"

#include <math.h>

// [-] of a way: approaching less than this is moving along.
#define ALONG 1e-9
// [m] two places nearer than this are one.
#define SAME       1e-9
#define RECOVERIES 12

static bool may_stop(const pl_walker *m, const pl_obstacle *o, double nx, double ny)
{
    return o->row != m->ignored_row &&
           (!o->is_one_way || (o->holds && nx * o->dx + ny * o->dy >= o->cosine));
}

bool pl_walker_sweep(const pl_walker *m, double dx, double dy, pl_touch *touch)
{
    double length = sqrt(dx * dx + dy * dy);
    bool met = false;
    for (int i = 0; i < m->obstacle_count; ++i) {
        const pl_obstacle *o = &m->obstacles[i];
        pl_sum_hit hit;
        if (o->row == m->ignored_row || (o->is_one_way && !o->holds) ||
            !pl_sum_cast(&o->sum, m->x, m->y, dx, dy, SAME, &hit)) {
            continue;
        }
        bool approaches = -(hit.nx * dx + hit.ny * dy) > ALONG * length;
        if (approaches && (!met || hit.fraction < touch->fraction) &&
            may_stop(m, o, hit.nx, hit.ny)) {
            *touch = (pl_touch){ o, hit.fraction, hit.nx, hit.ny };
            met = true;
        }
    }
    return met;
}

bool pl_walker_probe(const pl_walker *m, double x, double y, double dx, double dy, pl_touch *touch,
                     bool *inside)
{
    const pl_round spot = { .x = { x }, .y = { y }, .count = 1 };
    bool met = false;
    *inside = false;
    for (int i = 0; i < m->obstacle_count; ++i) {
        const pl_obstacle *o = &m->obstacles[i];
        pl_sum sum;
        pl_sum_hit hit;
        if (o->is_one_way && !o->holds) {
            continue;
        }
        pl_sum_make(&o->fixed, &spot, &sum);
        if (!pl_sum_cast(&sum, 0, 0, dx, dy, SAME, &hit)) {
            continue;
        }
        if (hit.depth > 0) {
            *inside = !o->is_one_way || *inside;
        } else if ((!met || hit.fraction < touch->fraction) && may_stop(m, o, hit.nx, hit.ny)) {
            *touch = (pl_touch){ o, hit.fraction, hit.nx, hit.ny };
            met = true;
        }
    }
    return met;
}

void pl_walker_touch_point(const pl_walker *m, const pl_touch *touch, double *x, double *y)
{
    pl_round_touch(&touch->obstacle->fixed, &m->shape, m->x, m->y, touch->nx, touch->ny, x, y);
}

void pl_walker_tell(pl_walker *m, const pl_touch *touch, double speed)
{
    pl_character *c = m->c;
    plumb_shape shape = m->world->pieces.shape[touch->obstacle->piece];
    for (int i = 0; i < c->hit_count; ++i) {
        if (plumb_same(c->hits[i].shape, shape)) {
            return;
        }
    }
    if (c->hit_count == PLUMB_CHARACTER_HITS) {
        return;
    }
    double x, y;
    pl_walker_touch_point(m, touch, &x, &y);
    c->hits[c->hit_count++] = (plumb_character_hit){
        .shape = shape,
        .body = m->world->bodies.entity[touch->obstacle->row],
        .point = { (real)((double)m->start.x + x), (real)((double)m->start.y + y) },
        .normal = { (real)touch->nx, (real)touch->ny },
        .speed = (real)(speed > 0 ? speed : 0),
    };
}

//---- overlaps -----------------------------------------------------------------------------------

// The obstacle that the walker is deepest in. Dynamic ones move out of its way themselves, but for the
// one that it stands on: that has no contact with it, see pl_characters_feet.
static const pl_obstacle *deepest(const pl_walker *m, pl_sum_near *at)
{
    const pl_obstacle *found = NULL;
    at->distance = 0;
    for (int i = 0; i < m->obstacle_count; ++i) {
        const pl_obstacle *o = &m->obstacles[i];
        if ((o->is_dynamic && !o->is_ground) || (o->is_one_way && !o->holds)) {
            continue;
        }
        pl_sum_near near = pl_sum_nearest(&o->sum, m->x, m->y);
        bool lifts = !o->is_dynamic || pl_is_floor(m, near.nx, near.ny);
        if (lifts && near.distance < at->distance && may_stop(m, o, near.nx, near.ny)) {
            *at = near;
            found = o;
        }
    }
    return found;
}

// Something has moved against it: its velocity loses what goes into that; on what comes from below it
// stands.
static void meet_moving(pl_walker *m, const pl_touch *t)
{
    pl_character *c = m->c;
    double vx, vy;
    pl_obstacle_velocity(t->obstacle, m->x, m->y, &vx, &vy);
    double approach = (vx - (double)c->velocity.x) * t->nx + (vy - (double)c->velocity.y) * t->ny;
    pl_walker_tell(m, t, approach);
    if (approach <= 0) {
        return;
    }
    c->velocity.x += (real)(approach * t->nx);
    c->velocity.y += (real)(approach * t->ny);
    if (!c->on_ground && !c->flies && pl_is_floor(m, t->nx, t->ny)) {
        pl_walker_stand(m, t);
        m->carried_x = vx * m->dt;
        m->carried_y = vy * m->dt;
    }
}

void pl_walker_recover(pl_walker *m)
{
    // What moved into it pushes it out at once; what it was put into, as fast as contacts do.
    double allowed = (double)m->world->desc.push_speed * m->dt + m->skin;
    pl_sum_near at;
    const pl_obstacle *o = deepest(m, &at);
    for (int i = 0; o != NULL && i < RECOVERIES; ++i) {
        double out = pl_least(-at.distance, allowed + o->travel);
        allowed -= pl_most(out - o->travel, 0);
        m->x += out * at.nx;
        m->y += out * at.ny;
        if (o->travel > 0 && out > SAME) {
            meet_moving(m, &(pl_touch){ o, 0, at.nx, at.ny });
        }
        o = deepest(m, &at);
    }
    m->c->crushed = o != NULL && -at.distance > m->skin + SAME;
}
