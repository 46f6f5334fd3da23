// test_scene_heat.c - heat in scenes: words, methods, what is told of who is gone, expectations; JSON has sizes and temperatures as they are;
// what is refused.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static const char script[] =
    "scene{gravity={0,0}}\n"
    "body{name='plate', type='static', box{4,1}, at={0,-1}, temperature=500, conductance=1e6}\n"
    "body{name='ice', box{1,1}, at={0,0}, temperature=273, heat_capacity=2000, conductance=10, "
    "melting_point=273, latent_heat=1e4, heating=3000, smallest=0.1, user={x=7}}\n"
    "body{name='cube', box{0.2,0.2}, at={5,0}, temperature=270, melting_point=273, "
    "latent_heat=100, "
    "heating=1000, smallest=0.1, user={x=8}}\n"
    "body{name='log', circle{0.5}, at={9,0}, temperature=700, emissivity=0.5, ambient=300, "
    "ignition=600, burn_rate=0.1, burn_heat=1e5, density=2}\n"
    "body{name='balloon', circle{0.5}, at={12,0}, growth=0.5}\n"
    "body{name='peg', type='static', circle{0.1}, at={5,0.5}, collides={}}\n"
    "distance{'peg', 'cube', name='string'}\n"
    "local function yes(name, is) score(name, is and 1 or 0) end\n"
    "on_gone{a='cube', function(b, e)\n"
    "  yes('told', b:name() == 'cube' and not b:alive() and b.user.x == 8 and e.how == 'melted' "
    "and e.mass >= 0 "
    "and find('cube') == nil)\n"
    "end}\n"
    "on_gone{a='log*', function() yes('wrong', true) end}\n"
    "at(1, function()\n"
    "  local h = heat()\n"
    "  yes('melts', find('ice'):temperature() == 273 and find('ice'):mass() < 0.8)\n"
    "  yes('sums', h.gone > 0.2 and h.content > 0 and h.held > 0 and h.owed == 0 and h.melted == "
    "0)\n"
    "  yes('burns', find('log'):mass() < 1.4 and find('log'):temperature() > 700)\n"
    "  yes('grows', find('balloon'):mass() > 0.75)\n"
    "  find('plate'):set_temperature(400) find('ice'):set_heating(0) "
    "find('balloon'):set_growth(0)\n"
    "end)\n"
    "expect{'it is at its melting point', body='ice', at=1.2, temperature={272.9,273.1}}\n";

static double total(scene *s, double *kelvin)
{
    const plumb_world *w = scene_world(s);
    const plumb_body_span span = plumb_world_bodies(scene_world(s));
    double mass = 0;
    *kelvin = 0;
    for (int i = 0; i < span.count; ++i) {
        mass += (double)plumb_body_mass(w, span.body[i]);
        *kelvin += (double)plumb_body_temperature(w, span.body[i]);
    }
    return mass;
}

static void words_and_json(void **state)
{
    (void)state;
    scene *s = load(script);
    steps(s, 75);
    const char *const names[] = { "told", "melts", "sums", "burns", "grows" };
    for (int i = 0; i < 5; ++i) {
        if (score(s, names[i]) != 1) {
            fail_msg("%s", names[i]);
        }
    }
    assert_false(score(s, "wrong") == 1);
    size_t size;
    char *text = export_json(s, &size);
    scene *t = load_as("test.json", text, size, NULL);
    double kelvin[2];
    const double mass = total(s, &kelvin[0]), again = total(t, &kelvin[1]);
    assert_int_equal(plumb_world_bodies(scene_world(s)).count, 5); // without the cube
    assert_int_equal(plumb_world_bodies(scene_world(t)).count, 5);
    assert_true(mass > 1 && again / mass > 0.9999 && again / mass < 1.0001);
    assert_true(kelvin[0] > 1000 && kelvin[1] / kelvin[0] > 0.99999 &&
                kelvin[1] / kelvin[0] < 1.00001);
    assert_null(strstr(text, "string")); // went with the cube
    free(text);
    scene_destroy(s);
    scene_destroy(t);
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } cases[] = {
        { "body{circle{1}, temperature=-1}", "temperature" },
        { "body{type='static', circle{1}, melting_point=273}",
          "a static body{} cannot have 'melting_point'" },
        { "body{type='static', circle{1}, heating=3}", "a static body{} cannot have 'heating'" },
        { "body{circle{1}, melt_phase=8}", "melt_phase" },
        { "body{circle{1}, temperatur=8}", "temperature" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        scene *s = NULL;
        scene_error e = { 0 };
        const char *text = cases[i].text;
        scene_load(&(scene_options){ .path = "test.lua", .text = text, .text_size = strlen(text) },
                   &s, &e);
        assert_null(s);
        if (strstr(e.text, cases[i].says) == NULL || strstr(e.text, "test.lua:1") == NULL) {
            fail_msg("%s: %s", text, e.text);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_and_json),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
