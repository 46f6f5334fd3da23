// check_extras.c - see check.h: ground of many pieces, and what few bodies have.
//
// Reads: the image. Writes: marks. Cost: O(state).
#include "api/command.h"
#include "snapshot/check.h"
#include "world/check.h"
#include "broad/pairs.h"
#include "internal_edges/cone.h"
#include "effects/laws.h"
#include "air/air.h"
#include "liquid/liquid.h"
#include "softbody/softbody.h"
#include "world/waves_list.h"
#include "world/wrap.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

#define CHECK_REALS(path) pl_are_reals(&(path), sizeof(path) / (sizeof(real)))
#define CHECK_NEAR(path)  pl_are_near_reals(&(path), sizeof(path) / (sizeof(near_real)))
#define CHECK_BOOL(path)  pl_are_bools(&(path), 1)

//---- internal edges ---------------------------------------------------------------------------------------

static bool check_internal_edge(const pl_internal_edges *s, const pl_edge *c, bool partly)
{
    return CHECK_BOOL(c->flat) && CHECK_REALS(c->lo_x) && CHECK_REALS(c->lo_y) &&
           CHECK_REALS(c->hi_x) && CHECK_REALS(c->hi_y) && CHECK_REALS(c->walls) &&
           CHECK_REALS(c->slop) && c->form <= PL_CONE_ENDS && c->ends[0] <= PL_END_INNER &&
           c->ends[1] <= PL_END_INNER &&
           (!partly ||
            (c->interval_count > 0 && c->intervals < s->interval_used &&
             c->interval_count <= s->interval_used - c->intervals &&
             pl_are_reals(pl_edge_intervals(s) + c->intervals, (size_t)c->interval_count * 2)));
}

static bool check_piece_internal_edges(const plumb_world *w, uint32_t p)
{
    const pl_pieces *pieces = &w->pieces;
    const pl_internal_edges *s = &w->internal_edges;
    const uint32_t corners = pieces->internal_corners[p], edges = pieces->internal_edges[p];
    const uint32_t count = pieces->vertex_count[p], known = (UINT32_C(1) << count) - 1;
    const bool has = (corners & PL_EDGE_ANY) != 0;
    if ((corners & PL_EDGE_CHOSEN) != 0 || (corners & PL_EDGE_CORNERS & ~known) != 0 ||
        (edges & ~(known | known << 16)) != 0 || (!has && edges != 0) ||
        (!has && (corners & PL_EDGE_CORNERS) != 0)) {
        return false;
    }
    if (has &&
        (pieces->vertices[p] > s->corner_count || count > s->corner_count - pieces->vertices[p])) {
        return false;
    }
    for (uint32_t k = 0; has && k < count; ++k) {
        if (!check_internal_edge(s, &pl_edge_items(s)[pieces->vertices[p] + k],
                                 (edges & PL_EDGE_PARTLY(k)) != 0)) {
            return false;
        }
    }
    return true;
}

// Free runs of intervals; the link to the next lies in the bytes of the first one.
static bool check_intervals(const pl_internal_edges *s)
{
    for (uint32_t c = 0; c < PL_INTERVAL_CLASSES; ++c) {
        uint32_t steps = 0;
        for (uint32_t i = s->interval_free[c]; i != 0;) {
            const uint64_t end = (uint64_t)(i - 1) + (UINT64_C(1) << c);
            if (end > s->interval_used || steps++ == s->interval_used) {
                return false;
            }
            memcpy(&i, pl_edge_intervals(s) + (i - 1), sizeof i);
        }
    }
    return true;
}

static bool check_internal_edge_lists(const plumb_world *w)
{
    const pl_internal_edges *s = &w->internal_edges;
    const pl_edge_pair *pairs = s->pairs.data;
    const pl_run_load *loads = s->loads.data;
    // Else they are listed anew before anyone looks, and pairs as well.
    const bool fresh =
        !s->relist && s->listed == w->broad.rebuilds && !w->pairs_dirty && !w->broad.stale;
    if (s->listed > w->broad.rebuilds) {
        return false;
    }
    for (uint32_t i = 0; i < s->pair_count; ++i) {
        if ((fresh && pairs[i].pair >= w->broad.pairs.count) || !CHECK_NEAR(pairs[i].normal) ||
            !CHECK_NEAR(pairs[i].tangent) || !CHECK_NEAR(pairs[i].rolling) ||
            (i > 0 && pairs[i].pair <= pairs[i - 1].pair)) {
            return false;
        }
    }
    for (uint32_t i = 0; i < s->load_count; ++i) {
        if (loads[i].mover >= w->pieces.table.count || !CHECK_NEAR(loads[i].normal) ||
            !CHECK_NEAR(loads[i].tangent) || !CHECK_NEAR(loads[i].rolling) ||
            !CHECK_NEAR(loads[i].nx) || !CHECK_NEAR(loads[i].ny)) {
            return false;
        }
    }
    return pl_are_reals(s->regions.data, (size_t)s->region_count * 4);
}

