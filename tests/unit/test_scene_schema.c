// test_scene_schema.c - what follows from a row of the schema, asked of every row: its default, its range, that it is
// kept, saved, sent, recorded and replayed, and that scenes say it in Lua and in JSON.
//
// A table is a subject: how a thing is made of its descriptor, changed, and read. Whoever adds a table adds one.
#define _POSIX_C_SOURCE 200809L
#include "scene_fixture.h"

#include "harness/recording.h"
#include "scene/internal.h"

typedef struct subject {
    plumb_property_table table;
    // Makes the thing; changes it; reads it; where it is in a scene that made one.
    plumb_result (*make)(plumb_world *w, const void *desc, plumb_entity *thing);
    plumb_result (*set)(plumb_world *w, plumb_entity thing, const void *desc);
    void (*get)(const plumb_world *w, plumb_entity thing, void *desc);
    plumb_entity (*in_scene)(const scene *s);
    const char *script; // with %s where the word goes
} subject;

//---- subjects ------------------------------------------------------------------------------------

static plumb_result make_material(plumb_world *w, const void *desc, plumb_entity *thing)
{
    *thing = plumb_material_create(w, desc).entity;
    return plumb_entity_is_null(*thing) ? plumb_world_error(w).code : PLUMB_OK;
}

static plumb_result set_material(plumb_world *w, plumb_entity thing, const void *desc)
{
    return plumb_material_set(w, (plumb_material){ thing }, desc);
}

static void get_material(const plumb_world *w, plumb_entity thing, void *desc)
{
    assert_int_equal(plumb_material_get(w, (plumb_material){ thing }, desc), PLUMB_OK);
}

static plumb_entity scene_material(const scene *s)
{
    return s->materials.items[0]->handle.entity;
}

// Of a material with itself.
static plumb_result make_pair(plumb_world *w, const void *desc, plumb_entity *thing)
{
    *thing = plumb_material_create(w, &(plumb_material_desc){ 0 }).entity;
    return plumb_material_pair_set(w, (plumb_material){ *thing }, (plumb_material){ *thing }, desc);
}

static plumb_result set_pair(plumb_world *w, plumb_entity thing, const void *desc)
{
    return plumb_material_pair_set(w, (plumb_material){ thing }, (plumb_material){ thing }, desc);
}

static void get_pair(const plumb_world *w, plumb_entity thing, void *desc)
{
    assert_int_equal(
        plumb_material_pair_get(w, (plumb_material){ thing }, (plumb_material){ thing }, desc),
        PLUMB_OK);
}

static const subject subjects[] = {
    { PLUMB_TABLE_MATERIAL, make_material, set_material, get_material, scene_material,
      "body{ circle{1}, material = material{ %s } }" },
    { PLUMB_TABLE_MATERIAL_PAIR, make_pair, set_pair, get_pair, scene_material,
      "local m = material{} body{ circle{1}, material = m } material_pair{ m, m, friction = 1, %s "
      "}" },
};
_Static_assert(sizeof subjects / sizeof *subjects == PLUMB_TABLE_COUNT, "a subject a table");

typedef union descriptor {
    plumb_material_desc material;
    plumb_material_pair pair;
} descriptor;

//---- values --------------------------------------------------------------------------------------

// Some that the property can have, not the default; false past the last.
static bool value_of(const plumb_property *p, int i, double *value)
{
    const double low = p->low > -1e12 ? p->low : -1e12, high = p->high < 1e12 ? p->high : 1e12;
    const double some[] = { low, low + (high - low) / 2, high, low + (high < low + 1 ? 0.25 : 1) };
    *value = p->type == PLUMB_PROPERTY_CHOICE ? i : (double)(plumb_real)some[i < 4 ? i : 0];
    return p->type == PLUMB_PROPERTY_CHOICE ? i <= (int)high : i < 4;
}

static bool is_usable(const plumb_property *p, double value)
{
    return value != p->initial && !(p->above && value == p->low) &&
           !(value == 0 && p->zero == PLUMB_NO_MEMBER && p->initial != 0);
}

// The last one that is usable.
static double a_value(const plumb_property *p)
{
    double value, found = p->initial;
    for (int i = 0; value_of(p, i, &value); ++i) {
        found = is_usable(p, value) ? value : found;
    }
    assert_true(found != p->initial);
    return found;
}

static plumb_world *new_world(void)
{
    plumb_world *w = NULL;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    return w;
}

//---- what is asked of each row -------------------------------------------------------------------

