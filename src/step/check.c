// check.c - names of data, and what rows write against what they declare.
//
// While somebody watches (plumb_world_watch), all data that a digest can be made of is digested before and behind each
// row: what changed must be among what the row declares. A row that moves rows moves all columns of bodies.
//
// Reads: the world. Writes: digests. Cost: O(world) a row.
#include "step/pass.h"
#include "step/data.h"
#include "core/digest.h"
#include "core/sort.h"
#include "solver/solver.h"
#include "world/state.h"

#include <string.h>

static const char *const names[PL_DATA_COUNT] = {
#define NAME(name, text, what) [PL_DATA_##name] = text,
    PL_DATA(NAME)
#undef NAME
};

const char *pl_data_name(int index)
{
    return names[index];
}

//---- names ---------------------------------------------------------------------------------------

static bool is_name(const char *name, const char *text, size_t length)
{
    return strlen(name) == length && memcmp(name, text, length) == 0;
}

static uint32_t mask_of(const plumb_world *world, const char *text, size_t length)
{
    for (int i = 0; i < PL_DATA_COUNT; ++i) {
        if (is_name(names[i], text, length)) {
            return UINT32_C(1) << i;
        }
    }
    for (uint32_t i = 0; world != NULL && i < world->components.count; ++i) {
        if (is_name(world->components.items[i].name, text, length)) {
            return PL_COMPONENTS;
        }
    }
    return 0;
}

bool pl_data_parse(const plumb_world *world, const char *text, uint32_t *mask, const char **unknown,
                   int *length)
{
    *mask = 0;
    while (text != NULL && *text != '\0') {
        size_t size = 0;
        while (text[size] != '\0' && text[size] != ',') {
            ++size;
        }
        const uint32_t bit = mask_of(world, text, size);
        if (bit == 0) {
            *unknown = text;
            *length = size < PL_NAME_MAX ? (int)size : PL_NAME_MAX;
            return false;
        }
        *mask |= bit;
        text += size;
        while (*text == ',' || *text == ' ') {
            ++text;
        }
    }
    return true;
}

//---- digests -------------------------------------------------------------------------------------

// At bytes of data: digested, or only counted.
typedef struct look {
    pl_digest digest;
    size_t bytes;
    bool counts;
} look;

static void look_at(look *d, const void *bytes, size_t size)
{
    d->bytes += size;
    if (!d->counts) {
        pl_digest_add(&d->digest, bytes, size);
    }
}

typedef struct column {
    const void *data;
    size_t size; // [B] of a value
} column;

static void add_columns(look *d, const column *columns, size_t count, uint32_t rows)
{
    for (size_t i = 0; i < count; ++i) {
        look_at(d, columns[i].data, columns[i].size * rows);
    }
}

#define COLUMNS(rows, ...)                                                                         \
    do {                                                                                           \
        const column list[] = { __VA_ARGS__ };                                                     \
        add_columns(d, list, sizeof list / sizeof list[0], rows);                                  \
    } while (0)
#define OF(table, name)                                                                            \
    {                                                                                              \
        (table)->name, sizeof *(table)->name                                                       \
    }

static void add_bodies(look *d, const plumb_world *w, int data)
{
    const pl_bodies *b = &w->bodies;
    const uint32_t rows = b->table.count;
    switch (data) {
    case PL_DATA_ROWS:
        COLUMNS(rows, OF(b, entity), OF(b, type));
        break;
    case PL_DATA_POSES:
        COLUMNS(rows, OF(b, x), OF(b, y), OF(b, center_x), OF(b, center_y), OF(b, c), OF(b, s));
        break;
    case PL_DATA_VELOCITIES:
        COLUMNS(rows, OF(b, vx), OF(b, vy), OF(b, w));
        break;
    case PL_DATA_FORCES:
        COLUMNS(rows, OF(b, fx), OF(b, fy), OF(b, torque));
        break;
    case PL_DATA_MASSES:
        COLUMNS(rows, OF(b, inv_mass), OF(b, inv_inertia), OF(b, mass), OF(b, inertia));
        break;
    case PL_DATA_ISLANDS:
        COLUMNS(rows, OF(b, island), OF(b, next_asleep), OF(b, previous_asleep));
        break;
    default:
        break;
    }
}

static void add_solver(look *d, const plumb_world *w, int data)
{
    const pl_solver *s = &w->solver;
    for (uint32_t i = 0; i < s->slot_count; ++i) {
        const pl_solver_motion *m = &pl_solver_motions(s)[i];
        if (data == PL_DATA_SOLVER_BODIES) {
            look_at(d, &pl_solver_bodies(s)[i], sizeof(pl_solver_body));
        } else {
            look_at(d, &m->ax, sizeof m->ax);
            look_at(d, &m->ay, sizeof m->ay);
            look_at(d, &m->aw, sizeof m->aw);
        }
    }
}

// Bytes as they lie, padding too: what is not written stays as it is.
static void add_list(look *d, const void *items, uint32_t count, size_t size)
{
    look_at(d, &count, sizeof count);
    look_at(d, items, count * size);
}

