// run.c - faces of ground that go on flat from piece to piece bear what lies on them as one.
//
// A body on three tiles has three contacts, whose points come and go while it slides. Each change
// would shift the load and, contacts being soft, the depth to which the body sinks: small, but far
// above what a single floor does. So contacts of one piece with faces that are flush, meet and have
// one material are joined: one of them, on the highest face, gets the points of the piece's edge over
// all of them, and the others stand back. The points are then the piece's own corners, which stay.
// Impulses are kept by those, whatever tile they lie on.
//
// Where contacts are shown to systems before they are solved, each tile keeps its own.
//
// Reads: manifolds of pairs with internal edges, poses. Writes: manifolds, pairs, loads. Cost: about 1,500
// instructions a contact of a run.
#include "internal_edges/run.h"

#include "core/sort.h"
#include "world/stale_edges.h"
#include "world/wrap.h"

#include <math.h>
#include <string.h>

// A contact on a face that goes on flat at an end. Everything in world axes, seen from the origin of
// the mover's body.
typedef struct run_contact {
    uint32_t index; // in the list of pairs with internal edges
    uint32_t mover; // piece
    uint32_t next;  // of the same mover
    uint32_t run;
    bool own_is_a;
    int edge;
    double nx, ny;    // outward normal of the ground
    double height;    // [m] of the face along the normal
    double low, high; // [m] the strip before it, along (-ny, nx)
    double slop;      // [m]
} run_contact;

typedef struct flat_run {
    uint32_t owner; // contact that bears all
    uint32_t count;
    double low, high;
} flat_run;

// By piece slot: where its contacts and its loads begin.
typedef struct run_slot {
    uint32_t contact, load;
} run_slot;

// What is found by piece slots has a place for every slot.
static bool reserve_slots(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    size_t slots = world->pieces.table.count;
    if (!pl_buffer_reserve(&world->memory, &s->slots, slots * sizeof(run_slot))) {
        return false;
    }
    run_slot *slot = s->slots.data;
    for (; s->slot_count < slots; ++s->slot_count) {
        slot[s->slot_count] = (run_slot){ PL_NONE, PL_NONE };
    }
    return true;
}

static bool reserve_runs(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    pl_memory *memory = &world->memory;
    size_t contacts = s->contact_count;
    return pl_buffer_reserve(memory, &s->runs, contacts * sizeof(flat_run)) &&
           pl_buffer_reserve(memory, &s->order, contacts * sizeof(pl_keyed)) &&
           pl_buffer_reserve(memory, &s->loads, contacts * sizeof(pl_run_load)) &&
           pl_buffer_reserve(memory, &s->borne, contacts * sizeof(pl_manifold));
}

static void swap_loads(pl_internal_edges *s)
{
    pl_buffer loads = s->loads;
    uint32_t count = s->load_count;
    s->loads = s->old_loads;
    s->load_count = s->old_load_count;
    s->old_loads = loads;
    s->old_load_count = count;
}

bool pl_runs_open(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    if (!reserve_slots(world)) {
        return false;
    }
    swap_loads(s);
    s->opened = true;
    s->load_count = s->contact_count = 0;
    pl_run_load *old = s->old_loads.data;
    run_slot *slots = s->slots.data;
    for (uint32_t i = 0; i < s->old_load_count; ++i) {
        old[i].next = slots[old[i].mover].load;
        slots[old[i].mover].load = i;
    }
    return true;
}

// Slots name nothing between steps.
static void clear_slots(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    const run_contact *contacts = s->contacts.data;
    const pl_run_load *old = s->old_loads.data;
    run_slot *slots = s->slots.data;
    for (uint32_t i = 0; i < s->contact_count; ++i) {
        slots[contacts[i].mover].contact = PL_NONE;
    }
    for (uint32_t i = 0; i < s->old_load_count; ++i) {
        slots[old[i].mover].load = PL_NONE;
    }
}

bool pl_runs_make_room(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    const size_t size = ((size_t)s->contact_count + 1) * sizeof(run_contact);
    if (!pl_buffer_reserve(&world->memory, &s->contacts, size)) {
        clear_slots(world);
        s->contact_count = 0;
        return false;
    }
    return true;
}

