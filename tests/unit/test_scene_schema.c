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
    // Makes the thing, or a world in place of *w; changes it, NULL: there is no such function; reads it; where it is in a scene that made one.
    plumb_result (*make)(plumb_world **w, const void *desc, plumb_entity *thing);
    plumb_result (*set)(plumb_world *w, plumb_entity thing, const void *desc);
    void (*get)(const plumb_world *w, plumb_entity thing, void *desc);
    plumb_entity (*in_scene)(const scene *s);
    const char *script; // with %s where the word goes
} subject;

//---- subjects ------------------------------------------------------------------------------------

static plumb_result make_material(plumb_world **w, const void *desc, plumb_entity *thing)
{
    *thing = plumb_material_create(*w, desc).entity;
    return plumb_entity_is_null(*thing) ? plumb_world_error(*w).code : PLUMB_OK;
}

static plumb_result set_material(plumb_world *w, plumb_entity thing, const void *desc)
{
    return plumb_material_set(w, (plumb_material){ thing }, desc);
}

static void get_material(const plumb_world *w, plumb_entity thing, void *desc)
{
    assert_int_equal(plumb_material_settings(w, (plumb_material){ thing }, desc), PLUMB_OK);
}

static plumb_entity made_material(const scene *s)
{
    return s->materials.items[0]->handle.entity;
}

