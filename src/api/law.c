// law.c - laws: made, changed, asked; how what flies in them is moved.
//
// Reads: arguments, checked first. Writes: the list of laws. Cost: O(laws); what sleeps where they act wakes: O(bodies).
#include "plumb/law.h"

#include "effects/laws.h"
#include "world/check.h"
#include "world/desc_list.h"
#include "world/destroy.h"
#include "world/law_list.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <string.h>

#define FAR            ((real)1e9)
#define STRONGEST      ((real)1e30)
#define TOLERANCE_MOST ((real)0.01)

//---- checks --------------------------------------------------------------------------------------

typedef struct choice {
    const char *name;
    int value, last;
} choice;

// A number of the descriptor, and between what it lies.
typedef struct number {
    const char *name;
    real value, low, high;
} number;

enum { CHOICES = 4, NUMBERS = 9 };

static void list_choices(const pl_law_data *d, choice out[CHOICES])
{
    out[0] = (choice){ "kind", (int)d->kind, PLUMB_LAW_FORMULA };
    out[1] = (choice){ "hold", (int)d->hold, PLUMB_LAW_ON_CHARGE };
    out[2] = (choice){ "falloff", (int)d->falloff, PLUMB_FALLOFF_SPRING };
    out[3] = (choice){ "combine", (int)d->combine, PLUMB_LAW_REPLACE };
}

static void list_numbers(const pl_law_data *d, number out[NUMBERS])
{
    out[0] = (number){ "position.x", d->position.x, -FAR, FAR };
    out[1] = (number){ "position.y", d->position.y, -FAR, FAR };
    out[2] = (number){ "angle", d->angle, -FAR, FAR };
    out[3] = (number){ "vector.x", d->vector.x, -STRONGEST, STRONGEST };
    out[4] = (number){ "vector.y", d->vector.y, -STRONGEST, STRONGEST };
    out[5] = (number){ "strength", d->strength, -STRONGEST, STRONGEST };
    out[6] = (number){ "softening", d->softening, 0, FAR };
    out[7] = (number){ "radius", d->radius, 0, FAR };
    out[8] = (number){ "half", d->half.x < d->half.y ? d->half.x : d->half.y, 0, FAR };
}

// What is not a number is found in either half.
static bool is_half_sound(plumb_vec2 half)
{
    return half.x >= 0 && half.x <= FAR && half.y >= 0 && half.y <= FAR &&
           (half.x > 0) == (half.y > 0);
}

// Members that do not go together; NULL: they do.
static const char *discord(const pl_law_data *d)
{
    const bool zone = d->kind != PLUMB_LAW_ATTRACTOR && d->kind != PLUMB_LAW_MUTUAL;
    const bool replaces = d->combine == PLUMB_LAW_REPLACE;
    return !zone && d->half.x > 0
               ? "half is set; only uniform and magnetic laws and formulas have a box"
           : d->half.x > 0 && d->radius > 0 ? "radius is set with half; a zone is a circle or a box"
           : d->kind == PLUMB_LAW_MUTUAL && !plumb_is_null(d->body)
               ? "body is set; a mutual law has none"
           : replaces && (d->kind == PLUMB_LAW_MAGNETIC || d->kind == PLUMB_LAW_MUTUAL)
               ? "combine is replace; only uniform laws, attractors and formulas do"
               : NULL;
}

bool pl_law_desc_is_sound(const pl_law_data *d)
{
    choice choices[CHOICES];
    number numbers[NUMBERS];
    bool sound = is_half_sound(d->half) && discord(d) == NULL &&
                 d->priority >= -PLUMB_LAW_PRIORITY_MOST && d->priority <= PLUMB_LAW_PRIORITY_MOST;
    list_choices(d, choices);
    list_numbers(d, numbers);
    for (int i = 0; i < CHOICES; ++i) {
        sound &= choices[i].value >= 0 && choices[i].value <= choices[i].last;
    }
    for (int i = 0; i < NUMBERS; ++i) {
        sound &= numbers[i].value >= numbers[i].low && numbers[i].value <= numbers[i].high;
    }
    return sound;
}