//---- which contacts ------------------------------------------------------------------------------

// The edge that the contact lies on if it goes on flat at an end, -1 otherwise.
static int flat_edge(const pl_view *v)
{
    int k = v->feature;
    return v->is_edge && (pl_side_edge_end(&v->side, k, true) == PL_END_FLAT ||
                          pl_side_edge_end(&v->side, k, false) == PL_END_FLAT)
               ? k
               : -1;
}

static run_contact describe(const pl_view *v, uint32_t index, int k)
{
    double c = (double)v->own_pose->c, s = (double)v->own_pose->s;
    pl_shift way = pl_wrap_between(v->world, v->other, v->own);
    pl_strip strip = pl_view_strip(v, k);
    const pl_face *f = &strip.f;
    run_contact r = { .index = index, .mover = v->other, .own_is_a = v->own_is_a, .edge = k };
    r.nx = c * f->nx - s * f->ny;
    r.ny = s * f->nx + c * f->ny;
    double x = c * f->x - s * f->y + way.x;
    double y = s * f->x + c * f->y + way.y;
    double start = y * r.nx - x * r.ny;
    r.height = x * r.nx + y * r.ny;
    r.low = start + strip.low;
    r.high = start + strip.high;
    r.slop = PL_EDGE_SLOP;
    for (int end = 0; end < 2; ++end) {
        int corner = end == 0 ? k : pl_side_next(&v->side, k);
        if (v->side.corner_bits >> corner & 1) {
            r.slop = pl_greater(r.slop, (double)v->side.edges[corner].slop);
        }
    }
    return r;
}

bool pl_runs_add(plumb_world *world, uint32_t index, pl_view *v)
{
    pl_internal_edges *s = &world->internal_edges;
    const int k = flat_edge(v);
    if (k < 0) {
        return false;
    }
    run_slot *slot = (run_slot *)s->slots.data + v->other;
    v->count = 0; // the strip is wanted, not what lies in it
    run_contact *r = (run_contact *)s->contacts.data + s->contact_count;
    *r = describe(v, index, k);
    r->next = slot->contact;
    slot->contact = s->contact_count++;
    return true;
}

//---- runs ----------------------------------------------------------------------------------------

static uint32_t ground_of(const plumb_world *world, const run_contact *r)
{
    const pl_edge_pair *list = world->internal_edges.pairs.data;
    const pl_pair *pair = &pl_pairs(&world->broad.pairs)[list[r->index].pair];
    return r->own_is_a ? pair->a : pair->b;
}

// Bits of a double in the order of its values.
static uint64_t key_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits >> 63 ? ~bits : bits | UINT64_C(1) << 63;
}

// True when the contact goes on where the run ends. Contacts come in order of their lower ends.
static bool continues(const plumb_world *world, const flat_run *run, const run_contact *owner,
                      const run_contact *r)
{
    double slop = pl_greater(owner->slop, r->slop);
    uint32_t p = ground_of(world, owner), q = ground_of(world, r);
    bool one_frame = world->pieces.body[p] == world->pieces.body[q] ||
                     (pl_piece_is_static(world, p) && pl_piece_is_static(world, q));
    return one_frame && world->pieces.material[p] == world->pieces.material[q] &&
           pl_directions_agree(owner->nx, owner->ny, r->nx, r->ny, PL_EDGE_ANGLE) &&
           fabs(owner->height - r->height) <= slop && r->low <= run->high + slop;
}

#define OPEN_RUNS 8 // of one piece that are looked at for one that goes on