// Of a material with itself.
static plumb_result make_pair(plumb_world **w, const void *desc, plumb_entity *thing)
{
    *thing = plumb_material_create(*w, &(plumb_material_desc){ 0 }).entity;
    return plumb_material_pair_set(*w, (plumb_material){ *thing }, (plumb_material){ *thing },
                                   desc);
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

static plumb_result make_body(plumb_world **w, const void *desc, plumb_entity *thing)
{
    *thing = plumb_body_create(*w, desc).entity;
    return plumb_entity_is_null(*thing) ? plumb_world_error(*w).code : PLUMB_OK;
}

static void get_body(const plumb_world *w, plumb_entity thing, void *desc)
{
    assert_int_equal(plumb_body_settings(w, (plumb_body){ thing }, desc), PLUMB_OK);
}

static plumb_entity made_body(const scene *s)
{
    return s->bodies.items[0]->entity.entity;
}

static char world_said[512]; // why a world was not made

static void keep_message(void *context, plumb_log_level level, const char *message)
{
    (void)context;
    (void)level;
    snprintf(world_said, sizeof world_said, "%s", message);
}

static plumb_result make_world(plumb_world **w, const void *desc, plumb_entity *thing)
{
    plumb_world_desc own = *(const plumb_world_desc *)desc;
    plumb_world *made;
    own.log = keep_message;
    *thing = (plumb_entity)PLUMB_NULL_ENTITY_INIT;
    plumb_result result = plumb_world_create(&own, &made);
    if (result == PLUMB_OK) {
        plumb_world_destroy(*w);
        *w = made;
    }
    return result;
}

static void get_world(const plumb_world *w, plumb_entity thing, void *desc)
{
    (void)thing;
    *(plumb_world_desc *)desc = plumb_world_settings(w);
}

// A hinge of a body on the world.
static plumb_result make_joint(plumb_world **w, const void *desc, plumb_entity *thing)
{
    plumb_joint_desc own = *(const plumb_joint_desc *)desc;
    const plumb_body_span bodies = plumb_world_bodies(*w);
    own.body_b = bodies.count > 0 ? bodies.body[0] : plumb_body_create(*w, &(plumb_body_desc){ 0 });
    *thing = plumb_joint_create(*w, &own).entity;
    return plumb_entity_is_null(*thing) ? plumb_world_error(*w).code : PLUMB_OK;
}

static void get_joint(const plumb_world *w, plumb_entity thing, void *desc)
{
    assert_int_equal(plumb_joint_settings(w, (plumb_joint){ thing }, desc), PLUMB_OK);
}

static plumb_entity made_joint(const scene *s)
{
    return s->joints.items[0]->entity.entity;
}

static const subject subjects[] = {
    { PLUMB_TABLE_WORLD, make_world, NULL, get_world, NULL, "scene{ %s } body{ circle{0.01} }" },
    { PLUMB_TABLE_JOINT, make_joint, NULL, get_joint, made_joint,
      "revolute{ body{ circle{1} }, at = {0, 0}, %s }" },
    { PLUMB_TABLE_BODY, make_body, NULL, get_body, made_body, "body{ circle{1}, %s }" },
    { PLUMB_TABLE_MATERIAL, make_material, set_material, get_material, made_material,
      "body{ circle{1}, material = material{ %s } }" },
    { PLUMB_TABLE_MATERIAL_PAIR, make_pair, set_pair, get_pair, made_material,
      "local m = material{} body{ circle{1}, material = m } material_pair{ m, m, friction = 1, %s "
      "}" },
};
_Static_assert(sizeof subjects / sizeof *subjects == PLUMB_TABLE_COUNT, "a subject a table");

typedef union descriptor {
    plumb_world_desc world;
    plumb_joint_desc joint;
    plumb_body_desc body;
    plumb_material_desc material;
    plumb_material_pair pair;
} descriptor;

//---- values --------------------------------------------------------------------------------------

static bool is_number(const plumb_property *p)
{
    return p->type == PLUMB_PROPERTY_REAL || p->type == PLUMB_PROPERTY_VEC2 ||
           p->type == PLUMB_PROPERTY_INT;
}

// What a hinge has, and says alone; other members of joints are of other kinds, or go by two.
static bool is_asked(const subject *t, const plumb_property *p)
{
    static const char *const others[] = { "kind",     "anchor_b", "ground_a",  "ground_b",
                                          "axis",     "lower",    "upper",     "length",
                                          "ratio",    "pitch",    "max_force", "max_torque",
                                          "radius_a", "radius_b" };
    bool asked = true;
    for (size_t i = 0; t->table == PLUMB_TABLE_JOINT && i < sizeof others / sizeof *others; ++i) {
        asked = asked && strcmp(p->name, others[i]) != 0;
    }
    return asked;
}

// Some that the property can have; false past the last.
static bool value_of(const plumb_property *p, int i, double *value)
{
    const double low = p->low > -1e12 ? p->low : -1e12, high = p->high < 1e12 ? p->high : 1e12;
    const double some[] = { low, low + (high - low) / (p->type == PLUMB_PROPERTY_INT ? 4 : 2), high,
                            low + (high < low + 1 ? 0.25 : 1) };
    *value = is_number(p) ? (double)(plumb_real)some[i < 4 ? i : 0] : i;
    *value = p->type == PLUMB_PROPERTY_INT ? floor(*value) : *value;
    return is_number(p) ? i < 4 : i <= (int)high;
}

// Not the default, and one that a descriptor can say.
static bool is_usable(const plumb_property *p, double value)
{
    const bool is_width = strcmp(p->name, "simd_width") == 0; // 8 and 16 want a machine for them
    return value != p->initial && !(p->above && value == p->low) && (!is_width || value == 4) &&
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

static void put(const plumb_property *p, void *desc, double value)
{
    plumb_property_write(p, desc, 0, value);
    if (p->type == PLUMB_PROPERTY_VEC2) {
        plumb_property_write(p, desc, 1, value);
    }
}

// An angle is kept as a rotation.
static void check_value(const plumb_property *p, const void *desc, double value)
{
    if (strcmp(p->name, "angle") == 0) {
        assert_near(remainder(plumb_property_read(p, desc, 0) - value, 6.283185307179586), 0,
                    1e-6 + fabs(value) * 1e-6);
        return;
    }
    assert_near(plumb_property_read(p, desc, 0), value, 0);
    if (p->type == PLUMB_PROPERTY_VEC2) {
        assert_near(plumb_property_read(p, desc, 1), value, 0);
    }
}

// Without gravity: a bound of a joint that is reached breaks it.
static plumb_world *new_world(void)
{
    plumb_world *w = NULL;
    const plumb_world_desc desc = { .zero_gravity = true };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

//---- what is asked of each row -------------------------------------------------------------------

static void default_and_round_trip(const subject *t, const plumb_property *p)
{
    const descriptor none = { 0 };
    check_value(p, &none, p->initial);
    double value;
    for (int i = 0; is_asked(t, p) && value_of(p, i, &value); ++i) {
        if (!is_usable(p, value)) {
            continue;
        }
        plumb_world *w = new_world();
        plumb_entity thing;
        descriptor desc = { 0 }, got = { 0 };
        put(p, &desc, value);
        assert_near(plumb_property_read(p, &desc, 0), value, 0);
        assert_int_equal(t->make(&w, &desc, &thing), PLUMB_OK);
        t->get(w, thing, &got);
        check_value(p, &got, value);
        if (t->set != NULL) {
            assert_int_equal(t->set(w, thing, &none), PLUMB_OK);
            t->get(w, thing, &got);
            check_value(p, &got, (double)(plumb_real)p->initial);
            assert_int_equal(t->set(w, thing, &desc), PLUMB_OK);
            t->get(w, thing, &got);
            check_value(p, &got, value);
        }
        plumb_world_destroy(w);
    }
}

static void refused(const subject *t, const plumb_property *p, double value, plumb_result code)
{
    plumb_world *w = new_world();
    plumb_entity thing, kept;
    descriptor desc = { 0 }, none = { 0 };
    assert_int_equal(t->make(&w, &none, &kept), PLUMB_OK);
    put(p, &desc, value);
    const uint64_t hash = plumb_world_hash(w);
    assert_int_equal(t->set != NULL ? t->set(w, kept, &desc) : t->make(&w, &desc, &thing), code);
    assert_non_null(
        strstr(t->table == PLUMB_TABLE_WORLD ? world_said : plumb_world_error(w).message, p->name));
    assert_true(plumb_world_hash(w) == hash);
    assert_int_equal(t->make(&w, &desc, &thing), code);
    plumb_world_destroy(w);
}

static void range(const subject *t, const plumb_property *p)
{
    if (!is_number(p) || p->type == PLUMB_PROPERTY_INT) {
        if (p->type != PLUMB_PROPERTY_BOOL) {
            refused(t, p, p->high + 1, PLUMB_E_RANGE);
            refused(t, p, -1, PLUMB_E_RANGE);
        }
        return;
    }
    refused(t, p, (double)NAN, PLUMB_E_NOT_FINITE);
    refused(t, p, (double)INFINITY, PLUMB_E_NOT_FINITE);
    refused(t, p, -(double)INFINITY, PLUMB_E_NOT_FINITE);
    if (p->low > -(double)INFINITY) {
        const plumb_real low = (plumb_real)p->low;
        const plumb_real next = sizeof low == sizeof(float)
                                    ? (plumb_real)nextafterf((float)low, -HUGE_VALF)
                                    : (plumb_real)nextafter((double)low, -HUGE_VAL);
        refused(t, p, (double)next, PLUMB_E_RANGE);
    }
    if (p->high < (double)INFINITY) {
        const plumb_real high = (plumb_real)p->high;
        const plumb_real next = sizeof high == sizeof(float)
                                    ? (plumb_real)nextafterf((float)high, HUGE_VALF)
                                    : (plumb_real)nextafter((double)high, HUGE_VAL);
        refused(t, p, (double)next, PLUMB_E_RANGE);
    }
}

// Into another world by an image and a delta.
static void saved_and_sent(const subject *t, const plumb_property *p)
{
    static char image[2][1 << 16], delta[1 << 16], built[1 << 16];
    if (!is_asked(t, p) || !p->saved) {
        return;
    }
    plumb_world *w[2] = { new_world(), new_world() }, *other = new_world();
    plumb_entity thing;
    descriptor desc[2] = { 0 }, got = { 0 };
    size_t size[2], bytes, rebuilt;
    put(p, &desc[1], a_value(p));
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(t->make(&w[i], &desc[i], &thing), PLUMB_OK);
        size[i] = plumb_world_snapshot_size(w[i]);
        assert_true(size[i] <= sizeof image[i]);
        assert_int_equal(plumb_world_save(w[i], image[i], size[i]), PLUMB_OK);
    }
    assert_true(plumb_world_hash(w[0]) != plumb_world_hash(w[1]));
    assert_int_equal(
        plumb_snapshot_delta(image[0], size[0], image[1], size[1], delta, sizeof delta, &bytes),
        PLUMB_OK);
    assert_int_equal(
        plumb_snapshot_apply(image[0], size[0], delta, bytes, built, sizeof built, &rebuilt),
        PLUMB_OK);
    assert_int_equal(plumb_world_restore(other, built, rebuilt), PLUMB_OK);
    t->get(other, thing, &got);
    check_value(p, &got, a_value(p));
    assert_true(plumb_world_hash(other) == plumb_world_hash(w[1]));
    plumb_world_destroy(w[0]);
    plumb_world_destroy(w[1]);
    plumb_world_destroy(other);
}

// As an edit between two steps; of a world, in the head.
static void recorded(const subject *t, const plumb_property *p)
{
    if (!is_asked(t, p) || !p->saved) {
        return;
    }
    plumb_world *w = new_world();
    plumb_entity thing = PLUMB_NULL_ENTITY_INIT;
    recording tape = { 0 };
    descriptor desc = { 0 }, none = { 0 }, got = { 0 };
    const bool is_head = t->table == PLUMB_TABLE_WORLD;
    put(p, &desc, a_value(p));
    if (is_head || t->set != NULL) {
        assert_int_equal(t->make(&w, is_head ? &desc : &none, &thing), PLUMB_OK);
    }
    const plumb_recorder_desc to = { .write = to_recording, .context = &tape };
    assert_int_equal(plumb_recorder_start(w, &to), PLUMB_OK);
    assert_int_equal(plumb_world_step(w, (plumb_real)(1.0 / 60)), PLUMB_OK);
    if (!is_head) {
        assert_int_equal(t->set != NULL ? t->set(w, thing, &desc) : t->make(&w, &desc, &thing),
                         PLUMB_OK);
    }
    assert_int_equal(plumb_world_step(w, (plumb_real)(1.0 / 60)), PLUMB_OK);
    assert_int_equal(plumb_recorder_stop(w), PLUMB_OK);
    plumb_replay *replay;
    const plumb_replay_desc list = { .list_edits = true };
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, &list, &replay), PLUMB_OK);
    assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
    assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
    plumb_replay_edit edits[8];
    assert_true(is_head || plumb_replay_edits(replay, edits, 8) > 0);
    t->get(w, thing, &desc); // which has moved on
    t->get(plumb_replay_world(replay), thing, &got);
    assert_near(plumb_property_read(p, &got, 0), plumb_property_read(p, &desc, 0), 0);
    plumb_replay_close(replay);
    plumb_world_destroy(w);
    recording_free(&tape);
}