static void add_records(look *d, const plumb_world *w, int data)
{
    const pl_body_settings *t = w->settings.items.data;
    switch (data) {
    case PL_DATA_BODY_SETTINGS:
        for (uint32_t i = 0; i < w->settings.count; ++i) {
            look_at(d, &t[i], PL_SETTINGS_SAVED);
        }
        break;
    case PL_DATA_TARGETS:
        add_list(d, w->targets.items.data, w->targets.count, sizeof(pl_target));
        add_list(d, w->tracks.items.data, w->tracks.count, sizeof(pl_track));
        break;
    case PL_DATA_COMPONENTS:
        for (uint32_t i = 0; i < w->components.count; ++i) {
            const pl_component *c = &w->components.items[i];
            look_at(d, c->values.data, c->count * c->desc.size);
        }
        break;
    case PL_DATA_PAIRS:
        add_list(d, pl_pairs(&w->broad.pairs), w->broad.pairs.count, sizeof(pl_pair));
        break;
    case PL_DATA_MANIFOLDS:
        add_list(d, w->narrow.manifolds.data, w->narrow.manifold_count, sizeof(pl_manifold));
        break;
    case PL_DATA_JOINTS:
        add_list(d, w->joints.items.data, w->joints.count, sizeof(pl_joint));
        break;
    case PL_DATA_CHARACTERS:
        add_list(d, w->characters.items.data, w->characters.count, sizeof(pl_character));
        break;
    case PL_DATA_LIQUID:
        add_list(d, w->liquid.particles.data, w->liquid.count, sizeof(plumb_particle));
        break;
    case PL_DATA_AIR:
        add_list(d, w->air.cells.data, w->air.cell_count, sizeof(plumb_air_cell));
        break;
    case PL_DATA_SOFT_BODIES:
        add_list(d, w->softbodies.nodes.data, w->softbodies.node_count,
                 sizeof(plumb_softbody_node));
        add_list(d, w->softbodies.edges.data, w->softbodies.edge_count,
                 sizeof(plumb_softbody_edge));
        break;
    case PL_DATA_SENSORS:
        add_list(d, w->sensing.candidates.data, w->sensing.candidate_count, sizeof(pl_keyed));
        add_list(d, w->sensing.overlaps.data, w->sensing.count, sizeof(pl_overlap));
        break;
    case PL_DATA_MOVERS:
        add_list(d, w->continuous.movers.data, w->continuous.count, sizeof(pl_mover));
        break;
    case PL_DATA_SETTINGS:
        look_at(d, &w->desc, sizeof w->desc);
        break;
    case PL_DATA_EVENTS:
        look_at(d, &w->begin_count, sizeof w->begin_count);
        look_at(d, &w->end_count, sizeof w->end_count);
        look_at(d, &w->hit_count, sizeof w->hit_count);
        break;
    case PL_DATA_TIME:
        look_at(d, &w->time, sizeof w->time);
        look_at(d, &w->step_count, sizeof w->step_count);
        break;
    case PL_DATA_MATERIALS: {
        const pl_materials *m = &w->materials;
        COLUMNS(m->table.count, OF(m, friction), OF(m, restitution), OF(m, density));
        break;
    }
    case PL_DATA_PIECES: {
        const pl_pieces *p = &w->pieces;
        COLUMNS(p->table.count, OF(p, kind), OF(p, vertices), OF(p, material), OF(p, category));
        break;
    }
    default:
        break;
    }
}

static void look_at_data(look *d, const plumb_world *w, int data)
{
    if (data == PL_DATA_SOLVER_BODIES || data == PL_DATA_ACCELERATIONS) {
        add_solver(d, w, data);
    } else {
        add_bodies(d, w, data);
        add_records(d, w, data);
    }
}

// Data without a digest has none that changes.
static uint64_t digest_of(const plumb_world *w, int data)
{
    look d = { .bytes = 0 };
    pl_digest_begin(&d.digest);
    look_at_data(&d, w, data);
    return pl_digest_end(&d.digest);
}

static size_t grid_bytes(const pl_grid *grid)
{
    return grid->entries.size + grid->starts.size + grid->maps.size;
}

size_t plumb_data_bytes(const plumb_world *world, int index)
{
    look d = { .counts = true };
    if (world == NULL || index < 0 || index >= PL_DATA_COUNT) {
        return 0;
    }
    look_at_data(&d, world, index);
    switch (index) { // those that are not digested: what is held for them
    case PL_DATA_GRIDS:
        return grid_bytes(&world->broad.moving) + grid_bytes(&world->broad.fixed) +
               grid_bytes(&world->broad.resting);
    case PL_DATA_CONSTRAINTS:
        return (size_t)world->solver.bundle_room * pl_solver_kernels(world)->bundle_size;
    default:
        return d.bytes;
    }
}

bool pl_check_reserve(plumb_world *world)
{
    return pl_buffer_reserve(&world->memory, &world->schedule.digests,
                             PL_DATA_COUNT * sizeof(uint64_t));
}

void pl_check_before(plumb_world *world)
{
    uint64_t *digests = world->schedule.digests.data;
    for (int i = 0; i < PL_DATA_COUNT; ++i) {
        digests[i] = digest_of(world, i);
    }
}

#define COLUMNS_OF_BODIES                                                                          \
    (PL_POSES | PL_VELOCITIES | PL_FORCES | PL_MASSES | PL_ISLANDS | PL_BODY_SETTINGS | PL_TARGETS)

void pl_check_after(plumb_world *world, const char *name, uint32_t writes)
{
    const uint64_t *digests = world->schedule.digests.data;
    writes |= (writes & PL_ROWS) != 0 ? COLUMNS_OF_BODIES : 0;
    for (int i = 0; i < PL_DATA_COUNT; ++i) {
        if ((writes >> i & 1) == 0 && digest_of(world, i) != digests[i]) {
            ++world->schedule.breaches;
            pl_fail(world, PLUMB_E_STATE, "plumb_world_step",
                    "'%s' changed %s, which it does not declare to write", name, names[i]);
        }
    }
}