static plumb_result check_numbers(const plumb_world *world, const char *fn, const pl_law_data *d)
{
    number numbers[NUMBERS];
    list_numbers(d, numbers);
    for (int i = 0; i < NUMBERS - 1; ++i) {
        const number *n = &numbers[i];
        PL_TRY(pl_check_range(world, fn, n->name, n->value, n->low, n->high));
    }
    PL_TRY(pl_check_range(world, fn, "half.x", d->half.x, 0, FAR));
    PL_TRY(pl_check_range(world, fn, "half.y", d->half.y, 0, FAR));
    if ((d->half.x > 0) != (d->half.y > 0)) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "half is (%g, %g); both must be above 0, or none",
                       (double)d->half.x, (double)d->half.y);
    }
    return PLUMB_OK;
}

static plumb_result check_data(const plumb_world *world, const char *fn, const pl_law_data *d)
{
    choice choices[CHOICES];
    list_choices(d, choices);
    for (int i = 0; i < CHOICES; ++i) {
        if (choices[i].value < 0 || choices[i].value > choices[i].last) {
            return pl_fail(world, PLUMB_E_RANGE, fn, "%s is %d; it must be 0 to %d",
                           choices[i].name, choices[i].value, choices[i].last);
        }
    }
    if (d->priority < -PLUMB_LAW_PRIORITY_MOST || d->priority > PLUMB_LAW_PRIORITY_MOST) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "priority is %d; it must be %d to %d", d->priority,
                       -PLUMB_LAW_PRIORITY_MOST, PLUMB_LAW_PRIORITY_MOST);
    }
    PL_TRY(check_numbers(world, fn, d));
    return discord(d) == NULL ? PLUMB_OK : pl_fail(world, PLUMB_E_RANGE, fn, "%s", discord(d));
}

//---- formulas ------------------------------------------------------------------------------------

// Texts that do not go together; NULL: they do.
static const char *text_discord(const plumb_law_desc *d)
{
    const bool any = d->formula_x != NULL || d->formula_y != NULL || d->potential != NULL;
    return d->kind != PLUMB_LAW_FORMULA
               ? (any ? "a formula is set; only laws of the kind formula have one" : NULL)
           : !any ? "a formula needs formula_x, formula_y or potential"
           : d->potential != NULL && (d->formula_x != NULL || d->formula_y != NULL)
               ? "potential is set with components; a formula has either"
               : NULL;
}

// The program of a descriptor, with copies of its texts.
static plumb_result check_formula(const plumb_world *world, const char *fn, const plumb_law_desc *d,
                                  pl_law_formula *out)
{
    const bool is_potential = d->potential != NULL;
    const char *const texts[] = { is_potential ? d->potential : d->formula_x, d->formula_y };
    pl_formula_fault fault;
    if (text_discord(d) != NULL) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "%s", text_discord(d));
    }
    if (d->kind != PLUMB_LAW_FORMULA) {
        return PLUMB_OK;
    }
    PL_TRY(PL_CHECK_HAS(world, fn, "a formula", FORMULAS, "formulas"));
    if (!pl_formula_compile(texts, is_potential, &out->program, &fault)) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "%s: %s",
                       is_potential      ? "potential"
                       : fault.text == 0 ? "formula_x"
                                         : "formula_y",
                       fault.says);
    }
    out->is_potential = is_potential;
    memset(out->texts, 0, sizeof out->texts); // behind their ends, too: they are saved
    for (int i = 0; i < 2; ++i) {
        if (texts[i] != NULL) {
            memcpy(out->texts[i], texts[i], strlen(texts[i]));
        }
    }
    return PLUMB_OK;
}

// Its texts make its program, and no other bits.
bool pl_law_formula_is_sound(const pl_law_formula *formula)
{
    const bool is_potential = formula->is_potential != 0;
    const char *texts[2];
    bool sound = formula->is_potential <= 1;
    pl_formula made;
    pl_formula_fault fault;
    for (int i = 0; i < 2; ++i) {
        const char *text = formula->texts[i];
        const char *end = memchr(text, 0, PL_FORMULA_TEXT);
        for (const char *p = end; p != NULL && p < text + PL_FORMULA_TEXT && sound; ++p) {
            sound = *p == 0;
        }
        sound = sound && end != NULL;
        texts[i] = end == text ? NULL : text;
    }
    return sound &&
           (is_potential ? texts[0] != NULL && texts[1] == NULL
                         : texts[0] != NULL || texts[1] != NULL) &&
           pl_formula_compile(texts, is_potential, &made, &fault) &&
           memcmp(&made, &formula->program, sizeof made) == 0;
}

