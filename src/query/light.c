// light.c - rays of light: a beam runs to the next surface, where it ends, goes back, goes through, or parts in two.
//
// Beams that wait are a stack, the stronger of two on top: depth first, so that never more wait than a path has surfaces.
// Powers of the two polarisations are kept apart, in double; what goes through is what is not reflected, so
// nothing is lost but by rounding.
//
// Reads: grids, pieces, poses, materials. Writes: the answer. Cost: see plumb/light.h.
#include "plumb/light.h"

#include "math/decay.h"
#include "math/trig.h"
#include "query/beam.h"
#include "query/fresnel.h"
#include "world/check.h"

#include <math.h>

#define LENGTH_MEANT  ((plumb_real)1000)
#define BOUNCES_MEANT 64
// [-] of what the source sends.
#define LEAST_MEANT ((plumb_real)1e-3)
// Roundings of its coordinates that a beam is taken back before it is reflected: to this side of a surface that meets the first in a corner.
#define BACK (16 * 2.3e-16)

typedef struct trace {
    pl_query q;
    plumb_light_desc desc; // defaults resolved
    plumb_light_segment *segments;
    int count, capacity;
    plumb_light_sum sum;
    int waiting;
    pl_beam beams[PLUMB_LIGHT_MAX_BOUNCES + 2];
} trace;

//---- arguments ------------------------------------------------------------------------------------

static plumb_result check_desc(const plumb_world *world, const char *fn, const plumb_light_desc *d)
{
    PL_TRY(pl_check_pointer(world, fn, "desc", d));
    PL_TRY(pl_check_within(world, fn, "from", d->from, PL_QUERY_LIMIT));
    PL_TRY(pl_check_finite_vec(world, fn, "direction", d->direction));
    if (d->direction.x == 0 && d->direction.y == 0) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "direction is (0, 0); it must have a length");
    }
    PL_TRY(pl_check_range(world, fn, "length", d->length, 0, PL_QUERY_LIMIT));
    PL_TRY(pl_check_range(world, fn, "power", d->power, 0, PL_QUERY_LIMIT));
    PL_TRY(pl_check_range(world, fn, "polarization", d->polarization, -1, 1));
    PL_TRY(pl_check_range(world, fn, "min_power", d->min_power, 0, PL_QUERY_LIMIT));
    PL_TRY(pl_check_range(world, fn, "index", d->index, 0, 10));
    if (d->max_bounces < 0 || d->max_bounces > PLUMB_LIGHT_MAX_BOUNCES) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "max_bounces is %d; it must be 0 to %d",
                       d->max_bounces, PLUMB_LIGHT_MAX_BOUNCES);
    }
    return pl_query_check_reach(world, fn, "the ray", (double)d->length, (double)d->length);
}

// [m] what a length of 0 means.
static plumb_real length_meant(const plumb_world *world)
{
    plumb_real length = LENGTH_MEANT;
    const plumb_real wraps[] = { world->desc.wrap_x, world->desc.wrap_y };
    for (int axis = 0; axis < 2; ++axis) {
        if (wraps[axis] > 0) {
            length = plumb_min(length, PL_QUERY_PERIODS * wraps[axis]);
        }
    }
    return length;
}

static void resolve(const plumb_world *world, plumb_light_desc *d)
{
    d->length = d->length > 0 ? d->length : length_meant(world);
    d->power = d->power > 0 ? d->power : 1;
    d->max_bounces = d->max_bounces > 0 ? d->max_bounces : BOUNCES_MEANT;
    d->min_power = d->min_power > 0 ? d->min_power : LEAST_MEANT * d->power;
    d->index = d->index > 0 ? d->index : 1;
}

//---- media ----------------------------------------------------------------------------------------

static double index_of(const trace *t, uint32_t medium)
{
    return (double)(medium == PL_NONE ? t->desc.index
                                      : t->q.world->materials.refractive_index[medium]);
}

static double reflectance_of(const trace *t, uint32_t medium)
{
    return medium == PL_NONE ? 0 : (double)t->q.world->materials.reflectance[medium];
}

static double absorption_of(const trace *t, uint32_t medium)
{
    return medium == PL_NONE ? 0 : (double)t->q.world->materials.absorption[medium];
}

//---- beams ----------------------------------------------------------------------------------------

static double power_of(const pl_beam *beam)
{
    return beam->power[0] + beam->power[1];
}

// Lets a beam wait, or ends it: cut off, or at the end of its length.
static void wait(trace *t, const pl_beam *beam)
{
    const double power = power_of(beam);
    if (!(power >= (double)t->desc.min_power) || beam->depth > t->desc.max_bounces) {
        t->sum.cut += power;
        return;
    }
    if (!(beam->length > 0)) {
        t->sum.left += power;
        return;
    }
    t->beams[t->waiting++] = *beam;
}