// Sorts the contacts of a mover along the ground and joins them. Returns how many there are.
static uint32_t join(plumb_world *world, uint32_t first, uint32_t *run_count)
{
    pl_internal_edges *s = &world->internal_edges;
    run_contact *contacts = s->contacts.data;
    pl_keyed *order = s->order.data;
    flat_run *runs = s->runs.data;
    uint32_t count = 0;
    for (uint32_t i = first; i != PL_NONE; i = contacts[i].next) {
        order[count++] = (pl_keyed){ key_of(contacts[i].low), contacts[i].index, i };
    }
    pl_sort_keyed(order, count);
    *run_count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        run_contact *r = &contacts[order[i].value];
        uint32_t least = *run_count > OPEN_RUNS ? *run_count - OPEN_RUNS : 0;
        uint32_t k = *run_count;
        while (k > least && !continues(world, &runs[k - 1], &contacts[runs[k - 1].owner], r)) {
            --k;
        }
        if (k == least) {
            runs[*run_count] = (flat_run){ order[i].value, 0, r->low, r->high };
            k = ++*run_count;
        }
        flat_run *joined = &runs[k - 1];
        joined->high = pl_greater(joined->high, r->high);
        joined->owner = r->height > contacts[joined->owner].height ? order[i].value : joined->owner;
        ++joined->count;
        r->run = k - 1;
    }
    return count;
}

//---- what they bear ------------------------------------------------------------------------------

// Static bodies are one ground: none.
static plumb_entity ground_body_of(const plumb_world *world, const run_contact *r)
{
    const uint32_t piece = ground_of(world, r);
    return pl_piece_is_static(world, piece)
               ? (plumb_entity){ 0 }
               : world->bodies.entity[world->pieces.body[piece]].entity;
}

static const pl_run_load *load_of(const plumb_world *world, const run_contact *r,
                                  const pl_manifold *m)
{
    const uint32_t mover = r->mover;
    const plumb_entity ground = ground_body_of(world, r);
    const pl_internal_edges *s = &world->internal_edges;
    const pl_run_load *loads = s->old_loads.data;
    uint32_t i = ((const run_slot *)s->slots.data)[mover].load;
    for (; i != PL_NONE; i = loads[i].next) {
        bool same = loads[i].serial == world->pieces.serial[mover] &&
                    plumb_entity_same(loads[i].ground, ground) &&
                    loads[i].nx * m->nx + loads[i].ny * m->ny > (real)0.99;
        if (same) {
            return &loads[i];
        }
    }
    return NULL;
}

// Impulses of the step before follow the mover's corners; the pair's own serve where none were noted.
static void carry_load(plumb_world *world, const run_contact *r, pl_pair *pair, pl_manifold *m)
{
    const pl_edge_pair *kept = (const pl_edge_pair *)world->internal_edges.pairs.data + r->index;
    const pl_run_load *load = load_of(world, r, m);
    const uint32_t *feature = load != NULL ? load->feature : kept->feature;
    const near_real *normal = load != NULL ? load->normal : kept->normal;
    const near_real *tangent = load != NULL ? load->tangent : kept->tangent;
    pair->rolling = load != NULL ? load->rolling : pair->rolling;
    for (uint32_t k = 0; k < 2; ++k) {
        for (int j = 0; j < 2 && k < m->count; ++j) {
            if (feature[j] == m->feature[k]) {
                m->point[k].normal = normal[j];
                m->point[k].tangent = tangent[j];
            }
        }
        pair->feature[k] = m->feature[k];
        pair->normal[k] = m->point[k].normal;
        pair->tangent[k] = m->point[k].tangent;
    }
}

static void keep_load(pl_run_load *load, const pl_pair *pair)
{
    load->rolling = pair->rolling;
    for (int k = 0; k < 2; ++k) {
        load->feature[k] = pair->feature[k];
        load->normal[k] = pair->normal[k];
        load->tangent[k] = pair->tangent[k];
    }
}

static void note_load(plumb_world *world, const run_contact *r, const pl_manifold *m)
{
    pl_internal_edges *s = &world->internal_edges;
    pl_run_load *load = (pl_run_load *)s->loads.data + s->load_count++;
    *load = (pl_run_load){ .mover = r->mover,
                           .serial = world->pieces.serial[r->mover],
                           .next = PL_NONE,
                           .pair = m->pair,
                           .ground = ground_body_of(world, r),
                           .nx = m->nx,
                           .ny = m->ny };
    keep_load(load, pl_pair_of(world, m));
}

#define BENT_OVER 4 // faces on either side whose mean bend is taken: corners are rounded numbers