bool pl_check_internal_edges(pl_suspect *s)
{
    const plumb_world *w = &s->world;
    uint32_t have = 0;
    for (uint32_t p = 0; p < w->pieces.table.count; ++p) {
        const bool is_free = w->pieces.kind[p] == PL_PIECE_FREE;
        if (is_free ? w->pieces.internal_corners[p] != 0 : !check_piece_internal_edges(w, p)) {
            return false;
        }
        have += (w->pieces.internal_corners[p] & PL_EDGE_ANY) != 0;
    }
    return have == w->internal_edges.count && check_intervals(&w->internal_edges) &&
           check_internal_edge_lists(w);
}

//---- characters ----------------------------------------------------------------------------------

static bool check_walk(const pl_character *c)
{
    const real positive[] = {
        c->desc.skin,           c->desc.step_height,  c->desc.step_width,
        c->desc.snap_distance,  c->desc.acceleration, c->desc.air_acceleration,
        c->desc.max_fall_speed, c->desc.mass,         c->desc.push_force,
        c->desc.max_slope,      c->air_time,          c->push
    };
    for (size_t i = 0; i < sizeof positive / sizeof positive[0]; ++i) {
        if (!(positive[i] >= 0) || positive[i] - positive[i] != 0) {
            return false;
        }
    }
    return c->desc.max_slope <= (real)1.5 && CHECK_REALS(c->desc.up) && CHECK_REALS(c->walk) &&
           CHECK_REALS(c->fly) && CHECK_REALS(c->jump) && CHECK_REALS(c->velocity) &&
           CHECK_REALS(c->speed) && c->rise - c->rise == 0 && c->step_top - c->step_top == 0 &&
           CHECK_REALS(c->push_speed) && CHECK_REALS(c->weight) && CHECK_REALS(c->weight_speed) &&
           CHECK_REALS(c->body_velocity);
}

static bool check_character(const pl_suspect *s, const pl_character *c, uint32_t i)
{
    const uint32_t row = pl_suspect_row(s, c->body);
    const bool bools = CHECK_BOOL(c->flies) && CHECK_BOOL(c->thrown) && CHECK_BOOL(c->on_ground) &&
                       CHECK_BOOL(c->climbs) && CHECK_BOOL(c->on_slope) && CHECK_BOOL(c->at_wall) &&
                       CHECK_BOOL(c->at_ceiling) && CHECK_BOOL(c->crushed) &&
                       CHECK_BOOL(c->desc.no_steps) && CHECK_BOOL(c->desc.no_snap) &&
                       CHECK_BOOL(c->desc.no_push) && CHECK_BOOL(c->desc.no_air_control);
    if (!bools || row == PL_NONE || s->world.bodies.character[row] != i + 1 || !check_walk(c) ||
        c->slope_side < -1 || c->slope_side > 1 || c->passing_count < 0 ||
        c->passing_count > PL_CHARACTER_PASSING || c->hit_count < 0 ||
        c->hit_count > PLUMB_CHARACTER_HITS) {
        return false;
    }
    const pl_ground *g = &c->ground;
    return CHECK_REALS(g->point) && CHECK_REALS(g->local) && CHECK_REALS(g->normal) &&
           CHECK_REALS(g->velocity) && CHECK_REALS(g->spin);
}

//---- the rest ------------------------------------------------------------------------------------

static bool check_settings_of(const pl_suspect *s, const pl_body_settings *t, uint32_t i)
{
    const uint32_t row = pl_suspect_row(s, t->body);
    plumb_body_desc desc = { 0 };
#define TAKE(name, initial) desc.name = t->name;
    PL_BODY_ROWS(PL_ROW_RECORD, TAKE)
#undef TAKE
    return row != PL_NONE && s->world.bodies.settings[row] == i + 1 &&
           pl_desc_is_sound(PLUMB_TABLE_BODY, &desc);
}