// The next surface behind which there is something else; *beyond is what.
static pl_beam_event find_surface(trace *t, const pl_beam *beam, pl_beam_place *beyond)
{
    pl_beam_event event = { .at = -1, .kind = PL_BEAM_LINE };
    for (;;) {
        event = pl_beam_next(&t->q, beam, &event);
        *beyond = (pl_beam_place){ PL_NONE, beam->medium };
        if (event.piece == PL_NONE || event.kind == PL_BEAM_LINE || event.kind == PL_BEAM_OPAQUE) {
            return event;
        }
        const double x = beam->x + event.at * beam->dx, y = beam->y + event.at * beam->dy;
        const double gap = pl_beam_gap(x, y);
        *beyond = pl_beam_look(&t->q, x - gap * event.nx, y - gap * event.ny, &event);
        if (beyond->opaque != PL_NONE || beyond->medium != beam->medium) {
            return event;
        }
    }
}

// The piece of the path that a beam is, up to `at`; absorption has its share.
static plumb_light_segment *write_segment(trace *t, pl_beam *beam, double at)
{
    plumb_light_segment *s = &t->segments[t->count++];
    const double before = power_of(beam);
    const double run = (double)t->desc.length - beam->length;
    *s = (plumb_light_segment){ .from = { (plumb_real)beam->x, (plumb_real)beam->y },
                                .power = (plumb_real)before,
                                .polarization =
                                    (plumb_real)((beam->power[1] - beam->power[0]) / before),
                                .index = (plumb_real)index_of(t, beam->medium),
                                .path = (plumb_real)run,
                                .how = (plumb_light_how)beam->how,
                                .parent = beam->parent,
                                .depth = beam->depth };
    const double passes = pl_decay_of(absorption_of(t, beam->medium) * at).left;
    beam->power[0] *= passes;
    beam->power[1] *= passes;
    t->sum.absorbed += before - power_of(beam);
    beam->x += at * beam->dx;
    beam->y += at * beam->dy;
    beam->length -= at;
    s->to = (plumb_vec2){ (plumb_real)beam->x, (plumb_real)beam->y };
    s->power_end = (plumb_real)power_of(beam);
    return s;
}

// The beam that goes on from a surface; its power is still that of the whole.
static pl_beam go_on(const trace *t, const pl_beam *beam, const pl_beam_event *event, int how)
{
    pl_beam next = *beam;
    next.piece = event->piece;
    next.how = how;
    next.parent = t->count - 1;
    next.depth = beam->depth + 1;
    return next;
}

static pl_beam reflect(const trace *t, const pl_beam *beam, const pl_beam_event *event)
{
    pl_beam next = go_on(t, beam, event, PLUMB_LIGHT_REFLECTED);
    const double along = beam->dx * event->nx + beam->dy * event->ny;
    const double dx = beam->dx - 2 * along * event->nx, dy = beam->dy - 2 * along * event->ny;
    const double size = sqrt(dx * dx + dy * dy);
    const double back = BACK * (fabs(beam->x) + fabs(beam->y) + event->at);
    next.x -= back * beam->dx;
    next.y -= back * beam->dy;
    next.dx = dx / size;
    next.dy = dy / size;
    next.side = event->kind == PL_BEAM_LEAVES ? PL_BEAM_INWARD : PL_BEAM_OUTWARD;
    return next;
}

static pl_beam refract(const trace *t, const pl_beam *beam, const pl_beam_event *event,
                       const pl_fresnel *f, double cosine)
{
    pl_beam next = go_on(t, beam, event, PLUMB_LIGHT_REFRACTED);
    const double across = f->ratio * cosine - f->cosine;
    const double dx = f->ratio * beam->dx + across * event->nx;
    const double dy = f->ratio * beam->dy + across * event->ny;
    const double size = sqrt(dx * dx + dy * dy);
    next.dx = dx / size;
    next.dy = dy / size;
    next.side = event->kind == PL_BEAM_ENTERS ? PL_BEAM_INWARD : PL_BEAM_OUTWARD;
    return next;
}

//---- surfaces -------------------------------------------------------------------------------------

// The stronger is followed first, so it waits on top; of equals what went through.
static void part(trace *t, const pl_beam *back, const pl_beam *through)
{
    const bool back_first = power_of(back) > power_of(through);
    const pl_beam *const order[] = { back_first ? through : back, back_first ? back : through };
    for (int i = 0; i < 2; ++i) {
        if (power_of(order[i]) > 0) {
            wait(t, order[i]);
        }
    }
}