// [rad] by which the face of chain piece q turns from that of p, and how far it is from middle to middle; false where q does not go on at
// that end of p (1: where its edge ends).
static bool goes_on(const plumb_world *world, uint32_t p, uint32_t q, int end, double *turn,
                    double *length)
{
    const pl_pieces *pieces = &world->pieces;
    if (q >= pieces->table.count || pieces->vertex_count[q] != 2 ||
        memcmp(&pieces->shape[p], &pieces->shape[q], sizeof pieces->shape[p]) != 0) {
        return false;
    }
    const pl_vertex *a = world->vertices.items + pieces->vertices[p];
    const pl_vertex *b = world->vertices.items + pieces->vertices[q];
    const pl_vertex *own = &a[end], *other = &b[1 - end];
    if (own->x != other->x || own->y != other->y) {
        return false;
    }
    const double nx = (double)a->nx, ny = (double)a->ny, mx = (double)b->nx, my = (double)b->ny;
    const double across = nx * my - ny * mx;
    if (!(fabs(across) < PL_EDGE_ANGLE) || nx * mx + ny * my < 0) {
        return false;
    }
    *turn += end == 1 ? across : -across;
    *length += (double)(pieces->core[p].hx + pieces->core[q].hx);
    return true;
}

// [1/m] of a chain about one of its lines, seen from its front: positive where it bulges, 0 where it is straight or no chain.
static double bend_of(const plumb_world *world, uint32_t piece)
{
    if (world->pieces.vertex_count[piece] != 2) {
        return 0;
    }
    double turn = 0, length = 0;
    for (int end = 0; end < 2; ++end) {
        for (int way = -1; way <= 1; way += 2) {
            uint32_t p = piece;
            for (int i = 0; i < BENT_OVER; ++i) {
                const uint32_t q = p + (uint32_t)way;
                if (!goes_on(world, p, q, end, &turn, &length)) {
                    break;
                }
                p = q;
            }
        }
    }
    return length > 0 ? turn / length : 0;
}

// [1/m] less is straight: a radius that the numbers of the solver do not hold.
#define LEAST_BEND 1e-3

// Puts a contact of one point on the arc that the faces of its ground are chords of: the normal turns along the way
// instead of from face to face.
static bool bear_on_arc(const pl_view *v, const pl_strip *strip, pl_face_point p, double bend,
                        uint32_t feature, pl_manifold *m)
{
    const pl_face *f = &strip->f;
    const double radius = 1 / bend, half = f->length / 2;
    const double back = (bend > 0 ? 1 : -1) * sqrt(pl_greater(radius * radius - half * half, 0));
    // From the arc's middle to the core, in the face's frame.
    const double x = p.u + back, y = p.v - half, far = sqrt(x * x + y * y);
    const double c = (bend > 0 ? x : -x) / far, s = (bend > 0 ? y : -y) / far;
    if (!(c > 0.5)) {
        return false;
    }
    pl_face on = { .nx = c * f->nx - s * f->ny, .ny = c * f->ny + s * f->nx };
    on.x = f->x - back * f->nx - half * f->ny + radius * on.nx;
    on.y = f->y - back * f->ny + half * f->nx + radius * on.ny;
    const pl_face_point at = { (bend > 0 ? far : -far) - radius, 0 };
    if (pl_view_write(v, &on, &at, 1, feature, m) == 0) {
        return false;
    }
    m->point[1].bend = (near_real)bend;
    return true;
}