static void give_texts(const pl_law_formula *formula, plumb_law_desc *to)
{
    const bool is_potential = formula->is_potential != 0;
    const char *first = formula->texts[0][0] != 0 ? formula->texts[0] : NULL;
    to->formula_x = is_potential ? NULL : first;
    to->formula_y = formula->texts[1][0] != 0 ? formula->texts[1] : NULL;
    to->potential = is_potential ? first : NULL;
}

//---- laws ----------------------------------------------------------------------------------------

static pl_law_data data_of(const plumb_law_desc *from)
{
    pl_law_data data, *to = &data;
    memset(to, 0, sizeof *to);
    PL_LAW_DESC(PL_COPY_MEMBER)
    return data;
}

// What a law is to be, checked.
static plumb_result check_desc(const plumb_world *world, const char *fn, const plumb_law_desc *d,
                               pl_law_formula *formula)
{
    PL_TRY(PL_CHECK_HAS(world, fn, "a law", LAWS, "laws"));
    const pl_law_data data = data_of(d);
    PL_TRY(check_data(world, fn, &data));
    PL_TRY(check_formula(world, fn, d, formula));
    if (pl_is_wrapped(world)) {
        return pl_fail(world, PLUMB_E_STATE, fn, "the world wraps around; one with laws must not");
    }
    uint32_t row;
    return plumb_is_null(d->body) ? PLUMB_OK : pl_check_body(world, fn, d->body, &row);
}

static plumb_result check_law(const plumb_world *world, const char *fn, plumb_law law,
                              uint32_t *row)
{
    PL_TRY(pl_check_world(world));
    *row = pl_law_find(world, law);
    return *row != PL_NONE ? PLUMB_OK
                           : pl_fail(world, PLUMB_E_HANDLE, fn,
                                     "law %u:%u does not exist; it was destroyed or never made",
                                     (unsigned)law.entity.index, (unsigned)law.entity.generation);
}

static bool is_same(const pl_law_data *a, const pl_law_data *b)
{
    return true PL_LAW_DESC(PL_SAME_MEMBER);
}

static bool is_same_formula(const pl_law_formula *a, const pl_law_formula *b)
{
    return memcmp(a->texts, b->texts, sizeof a->texts) == 0 && a->is_potential == b->is_potential;
}

static bool reserve_formulas(plumb_world *world, uint32_t more)
{
    pl_laws *laws = &world->laws;
    return pl_buffer_reserve(&world->memory, &laws->formulas,
                             (laws->formula_count + more) * sizeof(pl_law_formula));
}

plumb_law plumb_law_create(plumb_world *world, const plumb_law_desc *desc)
{
    plumb_law law = PLUMB_NULL_INIT;
    pl_law_formula formula;
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        pl_check_pointer(world, __func__, "desc", desc) != PLUMB_OK ||
        check_desc(world, __func__, desc, &formula) != PLUMB_OK) {
        return law;
    }
    const bool has_formula = desc->kind == PLUMB_LAW_FORMULA;
    const pl_law_data data = data_of(desc); // the texts may be ours, and move
    pl_laws *laws = &world->laws;
    if (!pl_registry_reserve(&world->memory, &world->registry, 1) ||
        !pl_buffer_reserve(&world->memory, &laws->items, (laws->count + 1) * sizeof(pl_law)) ||
        !reserve_formulas(world, has_formula)) {
        pl_fail_memory(world, __func__);
        return law;
    }
    const uint32_t row = laws->count++;
    pl_law *item = &pl_law_items(laws)[row];
    memset(item, 0, sizeof *item); // padding, too: it is saved
    law.entity = pl_entity_claim(world, law.entity, PLUMB_KIND_LAW, row);
    item->entity = law;
    pl_law_become(world, row, &data, has_formula ? &formula : NULL);
    pl_law_disturb(world, &data);
    return law;
}