//---- words ---------------------------------------------------------------------------------------

// `word = value`, as Lua has it.
static void say(char *to, size_t size, const plumb_property *p, double value)
{
    const char *choice = p->unit;
    switch (p->type) {
    case PLUMB_PROPERTY_REAL:
    case PLUMB_PROPERTY_INT:
        snprintf(to, size, "%s = %.17g", p->word, value);
        return;
    case PLUMB_PROPERTY_VEC2:
        snprintf(to, size, "%s = { %.17g, %.17g }", p->word, value, value);
        return;
    case PLUMB_PROPERTY_BOOL:
        snprintf(to, size, "%s = %s", p->word, (value != 0) != p->opposite ? "true" : "false");
        return;
    default:
        break;
    }
    for (int i = 0; i < (int)value; ++i) {
        choice = strchr(choice, '|') + 1;
    }
    snprintf(to, size, "%s = '%.*s'", p->word, (int)strcspn(choice, "|"), choice);
}

static void check_scene(const subject *t, const plumb_property *p, scene *s, double value)
{
    descriptor got = { 0 };
    const plumb_entity none = PLUMB_NULL_ENTITY_INIT;
    t->get(s->world, t->in_scene != NULL ? t->in_scene(s) : none, &got);
    check_value(p, &got, value);
}

static void words(const subject *t, const plumb_property *p)
{
    char word[128], text[256];
    double value;
    for (int i = 0; t->script != NULL && p->word[0] != '\0' && value_of(p, i, &value); ++i) {
        if (!is_usable(p, value) ||
            (value > 0 && value < 1e-30)) { // no inertia follows from such a mass
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
    if (p->type == PLUMB_PROPERTY_BOOL) {
        return;
    }
    const double wrong = p->above ? p->low : p->low - fabs(p->low) - 1;
    if (p->type == PLUMB_PROPERTY_CHOICE) {
        snprintf(word, sizeof word, "%s = 'nothing'", p->word);
    } else {
        say(word, sizeof word, p, wrong);
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