// Gives the run to its owner. False when nothing of the mover lies over it: all stay as they are.
static bool bear(plumb_world *world, const flat_run *run, double dt)
{
    const pl_internal_edges *s = &world->internal_edges;
    const run_contact *r = (const run_contact *)s->contacts.data + run->owner;
    pl_pair *pair =
        &pl_pairs(&world->broad.pairs)[((const pl_edge_pair *)s->pairs.data)[r->index].pair];
    pl_manifold *m = &pl_manifolds(&world->narrow)[pair->manifold];
    pl_view v;
    pl_view_open(&v, world, pair, m, r->own_is_a, dt);
    pl_view_bring_other(&v);
    pl_strip strip = pl_view_strip(&v, r->edge);
    strip.low += run->low - r->low;
    strip.high += run->high - r->high;
    pl_face_point points[2];
    int feature = 0;
    int count = pl_view_points(&v, &strip, points, &feature);
    pl_manifold written = *m;
    if (pl_view_write(&v, &strip.f, points, count, PL_RUN_FEATURE | (uint32_t)feature << 1,
                      &written) == 0) {
        return false;
    }
    const double bend = written.count == 1 ? bend_of(world, v.own) : 0;
    pl_manifold on_arc = *m;
    if (fabs(bend) > LEAST_BEND && bear_on_arc(&v, &strip, points[0], r->edge == 0 ? bend : -bend,
                                               PL_RUN_FEATURE | (uint32_t)feature << 1, &on_arc)) {
        written = on_arc;
    }
    *m = written;
    carry_load(world, r, pair, m);
    note_load(world, r, m);
    return true;
}

static void stand_back(plumb_world *world, const run_contact *r, const run_contact *owner)
{
    const pl_edge_pair *list = world->internal_edges.pairs.data;
    pl_pair *pair = &pl_pairs(&world->broad.pairs)[list[r->index].pair];
    pl_manifolds(&world->narrow)[pair->manifold].bearer = list[owner->index].pair;
    pair->flags |= PL_PAIR_BORNE;
    pl_pair_forget(pair);
}

bool pl_runs_join(plumb_world *world, double dt)
{
    pl_internal_edges *s = &world->internal_edges;
    if (!reserve_runs(world)) {
        clear_slots(world);
        return false;
    }
    run_contact *contacts = s->contacts.data;
    run_slot *slots = s->slots.data;
    for (uint32_t i = 0; i < s->contact_count; ++i) {
        uint32_t first = slots[contacts[i].mover].contact, run_count;
        if (first == PL_NONE) {
            continue; // its mover has had its turn
        }
        slots[contacts[i].mover].contact = PL_NONE;
        uint32_t count = join(world, first, &run_count);
        flat_run *runs = s->runs.data;
        for (uint32_t k = 0; k < run_count; ++k) {
            runs[k].count = bear(world, &runs[k], dt) ? runs[k].count : 0;
        }
        const pl_keyed *order = s->order.data;
        for (uint32_t k = 0; k < count; ++k) {
            const run_contact *r = &contacts[order[k].value];
            const flat_run *of = &runs[r->run];
            if (of->count > 1 && of->owner != order[k].value) {
                stand_back(world, r, &contacts[of->owner]);
            }
        }
    }
    clear_slots(world);
    return true;
}

void pl_runs_undo(pl_internal_edges *s)
{
    if (s->opened) {
        swap_loads(s);
        s->opened = false;
    }
}

void pl_runs_follow(plumb_world *world, const uint32_t *places)
{
    pl_internal_edges *s = &world->internal_edges;
    pl_run_load *loads = s->loads.data;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->load_count; ++i) {
        if (places[loads[i].pair] != PL_NONE) {
            loads[kept] = loads[i];
            loads[kept].pair = places[loads[i].pair];
            ++kept;
        }
    }
    s->load_count = kept;
}

void pl_internal_edges_remember(plumb_world *world)
{
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    pl_run_load *loads = world->internal_edges.loads.data;
    for (uint32_t i = 0; i < world->internal_edges.load_count; ++i) {
        keep_load(&loads[i], &pairs[loads[i].pair]);
    }
}

bool pl_internal_edges_borne_touches(const plumb_world *world, const pl_manifold *m)
{
    const pl_pair *pair = &pl_pairs(&world->broad.pairs)[m->bearer];
    if (pair->manifold == PL_NONE) {
        return false;
    }
    const pl_manifold *bearer = &pl_manifolds(&world->narrow)[pair->manifold];
    real gap = plumb_min(bearer->point[0].separation, bearer->point[1].separation);
    real own = plumb_min(m->point[0].separation, m->point[1].separation);
    return pl_has_met(pair, bearer) && (m->met & PL_MET_ASIDE) == 0 &&
           own - plumb_max(gap, 0) <= (real)PL_EDGE_SLOP;
}