// What is opaque keeps all but its reflectance; a line with an index lets the rest pass. Returns what stays.
static double meet_mirror(trace *t, const pl_beam *beam, const pl_beam_event *event, uint32_t piece)
{
    const uint32_t material = t->q.world->pieces.material[piece];
    const double share = event->nx == 0 && event->ny == 0 ? 0 : reflectance_of(t, material);
    const bool film = event->kind == PL_BEAM_LINE && pl_beam_passes(t->q.world, piece);
    pl_beam back = reflect(t, beam, event), through = go_on(t, beam, event, PLUMB_LIGHT_REFRACTED);
    through.side = PL_BEAM_OUTWARD;
    for (int k = 0; k < 2; ++k) {
        back.power[k] *= share;
        through.power[k] -= back.power[k];
    }
    const double kept = film ? 0 : power_of(&through);
    through.power[0] *= film;
    through.power[1] *= film;
    part(t, &back, &through);
    t->sum.absorbed += kept;
    return kept;
}

static void meet_interface(trace *t, const pl_beam *beam, const pl_beam_event *event,
                           uint32_t medium, double cosine)
{
    const double silver = pl_most(reflectance_of(t, beam->medium), reflectance_of(t, medium));
    const pl_fresnel f = pl_fresnel_at(index_of(t, beam->medium), index_of(t, medium), cosine);
    pl_beam back = reflect(t, beam, event);
    pl_beam through = f.cosine > 0 ? refract(t, beam, event, &f, cosine) : back;
    through.medium = medium;
    for (int k = 0; k < 2; ++k) {
        back.power[k] *= silver + (1 - silver) * f.reflected[k];
        through.power[k] -= back.power[k];
    }
    part(t, &back, &through);
}

static void follow(trace *t, pl_beam beam)
{
    pl_beam_place beyond;
    const pl_beam_event event = find_surface(t, &beam, &beyond);
    const bool meets = event.piece != PL_NONE;
    plumb_light_segment *s = write_segment(t, &beam, meets ? event.at : beam.length);
    if (!meets) {
        t->sum.left += power_of(&beam);
        return;
    }
    const plumb_world *world = t->q.world;
    const uint32_t met = beyond.opaque != PL_NONE ? beyond.opaque : event.piece;
    const double along = -(beam.dx * event.nx + beam.dy * event.ny);
    const double across = fabs(beam.dx * event.ny - beam.dy * event.nx);
    const double cosine = pl_least(pl_most(along, 0), 1);
    s->shape = world->pieces.shape[met];
    s->body = world->bodies.entity[world->pieces.body[met]];
    s->normal = (plumb_vec2){ (plumb_real)event.nx, (plumb_real)event.ny };
    s->incidence = (plumb_real)pl_atan2(across, pl_most(along, 0));
    if (beyond.opaque != PL_NONE || event.kind == PL_BEAM_LINE || event.kind == PL_BEAM_OPAQUE) {
        s->absorbed = (plumb_real)meet_mirror(t, &beam, &event, met);
    } else {
        meet_interface(t, &beam, &event, beyond.medium, cosine);
    }
}

static pl_beam first_beam(trace *t)
{
    const plumb_light_desc *d = &t->desc;
    const double dx = (double)d->direction.x, dy = (double)d->direction.y;
    const double scale = pl_most(fabs(dx), fabs(dy)); // squares of any size are numbers
    const double size = sqrt(dx / scale * (dx / scale) + dy / scale * (dy / scale));
    pl_beam beam = { .x = (double)d->from.x,
                     .y = (double)d->from.y,
                     .dx = dx / scale / size,
                     .dy = dy / scale / size,
                     .length = (double)d->length,
                     .piece = PL_NONE,
                     .parent = -1,
                     .how = PLUMB_LIGHT_SENT };
    beam.power[1] = (double)d->power * (1 + (double)d->polarization) / 2;
    beam.power[0] = (double)d->power - beam.power[1];
    // A little ahead: what starts at a surface is on the side to which it goes.
    const double gap = pl_beam_gap(beam.x, beam.y);
    beam.medium = pl_beam_look(&t->q, beam.x + gap * beam.dx, beam.y + gap * beam.dy, NULL).medium;
    return beam;
}

int plumb_world_light(plumb_world *world, const plumb_light_desc *desc,
                      const plumb_query_filter *filter, plumb_light_segment *segments, int capacity,
                      plumb_light_sum *sum)
{
    trace t;
    if (world == NULL || check_desc(world, __func__, desc) != PLUMB_OK ||
        pl_query_check_output(world, __func__, "segments", segments, capacity) != PLUMB_OK ||
        pl_query_begin(&t.q, world, __func__, filter) != PLUMB_OK) {
        return -1;
    }
    t.desc = *desc;
    resolve(world, &t.desc);
    t.segments = segments;
    t.count = 0;
    t.capacity = capacity;
    t.sum = (plumb_light_sum){ .sent = (double)t.desc.power };
    t.beams[0] = first_beam(&t);
    for (t.waiting = 1; t.waiting > 0;) {
        const pl_beam beam = t.beams[--t.waiting];
        if (t.count == t.capacity) {
            t.sum.cut += power_of(&beam);
        } else {
            follow(&t, beam);
        }
    }
    if (sum != NULL) {
        *sum = t.sum;
    }
    return t.count;
}