plumb_result plumb_law_destroy(plumb_world *world, plumb_law law)
{
    uint32_t row;
    PL_TRY(check_law(world, __func__, law, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_destroy_entity(world, law.entity);
    return PLUMB_OK;
}

plumb_result plumb_law_settings(const plumb_world *world, plumb_law law, plumb_law_desc *desc)
{
    uint32_t row;
    PL_TRY(check_law(world, __func__, law, &row));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    const pl_law *item = &pl_law_items(&world->laws)[row];
    const pl_law_data *from = &item->desc;
    plumb_law_desc *to = desc;
    *to = (plumb_law_desc){ 0 };
    PL_LAW_DESC(PL_COPY_MEMBER)
    if (item->formula > 0) {
        give_texts(pl_law_formula_of(&world->laws, item), to);
    }
    return PLUMB_OK;
}

plumb_result plumb_law_set(plumb_world *world, plumb_law law, const plumb_law_desc *desc)
{
    uint32_t row;
    PL_TRY(check_law(world, __func__, law, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    pl_law_formula formula;
    PL_TRY(check_desc(world, __func__, desc, &formula));
    pl_law *item = &pl_law_items(&world->laws)[row];
    const bool has_formula = desc->kind == PLUMB_LAW_FORMULA;
    const pl_law_formula *before = pl_law_formula_of(&world->laws, item);
    const pl_law_data data = data_of(desc);
    if (is_same(&item->desc, &data) && (!has_formula || is_same_formula(before, &formula))) {
        return PLUMB_OK; // nothing wakes
    }
    if (!reserve_formulas(world, has_formula && before == NULL)) {
        return pl_fail_memory(world, __func__);
    }
    pl_law_disturb(world, &item->desc);
    pl_law_become(world, row, &data, has_formula ? &formula : NULL);
    item->placed = false;
    item->x = item->y = 0;
    pl_law_disturb(world, &data);
    return PLUMB_OK;
}

int plumb_world_laws(const plumb_world *world, plumb_law *laws, int capacity)
{
    const int count = world == NULL ? 0 : (int)world->laws.count;
    for (int i = 0; i < count && i < capacity && laws != NULL; ++i) {
        laws[i] = pl_law_items(&world->laws)[i].entity;
    }
    return count;
}

plumb_vec2 plumb_world_law_at(const plumb_world *world, plumb_vec2 position, plumb_vec2 velocity,
                              plumb_real charge_per_mass)
{
    if (world == NULL || pl_check_finite_vec(world, __func__, "position", position) != PLUMB_OK ||
        pl_check_finite_vec(world, __func__, "velocity", velocity) != PLUMB_OK ||
        pl_check_finite(world, __func__, "charge_per_mass", charge_per_mass) != PLUMB_OK) {
        return plumb_v2(0, 0);
    }
    const pl_law_state at = { (double)position.x, (double)position.y, (double)velocity.x,
                              (double)velocity.y };
    double a[2];
    pl_laws_probe(world, &at, (double)charge_per_mass, a);
    return plumb_v2((real)a[0], (real)a[1]);
}

//---- orbits --------------------------------------------------------------------------------------

bool pl_orbit_desc_is_sound(const plumb_orbit_desc *d)
{
    return (d->order == 0 || d->order == 2 || d->order == 4) && d->tolerance >= 0 &&
           d->tolerance <= TOLERANCE_MOST;
}

plumb_result plumb_world_set_orbits(plumb_world *world, const plumb_orbit_desc *desc)
{
    const plumb_orbit_desc zero = { 0 };
    desc = desc == NULL ? &zero : desc;
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(PL_CHECK_HAS(world, __func__, "orbits", LAWS, "laws"));
    if (desc->order != 0 && desc->order != 2 && desc->order != 4) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "order is %d; it must be 2 or 4, 0 means 2",
                       desc->order);
    }
    PL_TRY(pl_check_range(world, __func__, "tolerance", desc->tolerance, 0, TOLERANCE_MOST));
    pl_laws *laws = &world->laws;
    if (!pl_buffer_reserve(&world->memory, &laws->orbits, sizeof *desc)) {
        return pl_fail_memory(world, __func__);
    }
    plumb_orbit_desc *to = laws->orbits.data;
    memset(to, 0, sizeof *to); // padding, too: it is saved
    to->order = desc->order;
    to->tolerance = desc->tolerance;
    laws->orbit_count = desc->order != 0 || desc->tolerance != 0;
    return PLUMB_OK;
}

plumb_result plumb_world_orbits(const plumb_world *world, plumb_orbit_desc *desc)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    *desc = pl_orbits_of(world);
    return PLUMB_OK;
}
