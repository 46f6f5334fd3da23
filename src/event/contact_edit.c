// contact_edit.c - contacts as systems see and change them between narrow phase and solver.
//
// An edit writes the manifold itself, which the solver reads next. What was disabled is taken out
// of the list when the systems are through, so that neither solver nor events know of it; the pair
// forgets its impulses and is waived for the rest of the step: sweeps let it pass too. Reads, writes: manifolds, pairs. Cost: O(1) an edit, O(manifolds) a step in
// which something was edited; nothing where no system of the phase is registered.
#include "event/event.h"
#include "narrow/narrow.h"
#include "narrow/surface.h"
#include "plumb/math.h"
#include "world/check.h"
#include "world/wrap.h"

#define FRICTION_MOST ((real)10) // [-] see plumb_material_desc

static plumb_result check_open(const plumb_world *world, const char *function)
{
    PL_TRY(pl_check_world(world));
    return world->editing ? PLUMB_OK
                          : pl_fail(world, PLUMB_E_STATE, function,
                                    "no system of PLUMB_PHASE_CONTACTS runs; call it from one");
}

static plumb_result check_index(const plumb_world *world, const char *function, int i,
                                const void *edit)
{
    PL_TRY(check_open(world, function));
    if ((i < 0 || (uint32_t)i >= world->narrow.manifold_count)) {
        return pl_fail(world, PLUMB_E_RANGE, function, "i is %d; it must be 0 to %lld", i,
                       (long long)world->narrow.manifold_count - 1);
    }
    return pl_check_pointer(world, function, "edit", edit);
}

int plumb_contact_edit_count(const plumb_world *world)
{
    return check_open(world, __func__) == PLUMB_OK ? (int)world->narrow.manifold_count : -1;
}

plumb_result plumb_contact_edit_get(const plumb_world *world, int i, plumb_contact_edit *edit)
{
    PL_TRY(check_index(world, __func__, i, edit));
    const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
    const pl_pair *pair = pl_pair_of(world, m);
    const pl_bodies *b = &world->bodies;
    *edit = (plumb_contact_edit){ .shape_a = world->pieces.shape[pair->a],
                                  .shape_b = world->pieces.shape[pair->b],
                                  .body_a = b->entity[m->body_a],
                                  .body_b = b->entity[m->body_b],
                                  .normal = { m->nx, m->ny },
                                  .point_count = (int)m->count,
                                  .touching = (pair->flags & PL_PAIR_TOUCHING) != 0,
                                  .enabled = !m->disabled,
                                  .friction = m->friction,
                                  .restitution = m->restitution,
                                  .rolling_resistance = m->rolling,
                                  .adhesion = m->adhesion,
                                  .surface_speed = pl_rightward(world, m->surface_speed) };
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_manifold_point *p = &m->point[k];
        plumb_vec2 on_a = { b->center_x[m->body_a] + p->ax, b->center_y[m->body_a] + p->ay };
        plumb_vec2 on_b = { b->center_x[m->body_b] + p->bx, b->center_y[m->body_b] + p->by };
        on_b = pl_wrap_point(world, on_b, on_a);
        edit->points[k] = plumb_vec2_lerp(on_a, on_b, (real)0.5);
        edit->separation[k] = p->separation;
    }
    return PLUMB_OK;
}

plumb_result plumb_contact_edit_set(plumb_world *world, int i, const plumb_contact_edit *edit)
{
    PL_TRY(check_index(world, __func__, i, edit));
    PL_TRY(pl_check_range(world, __func__, "friction", edit->friction, 0, FRICTION_MOST));
    PL_TRY(
        pl_check_range(world, __func__, "restitution", edit->restitution, 0, PL_RESTITUTION_MOST));
    PL_TRY(pl_check_range(world, __func__, "rolling_resistance", edit->rolling_resistance, 0,
                          PLUMB_REAL_MAX));
    PL_TRY(pl_check_finite(world, __func__, "surface_speed", edit->surface_speed));
    PL_TRY(pl_check_range(world, __func__, "adhesion", edit->adhesion, 0, PLUMB_REAL_MAX));
    if (edit->friction > 0 || edit->rolling_resistance > 0 || edit->surface_speed != 0) {
        PL_TRY(PL_CHECK_HAS(world, __func__, "friction", FRICTION, "friction"));
    }
    if (edit->restitution > 0) {
        PL_TRY(PL_CHECK_HAS(world, __func__, "restitution", RESTITUTION, "restitution"));
    }
    pl_manifold *m = &pl_manifolds(&world->narrow)[i];
    m->friction = (near_real)edit->friction;
    m->restitution = (near_real)edit->restitution;
    m->rolling = (near_real)edit->rolling_resistance;
    m->adhesion = (near_real)edit->adhesion;
    m->surface_speed = (near_real)pl_rightward(world, edit->surface_speed);
    m->disabled = !edit->enabled;
    world->edited = true;
    return PLUMB_OK;
}

void pl_edits_forget(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = 0; world->edited && i < world->broad.pairs.count; ++i) {
        pairs[i].flags &= ~PL_PAIR_WAIVED;
    }
    world->edited = false;
}

void pl_edits_open(plumb_world *world)
{
    pl_manifold *m = pl_manifolds(&world->narrow);
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        m[i].disabled = 0;
    }
    world->editing = true;
    world->edited = false;
}

void pl_edits_close(plumb_world *world)
{
    world->editing = false;
    if (world->edited) {
        pl_narrow_take_out_disabled(world, PL_PAIR_WAIVED);
    }
}