static bool check_settings(const pl_suspect *s)
{
    const pl_body_settings_list *all = &s->world.settings;
    const pl_body_settings *items = all->items.data;
    uint32_t damped = 0, dragged = 0, engines = 0, breakable = 0, dipoles = 0, capped = 0,
             scaled = 0, frozen = 0;
    for (uint32_t i = 0; i < all->count; ++i) {
        if (!check_settings_of(s, &items[i], i)) {
            return false;
        }
        damped += items[i].damping > 0 || items[i].angular_damping > 0;
        dragged += items[i].drag > 0;
        engines += items[i].thrust > 0;
        breakable += items[i].break_force > 0 || items[i].break_impulse > 0;
        dipoles += items[i].dipole != 0;
        capped += items[i].max_speed > 0 || items[i].max_spin > 0;
        scaled += items[i].time_scale != 1;
        frozen += items[i].time_scale == 0;
    }
    return damped == all->damped && dragged == all->dragged && engines == all->engines &&
           breakable == all->breakable && dipoles == all->dipoles && capped == all->capped &&
           scaled == all->scaled && frozen == all->frozen;
}

static bool check_track(const pl_track *track)
{
    bool sound = CHECK_REALS(track->x) && CHECK_REALS(track->y) && CHECK_REALS(track->turn) &&
                 track->time > 0 && track->left >= 0 && track->left <= track->time &&
                 track->time - track->time == 0;
    for (int k = 0; k < 3; ++k) {
        const pl_track_axis *x = &track->axis[k];
        const double sum = x->speed + x->rate + x->jerk + track->end[k];
        sound = sound && sum - sum == 0;
    }
    return sound;
}

static bool check_targets(const pl_suspect *s)
{
    const plumb_world *w = &s->world;
    const pl_track *tracks = w->tracks.items.data;
    const pl_target *items = w->targets.items.data;
    uint32_t flagged = 0;
    for (uint32_t i = 0; i < w->targets.count; ++i) {
        const uint32_t row = pl_suspect_row(s, items[i].body);
        if (row == PL_NONE || (w->bodies.flags[row] & PL_BODY_TARGETED) == 0 ||
            !CHECK_REALS(items[i].x) || !CHECK_REALS(items[i].y) || !CHECK_REALS(items[i].turn) ||
            !CHECK_REALS(items[i].left) || items[i].left < 0) {
            return false;
        }
    }
    for (uint32_t i = 0; i < w->tracks.count; ++i) {
        const uint32_t row = pl_suspect_row(s, tracks[i].body);
        if (row == PL_NONE || (w->bodies.flags[row] & PL_BODY_TARGETED) == 0 ||
            !check_track(&tracks[i])) {
            return false;
        }
    }
    for (uint32_t row = 0; row < w->bodies.table.count; ++row) {
        flagged += (w->bodies.flags[row] & PL_BODY_TARGETED) != 0;
    }
    return flagged == w->targets.count + w->tracks.count;
}

// Bodies that say that they have a record have one: as many as there are records.
static bool check_records(const plumb_world *w)
{
    uint32_t characters = 0, has_settings = 0;
    for (uint32_t row = 0; row < w->bodies.table.count; ++row) {
        characters += w->bodies.character[row] != 0;
        has_settings += w->bodies.settings[row] != 0;
        if (((w->bodies.flags[row] & PL_BODY_HAS_SETTINGS) != 0) !=
            (w->bodies.settings[row] != 0)) {
            return false;
        }
    }
    return characters == w->characters.count && has_settings == w->settings.count;
}

// What has gone meanwhile is passed over.
static bool check_supports(const pl_liquid_supports *supports)
{
    const pl_liquid_support *all = supports->items.data;
    bool sound = true;
    for (uint32_t i = 0; i < supports->count && sound; ++i) {
        sound = (i == 0 || all[i - 1].key < all[i].key) && all[i].wet <= PL_LIQUID_WET_SOFTBODY;
        for (int k = 0; k < 3; ++k) {
            sound &=
                all[i].last[k] - all[i].last[k] == 0 && all[i].before[k] - all[i].before[k] == 0;
        }
    }
    return sound;
}

