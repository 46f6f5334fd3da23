// draw_ties.c - what ties bodies to one another, drawn: joints, contacts, and what they bear.
//
// Reads: joints, contacts. Writes: nothing. Cost: O(joints), O(contacts).
#include "game/draw.h"
#include "joints/joint.h"
#include "plumb/event.h"
#include "plumb/math.h"

//---- joints --------------------------------------------------------------------------------------

// Both ends where they are drawn, B's by the image nearest to A's.
typedef struct ends {
    plumb_vec2 a, b;               // anchors
    plumb_vec2 center_a, center_b; // of the bodies; of the world, the anchors
} ends;

static plumb_vec2 anchor_of(const pl_drawing *d, const pl_joint_end *end, plumb_vec2 *center)
{
    if (plumb_is_null(end->body)) {
        return *center = pl_draw_near(d, end->local);
    }
    const plumb_transform t = pl_draw_frame(d, end->body);
    *center = plumb_transform_apply(t, plumb_body_local_center(d->world, end->body));
    return plumb_transform_apply(t, end->local);
}

static ends ends_of(const pl_drawing *d, const pl_joint *j)
{
    ends e;
    e.a = anchor_of(d, &j->a, &e.center_a);
    e.b = anchor_of(d, &j->b, &e.center_b);
    const plumb_vec2 there = plumb_vec2_add(e.a, plumb_world_way(d->world, e.a, e.b));
    e.center_b = plumb_vec2_add(e.center_b, plumb_vec2_sub(there, e.b));
    e.b = there;
    return e;
}

// From rim to rim, whose radii are drawn as well; from centre to centre where no line touches both.
static void draw_cable(const pl_drawing *d, const pl_joint *j, const ends *e, plumb_paint paint)
{
    const real across = j->desc.radius_a - j->desc.radius_b;
    plumb_vec2 from = e->a, to = e->b;
    real free;
    const plumb_vec2 n = pl_cable_run(plumb_vec2_sub(e->b, e->a), across, &free);
    if (free > 0) {
        from = plumb_vec2_add_scaled(from, j->desc.radius_a, plumb_vec2_left(n));
        to = plumb_vec2_add_scaled(to, j->desc.radius_b, plumb_vec2_left(n));
    }
    pl_draw_line(d, e->a, from, paint);
    pl_draw_line(d, from, to, paint);
    pl_draw_line(d, to, e->b, paint);
}

static void draw_ends(const pl_drawing *d, const pl_joint *j, const ends *e, plumb_paint paint)
{
    switch (j->desc.kind) {
    case PLUMB_PULLEY: {
        const plumb_vec2 ga = pl_draw_near(d, j->desc.ground_a);
        const plumb_vec2 gb = plumb_vec2_add(ga, plumb_world_way(d->world, ga, j->desc.ground_b));
        pl_draw_line(d, e->a, ga, paint);
        pl_draw_line(d, ga, gb, paint);
        pl_draw_line(d, gb, e->b, paint);
        break;
    }
    case PLUMB_DISTANCE:
    case PLUMB_MOUSE:
        pl_draw_line(d, e->a, e->b, paint);
        break;
    case PLUMB_CABLE:
        draw_cable(d, j, e, paint);
        break;
    case PLUMB_GEAR:
        pl_draw_line(d, e->center_a, e->center_b, paint);
        return;
    default:
        pl_draw_line(d, e->center_a, e->a, paint);
        pl_draw_line(d, e->a, e->b, paint);
        pl_draw_line(d, e->b, e->center_b, paint);
    }
    pl_draw_point(d, e->a, paint);
    pl_draw_point(d, e->b, paint);
}

// Not of a disabled body, nor a free slot.
static bool is_drawn(const pl_drawing *d, const pl_joint *j)
{
    const plumb_body both[2] = { j->a.body, j->b.body };
    for (int i = 0; i < 2; ++i) {
        if (!plumb_is_null(both[i]) && !plumb_body_is_enabled(d->world, both[i])) {
            return false;
        }
    }
    return !plumb_is_null(j->entity);
}

void pl_draw_joints(const pl_drawing *d)
{
    for (uint32_t i = 0; i < d->world->joints.count; ++i) {
        const pl_joint *j = &pl_joint_items(&d->world->joints)[i];
        if (!is_drawn(d, j)) {
            continue;
        }
        const ends e = ends_of(d, j);
        const bool marked = j->strained != 0 || j->desc.disabled;
        if (pl_draw_sees(d, e.center_a, e.center_b) || pl_draw_sees(d, e.a, e.b)) {
            draw_ends(d, j, &e, marked ? PLUMB_PAINT_STRAINED : PLUMB_PAINT_JOINT);
        }
    }
}

void pl_draw_joint_forces(const pl_drawing *d)
{
    for (uint32_t i = 0; i < d->world->joints.count; ++i) {
        const pl_joint *j = &pl_joint_items(&d->world->joints)[i];
        if (!is_drawn(d, j)) {
            continue;
        }
        const ends e = ends_of(d, j);
        const plumb_vec2 tip = plumb_vec2_add_scaled(e.b, d->desc.force_scale, j->force);
        if ((j->force.x != 0 || j->force.y != 0) && pl_draw_sees(d, e.b, tip)) {
            pl_draw_line(d, e.b, tip, PLUMB_PAINT_FORCE);
        }
    }
}

//---- contacts ------------------------------------------------------------------------------------

#define NORMAL_PIXELS 10

static void draw_contact(const pl_drawing *d, const plumb_contact *c, real rate, bool forces)
{
    for (int k = 0; k < c->point_count; ++k) {
        const plumb_contact_point *p = &c->points[k];
        const plumb_vec2 at = pl_draw_near(d, p->point);
        const real pushed = p->normal_impulse * rate * d->desc.force_scale;
        const real rubbed = p->tangent_impulse * rate * d->desc.force_scale;
        plumb_vec2 way = plumb_vec2_scale(NORMAL_PIXELS * d->desc.pixel, c->normal);
        if (forces) { // on B, the normal's turned to the right is its tangent
            way = plumb_vec2_add(plumb_vec2_scale(pushed, c->normal),
                                 plumb_vec2_scale(rubbed, plumb_vec2_right(c->normal)));
        }
        const plumb_vec2 tip = plumb_vec2_add(at, way);
        if (!pl_draw_sees(d, at, tip)) {
            continue;
        }
        pl_draw_line(d, at, tip, forces ? PLUMB_PAINT_FORCE : PLUMB_PAINT_CONTACT);
        if (!forces) {
            pl_draw_point(d, at, PLUMB_PAINT_CONTACT);
        }
    }
}

plumb_result pl_draw_contacts(const pl_drawing *d, bool forces)
{
    plumb_world *world = d->world;
    const int count = plumb_world_contacts(world, NULL, 0);
    const size_t bytes = (size_t)count * sizeof(plumb_contact);
    const real substep = world->last_dt / (real)world->desc.substeps;
    if (count == 0) {
        return PLUMB_OK;
    }
    plumb_contact *contacts = pl_resize(&world->memory, NULL, 0, bytes);
    if (contacts == NULL) {
        return PLUMB_E_MEMORY;
    }
    plumb_world_contacts(world, contacts, count);
    for (int i = 0; i < count; ++i) {
        draw_contact(d, &contacts[i], substep > 0 ? 1 / substep : 0, forces);
    }
    pl_resize(&world->memory, contacts, bytes, 0);
    return PLUMB_OK;
}
