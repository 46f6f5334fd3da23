// accuracy.c - presets of accuracy, the tolerance of a world, and what the dial (src/accuracy) tells.
//
// Reads: the dial. Writes: settings. Cost: O(1).
#include "accuracy/dial.h"
#include "world/check.h"

static const struct {
    const char *name, *text;
    double tolerance;
    plumb_solver solver;
    int substeps;
} presets[PLUMB_ACCURACY_PRESETS] = {
#define ROW(NAME, name, tolerance, solver, substeps, text)                                         \
    [PLUMB_ACCURACY_##NAME] = { #name, text, tolerance, solver, substeps },
    PLUMB_ACCURACY_LIST(ROW)
#undef ROW
};

const char *plumb_accuracy_name(plumb_accuracy_preset preset)
{
    return (unsigned)preset < PLUMB_ACCURACY_PRESETS ? presets[preset].name : NULL;
}

const char *plumb_accuracy_text(plumb_accuracy_preset preset)
{
    return (unsigned)preset < PLUMB_ACCURACY_PRESETS ? presets[preset].text : NULL;
}

plumb_result plumb_accuracy_apply(plumb_accuracy_preset preset, plumb_world_desc *desc)
{
    if (desc == NULL) {
        return PLUMB_E_NULL;
    }
    if ((unsigned)preset >= PLUMB_ACCURACY_PRESETS) {
        return PLUMB_E_RANGE;
    }
    desc->tolerance = (plumb_real)presets[preset].tolerance;
    desc->solver = presets[preset].solver;
    desc->substeps = presets[preset].substeps;
    desc->iterations = 0;
    return PLUMB_OK;
}

plumb_result plumb_world_set_tolerance(plumb_world *world, plumb_real tolerance)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_range(world, __func__, "tolerance", tolerance, 0, (plumb_real)0.5));
    if (tolerance > 0) {
        PL_TRY(PL_CHECK_HAS(world, __func__, "tolerance", TOLERANCE, "tolerance"));
    }
    world->desc.tolerance = tolerance;
    pl_dial_reset(world);
    return PLUMB_OK;
}

static const char *const reasons[PL_DIAL_REASONS] = {
    [PL_DIAL_BEGUN] = "as the world was set",
    [PL_DIAL_EASY] = "few substeps are enough",
    [PL_DIAL_MOTION] = "motion asks for so many substeps",
    [PL_DIAL_REST] = "overlaps and gaps ask for so many substeps",
    [PL_DIAL_MOST] = "more substeps would not help",
    [PL_DIAL_LOOSE] = "overlaps and gaps ask for a direct solver",
    [PL_DIAL_HEAVY] = "mass ratios ask for a direct solver",
    [PL_DIAL_RESTING] = "bodies at rest on two points are solved directly",
    [PL_DIAL_TIED] = "joints that hold one another are solved directly",
};

plumb_accuracy plumb_world_accuracy(const plumb_world *world)
{
    if (world == NULL || !pl_dial_is_on(world)) {
        return (plumb_accuracy){ .reason = "" };
    }
    const pl_dial *d = &world->dial;
    return (plumb_accuracy){ .tolerance = (double)world->desc.tolerance,
                             .error = pl_dial_error(d),
                             .motion = d->motion,
                             .frozen = d->frozen,
                             .rest = d->rest,
                             .worst = d->worst,
                             .solver = world->desc.solver,
                             .substeps = world->desc.substeps,
                             .direct_joints = world->desc.direct_joints,
                             .met = d->worst <= (double)world->desc.tolerance,
                             .reason = reasons[d->reason],
                             .steps = d->steps,
                             .solved = d->solved };
}