static bool check_liquid(const plumb_world *w)
{
    const pl_liquid *f = &w->liquid;
    if (f->settings_count > 1 || f->count > PLUMB_LIQUID_MAX ||
        f->phase_count > PLUMB_LIQUID_MAX_PHASES ||
        (f->count + f->phase_count + f->supports.count > 0 && f->settings_count == 0)) {
        return false;
    }
    bool sound = f->settings_count == 0 || pl_liquid_desc_is_sound(pl_liquid_desc(f));
    for (uint32_t i = 0; i < f->phase_count && sound; ++i) {
        sound = pl_liquid_phase_is_sound(&pl_liquid_phases(f)[i], pl_liquid_desc(f)->density);
    }
    sound = sound && check_supports(&f->supports);
    for (uint32_t i = 0; i < f->count && sound; ++i) {
        sound = pl_liquid_particle_is_sound(&pl_liquid_items(f)[i], f->phase_count);
    }
    return sound;
}

static bool check_air(const plumb_world *w)
{
    const pl_air *air = &w->air;
    if (air->settings_count == 0) {
        return air->cell_count == 0 && air->source_count == 0 && air->supports.count == 0;
    }
    if (air->settings_count > 1 || air->source_count > PLUMB_AIR_MAX_SOURCES || pl_is_wrapped(w) ||
        !pl_air_desc_is_sound(pl_air_desc(air))) {
        return false;
    }
    const pl_air_extent box = pl_air_extent_of(pl_air_desc(air));
    bool sound = air->cell_count == (uint32_t)((box.columns + 1) * (box.rows + 1)) &&
                 check_supports(&air->supports);
    for (uint32_t i = 0; i < air->cell_count && sound; ++i) {
        sound = pl_air_cell_is_sound(&pl_air_items(air)[i]);
    }
    for (uint32_t i = 0; i < air->source_count && sound; ++i) {
        sound = pl_air_source_is_sound(&pl_air_sources(air)[i]);
    }
    return sound;
}

static bool check_softbodies(const pl_suspect *s)
{
    const pl_softbodies *f = &s->world.softbodies;
    bool sound = pl_softbodies_are_sound(f) && (f->count == 0 || !pl_is_wrapped(&s->world));
    for (uint32_t i = 0; i < f->pin_count && sound; ++i) {
        const plumb_body body = pl_softbody_pins(f)[i].body;
        sound = plumb_is_null(body) || pl_suspect_row(s, body) != PL_NONE;
    }
    return sound;
}

// Each law of that kind has its own, in their order.
static bool check_formulas(const pl_laws *laws)
{
    uint32_t count = 0;
    bool sound = true;
    for (uint32_t i = 0; i < laws->count && sound; ++i) {
        const pl_law *law = &pl_law_items(laws)[i];
        const bool has = law->desc.kind == PLUMB_LAW_FORMULA;
        sound = law->formula == (has ? count + 1 : 0) && (!has || count < laws->formula_count);
        if (has && sound) {
            const pl_law_formula *formula = &pl_law_formulas(laws)[count++];
            sound = plumb_same(formula->law, law->entity) && pl_law_formula_is_sound(formula);
        }
    }
    return sound && count == laws->formula_count;
}

static bool check_laws(const pl_suspect *s)
{
    const pl_laws *laws = &s->world.laws;
    bool sound = laws->orbit_count <= 1 && (laws->count == 0 || !pl_is_wrapped(&s->world)) &&
                 (laws->orbit_count == 0 ||
                  pl_orbit_desc_is_sound((const plumb_orbit_desc *)laws->orbits.data));
    for (uint32_t i = 0; i < laws->count && sound; ++i) {
        const pl_law *law = &pl_law_items(laws)[i];
        const plumb_body body = law->desc.body;
        sound = pl_law_desc_is_sound(&law->desc) && law->x - law->x == 0 && law->y - law->y == 0 &&
                *(const uint8_t *)&law->placed <= 1 &&
                (plumb_is_null(body) || pl_suspect_row(s, body) != PL_NONE);
    }
    return sound && check_formulas(laws);
}