static void default_and_round_trip(const subject *t, const plumb_property *p)
{
    const descriptor none = { 0 };
    assert_near(plumb_property_read(p, &none), p->initial, 0);
    double value;
    for (int i = 0; value_of(p, i, &value); ++i) {
        if (!is_usable(p, value)) {
            continue;
        }
        plumb_world *w = new_world();
        plumb_entity thing;
        descriptor desc = { 0 }, got = { 0 };
        plumb_property_write(p, &desc, value);
        assert_near(plumb_property_read(p, &desc), value, 0);
        assert_int_equal(t->make(w, &desc, &thing), PLUMB_OK);
        t->get(w, thing, &got);
        assert_near(plumb_property_read(p, &got), value, 0);
        assert_int_equal(t->set(w, thing, &none), PLUMB_OK);
        t->get(w, thing, &got);
        assert_near(plumb_property_read(p, &got), (plumb_real)p->initial, 0);
        assert_int_equal(t->set(w, thing, &desc), PLUMB_OK);
        t->get(w, thing, &got);
        assert_near(plumb_property_read(p, &got), value, 0);
        plumb_world_destroy(w);
    }
}

static void refused(const subject *t, const plumb_property *p, double value, plumb_result code)
{
    plumb_world *w = new_world();
    plumb_entity thing, kept;
    descriptor desc = { 0 }, none = { 0 };
    assert_int_equal(t->make(w, &none, &kept), PLUMB_OK);
    plumb_property_write(p, &desc, value);
    const uint64_t hash = plumb_world_hash(w);
    assert_int_equal(t->set(w, kept, &desc), code);
    assert_non_null(strstr(plumb_world_error(w).message, p->name));
    assert_true(plumb_world_hash(w) == hash);
    assert_int_equal(t->make(w, &desc, &thing), code);
    plumb_world_destroy(w);
}

static void range(const subject *t, const plumb_property *p)
{
    if (p->type == PLUMB_PROPERTY_CHOICE) {
        refused(t, p, p->high + 1, PLUMB_E_RANGE);
        refused(t, p, -1, PLUMB_E_RANGE);
        return;
    }
    refused(t, p, (double)NAN, PLUMB_E_NOT_FINITE);
    refused(t, p, (double)INFINITY, PLUMB_E_NOT_FINITE);
    refused(t, p, -(double)INFINITY, PLUMB_E_NOT_FINITE);
    if (p->low > -(double)INFINITY) {
        const plumb_real low = (plumb_real)p->low;
        const plumb_real next = sizeof low == sizeof(float)
                                    ? (plumb_real)nextafterf((float)low, -1e30f)
                                    : (plumb_real)nextafter((double)low, -1e30);
        refused(t, p, (double)next, PLUMB_E_RANGE);
    }
    if (p->high < (double)INFINITY) {
        const plumb_real high = (plumb_real)p->high;
        const plumb_real next = sizeof high == sizeof(float)
                                    ? (plumb_real)nextafterf((float)high, 1e30f)
                                    : (plumb_real)nextafter((double)high, 1e30);
        refused(t, p, (double)next, PLUMB_E_RANGE);
    }
}

// Into another world by an image, and by a delta.
static void saved_and_sent(const subject *t, const plumb_property *p)
{
    static char image[2][1 << 16], delta[1 << 16], built[1 << 16];
    plumb_world *w = new_world(), *other = new_world();
    plumb_entity thing;
    descriptor desc = { 0 }, none = { 0 }, got = { 0 };
    assert_int_equal(t->make(w, &none, &thing), PLUMB_OK);
    const uint64_t before = plumb_world_hash(w);
    const size_t size = plumb_world_snapshot_size(w);
    assert_true(size <= sizeof image[0]);
    assert_int_equal(plumb_world_save(w, image[0], size), PLUMB_OK);
    plumb_property_write(p, &desc, a_value(p));
    assert_int_equal(t->set(w, thing, &desc), PLUMB_OK);
    assert_true(plumb_world_hash(w) != before);
    assert_int_equal(plumb_world_save(w, image[1], size), PLUMB_OK);
    size_t bytes, rebuilt;
    assert_int_equal(
        plumb_snapshot_delta(image[0], size, image[1], size, delta, sizeof delta, &bytes),
        PLUMB_OK);
    assert_int_equal(
        plumb_snapshot_apply(image[0], size, delta, bytes, built, sizeof built, &rebuilt),
        PLUMB_OK);
    assert_int_equal(plumb_world_restore(other, built, rebuilt), PLUMB_OK);
    t->get(other, thing, &got);
    assert_near(plumb_property_read(p, &got), a_value(p), 0);
    assert_true(plumb_world_hash(other) == plumb_world_hash(w));
    plumb_world_destroy(w);
    plumb_world_destroy(other);
}

