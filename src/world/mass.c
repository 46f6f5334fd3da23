// mass.c - mass, centre and inertia of bodies from their shapes, in double, so that many shapes far
// from the origin lose nothing on the way.
//
// Two parts merge by the parallel axis theorem: with d the distance of their centres,
// I = I1 + I2 + d^2 m1 m2 / (m1 + m2).
//
// Reads: areas and densities of pieces. Writes: mass columns, velocity and pose of the row.
// Cost: O(pieces of the body).
#include "world/rows.h"

void pl_mass_add(pl_mass_sum *sum, plumb_mass_properties area, real density)
{
    double mass = (double)area.mass * (double)density;
    if (mass <= 0) {
        return;
    }
    double total = sum->mass + mass;
    double dx = (double)area.center.x - sum->x;
    double dy = (double)area.center.y - sum->y;
    sum->inertia +=
        (double)area.inertia * (double)density + (dx * dx + dy * dy) * sum->mass * (mass / total);
    sum->x += dx * (mass / total);
    sum->y += dy * (mass / total);
    sum->mass = total;
}

real pl_density_of(const plumb_world *world, uint32_t piece)
{
    const pl_pieces *p = &world->pieces;
    bool weightless = (p->flags[piece] & PL_PIECE_SENSOR) != 0 ||
                      p->shape_kind[piece] == PLUMB_SEGMENT || p->shape_kind[piece] == PLUMB_CHAIN;
    real own = p->own_density[piece];
    return weightless ? 0 : own > 0 ? own : world->materials.density[p->material[piece]];
}

// Parallel axis theorem: I about another point is I + m d^2.
void pl_mass_recenter(pl_mass_sum *sum, real x, real y)
{
    double dx = (double)x - sum->x, dy = (double)y - sum->y;
    sum->inertia += sum->mass * (dx * dx + dy * dy);
    sum->x = (double)x;
    sum->y = (double)y;
}

// Newest shape first, as the list has them: the order is part of the result's last bits.
pl_mass_sum pl_mass_of_shapes(const plumb_world *world, uint32_t row)
{
    const pl_pieces *pieces = &world->pieces;
    pl_mass_sum sum = { 0 };
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = pieces->next_in_body[p]) {
        pl_mass_add(&sum, pieces->area[p], pieces->density[p]);
    }
    if ((world->bodies.flags[row] & PL_BODY_OWN_CENTER) != 0) {
        pl_mass_recenter(&sum, world->bodies.local_x[row], world->bodies.local_y[row]);
    }
    return sum;
}

// Clamps to the range of masses; *inside turns false when that changed it.
static real clamp_mass(double value, bool *inside)
{
    if (value >= (double)PL_MASS_LEAST && value <= (double)PL_MASS_MOST) {
        return (real)value;
    }
    *inside = false;
    return value < (double)PL_MASS_LEAST ? PL_MASS_LEAST : PL_MASS_MOST;
}

bool pl_mass_resolve(const pl_mass_sum *sum, real set_mass, real set_inertia, pl_body_mass *out)
{
    bool inside = true;
    double mass = set_mass > 0 ? (double)set_mass : sum->mass > 0 ? sum->mass : 1;
    double scale = sum->mass > 0 ? mass / sum->mass : 0;
    double inertia = set_inertia > 0 ? (double)set_inertia : sum->inertia * scale;
    out->mass = clamp_mass(mass, &inside);
    out->inertia = inertia > 0 ? clamp_mass(inertia, &inside) : 0;
    out->x = (real)sum->x;
    out->y = (real)sum->y;
    return inside;
}

void pl_mass_apply(plumb_world *world, uint32_t row, const pl_body_mass *mass)
{
    pl_bodies *b = &world->bodies;
    bool turned = b->inv_inertia[row] > 0;
    bool turns = mass->inertia > 0 && !(b->flags[row] & PL_BODY_FIXED_ROTATION);
    if (b->first_joint[row] != PL_NONE &&
        (b->mass[row] != mass->mass || b->inertia[row] != mass->inertia || turned != turns ||
         b->local_x[row] != mass->x || b->local_y[row] != mass->y)) {
        pl_joints_replan(&world->joints); // by masses it is told who is solved together
    }
    b->mass[row] = mass->mass;
    b->inertia[row] = mass->inertia;
    b->inv_mass[row] = 1 / mass->mass;
    b->inv_inertia[row] = turns ? 1 / mass->inertia : 0;
    world->turning_bodies += (turns ? 1u : 0u) - (turned ? 1u : 0u);
    world->schedule_dirty |= turns != turned;

    real lx = mass->x - b->local_x[row];
    real ly = mass->y - b->local_y[row];
    if (lx != 0 || ly != 0) {
        real dx = b->c[row] * lx - b->s[row] * ly;
        real dy = b->s[row] * lx + b->c[row] * ly;
        b->vx[row] -= b->w[row] * dy;
        b->vy[row] += b->w[row] * dx;
        b->local_x[row] = mass->x;
        b->local_y[row] = mass->y;
        pl_body_update_center(world, row);
    }
}

void pl_mass_revise(plumb_world *world, uint32_t row)
{
    if (world->bodies.type[row] != PLUMB_DYNAMIC) {
        pl_extent_revise(world, row);
        return;
    }
    pl_mass_sum sum = pl_mass_of_shapes(world, row);
    pl_body_mass mass;
    pl_mass_resolve(&sum, world->bodies.set_mass[row], world->bodies.set_inertia[row], &mass);
    pl_mass_apply(world, row, &mass);
    pl_extent_revise(world, row);
}