// Their shapes have the flag, each once, and modes follow one another.
static bool check_waves(const pl_suspect *s)
{
    const pl_waves *w = &s->world.waves;
    const pl_wave_surface *all = pl_wave_surfaces(w);
    const double *modes = w->modes.data;
    uint32_t at = 0;
    bool sound = w->count == 0 || !pl_is_wrapped(&s->world);
    for (uint32_t i = 0; i < w->count && sound; ++i) {
        const pl_slot *slot = pl_registry_find(&s->world.registry, all[i].shape.entity);
        sound = slot != NULL && slot->kind == PLUMB_KIND_SHAPE &&
                (s->world.pieces.flags[slot->row] & PL_PIECE_WAVES) != 0 &&
                pl_waves_of(&s->world, all[i].shape) == &all[i] && all[i].first == at &&
                pl_waves_desc_is_sound(&all[i].desc);
        at += sound ? (uint32_t)all[i].desc.modes : 0;
    }
    sound = sound && at == w->mode_count;
    for (size_t i = 0; i < 2 * (size_t)w->mode_count && sound; ++i) {
        sound = modes[i] >= -PL_WAVES_MOST && modes[i] <= PL_WAVES_MOST;
    }
    return sound;
}

static bool check_breaks(const plumb_world *w)
{
    const pl_pending_break *all = w->fracture.pending.data;
    bool sound = true; // of bodies that are gone, or do not break any more, too
    for (uint32_t i = 0; i < w->fracture.pending_count && sound; ++i) {
        const pl_pending_break *b = &all[i];
        sound = plumb_abs(b->point.x) <= PL_LARGEST && plumb_abs(b->point.y) <= PL_LARGEST &&
                plumb_abs(b->normal.x) <= 2 && plumb_abs(b->normal.y) <= 2 && b->impulse >= 0 &&
                b->energy >= 0 && b->impulse - b->impulse == 0 && b->energy - b->energy == 0;
    }
    return sound;
}

static bool check_heat(const pl_suspect *s, const pl_heat *heat)
{
    plumb_body_desc desc = { 0 };
#define TAKE(name, initial) desc.name = (plumb_real)heat->name;
    PL_BODY_ROWS(PL_ROW_HEAT, TAKE)
#undef TAKE
    const double sum = heat->molten + heat->burnt + heat->grown;
    return pl_suspect_row(s, heat->body) != PL_NONE && pl_desc_is_sound(PLUMB_TABLE_BODY, &desc) &&
           sum - sum == 0 && heat->molten >= 0 && heat->molten <= (double)PL_MASS_MOST &&
           fabs(heat->burnt) <= (double)PL_MASS_MOST && fabs(heat->grown) <= PL_HEAT_MOST_GROWN;
}

static bool check_heats(const pl_suspect *s)
{
    const pl_heats *heats = &s->world.heats;
    const pl_heat *all = pl_heat_items(heats);
    bool sound = heats->state_count <= 1 && (heats->count == 0 || heats->state_count == 1);
    for (uint32_t i = 0; i < heats->count && sound; ++i) {
        sound = check_heat(s, &all[i]) &&
                (i == 0 || all[i - 1].body.entity.index < all[i].body.entity.index);
    }
    if (heats->state_count == 0 || !sound) {
        return sound;
    }
    const pl_heat_state *state = pl_heat_state_of(heats);
    const plumb_heat_sums *t = &state->sums;
    double sum = t->heating + t->burning + t->held + t->radiated + t->carried + t->melted +
                 t->gone + t->mechanical + t->content + t->burnt + t->owed;
    for (int k = 0; k <= PLUMB_LIQUID_MAX_PHASES; ++k) {
        sound &= state->owed[k] >= 0 && state->owed[k] <= (double)PL_MASS_MOST;
        sum += state->owed[k];
    }
    return sound && sum - sum == 0;
}

static bool check_excluded(const plumb_world *w)
{
    const uint64_t *keys = w->excluded.data;
    for (uint32_t i = 1; i < w->excluded_count; ++i) {
        if (keys[i - 1] >= keys[i]) {
            return false;
        }
    }
    return true;
}

bool pl_check_extras(pl_suspect *s)
{
    const plumb_world *w = &s->world;
    const pl_character *items = w->characters.items.data;
    for (uint32_t i = 0; i < w->characters.count; ++i) {
        if (!check_character(s, &items[i], i)) {
            return false;
        }
    }
    return check_records(w) && check_settings(s) && check_targets(s) && check_liquid(w) &&
           check_air(w) && check_softbodies(s) && check_laws(s) && check_waves(s) &&
           check_excluded(w) && check_breaks(w) && check_heats(s) &&
           pl_commands_are_sound(s->like, &w->registry, w->commands.bytes.data, w->commands.used,
                                 w->commands.count, s->marks);
}