static void recorded(const subject *t, const plumb_property *p)
{
    plumb_world *w = new_world();
    plumb_entity thing;
    recording tape = { 0 };
    descriptor desc = { 0 }, none = { 0 }, got = { 0 };
    assert_int_equal(t->make(w, &none, &thing), PLUMB_OK);
    const plumb_recorder_desc to = { .write = to_recording, .context = &tape };
    assert_int_equal(plumb_recorder_start(w, &to), PLUMB_OK);
    assert_int_equal(plumb_world_step(w, (plumb_real)(1.0 / 60)), PLUMB_OK);
    plumb_property_write(p, &desc, a_value(p));
    assert_int_equal(t->set(w, thing, &desc), PLUMB_OK);
    assert_int_equal(plumb_world_step(w, (plumb_real)(1.0 / 60)), PLUMB_OK);
    assert_int_equal(plumb_recorder_stop(w), PLUMB_OK);
    plumb_replay *replay;
    const plumb_replay_desc list = { .list_edits = true };
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, &list, &replay), PLUMB_OK);
    t->get(plumb_replay_world(replay), thing, &got);
    assert_near(plumb_property_read(p, &got), (plumb_real)p->initial, 0);
    assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
    assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
    t->get(plumb_replay_world(replay), thing, &got);
    assert_near(plumb_property_read(p, &got), a_value(p), 0);
    plumb_replay_edit edits[8];
    assert_true(plumb_replay_edits(replay, edits, 8) > 0);
    plumb_replay_close(replay);
    plumb_world_destroy(w);
    recording_free(&tape);
}

//---- words ---------------------------------------------------------------------------------------

// `word = value`, as Lua has it.
static void say(char *to, size_t size, const plumb_property *p, double value)
{
    const char *choice = p->unit;
    if (p->type != PLUMB_PROPERTY_CHOICE) {
        snprintf(to, size, "%s = %.17g", p->word, value);
        return;
    }
    for (int i = 0; i < (int)value; ++i) {
        choice = strchr(choice, '|') + 1;
    }
    snprintf(to, size, "%s = '%.*s'", p->word, (int)strcspn(choice, "|"), choice);
}

static void check_scene(const subject *t, const plumb_property *p, scene *s, double value)
{
    descriptor got = { 0 };
    t->get(s->world, t->in_scene(s), &got);
    assert_near(plumb_property_read(p, &got), value, 0);
}

static void words(const subject *t, const plumb_property *p)
{
    char word[128], text[256];
    double value;
    for (int i = 0; t->script != NULL && p->word[0] != '\0' && value_of(p, i, &value); ++i) {
        if (!is_usable(p, value)) {
            continue;
        }
        say(word, sizeof word, p, value);
        snprintf(text, sizeof text, t->script, word);
        scene *s = load(text);
        check_scene(t, p, s, value);
        size_t size;
        char *json = export_json(s, &size);
        assert_non_null(strstr(json, p->word));
        scene *copy = load_as("test.json", json, size, NULL);
        check_scene(t, p, copy, value);
        scene_destroy(copy);
        scene_destroy(s);
        free(json);
    }
}

static void refused_words(const subject *t, const plumb_property *p)
{
    char word[128], text[256];
    scene *s = NULL;
    scene_error e;
    if (t->script == NULL || p->word[0] == '\0' || p->low == -(double)INFINITY) {
        return;
    }
    if (p->type == PLUMB_PROPERTY_CHOICE) {
        snprintf(word, sizeof word, "%s = 'nothing'", p->word);
    } else {
        snprintf(word, sizeof word, "%s = %.17g", p->word, p->above ? p->low : p->low - 1);
    }
    snprintf(text, sizeof text, t->script, word);
    assert_int_equal(
        scene_load(&(scene_options){ .path = "test.lua", .text = text, .text_size = strlen(text) },
                   &s, &e),
        SCENE_E_RANGE);
    assert_non_null(strstr(e.text, p->word));
}

//---- the rows ------------------------------------------------------------------------------------

static void each_row(void (*ask)(const subject *t, const plumb_property *p))
{
    for (size_t i = 0; i < sizeof subjects / sizeof *subjects; ++i) {
        int count;
        const plumb_property *rows = plumb_properties(subjects[i].table, &count);
        assert_true(count > 0);
        for (int k = 0; k < count; ++k) {
            ask(&subjects[i], &rows[k]);
        }
    }
}

#define EACH_ROW(ask)                                                                              \
    static void each_row_##ask(void **state)                                                       \
    {                                                                                              \
        (void)state;                                                                               \
        each_row(ask);                                                                             \
    }
EACH_ROW(default_and_round_trip)
EACH_ROW(range)
EACH_ROW(saved_and_sent)
EACH_ROW(recorded)
EACH_ROW(words)
EACH_ROW(refused_words)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_row_default_and_round_trip),
        cmocka_unit_test(each_row_range),
        cmocka_unit_test(each_row_saved_and_sent),
        cmocka_unit_test(each_row_recorded),
        cmocka_unit_test(each_row_words),
        cmocka_unit_test(each_row_refused_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
