// test_scene_fracture.c - bodies cut, shattered, merged and scaled by a script; what breaks is told; JSON has the parts as they are.
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "scene_fixture.h"

static const char script[] =
    "scene{gravity={0,0}}\n"
    "local oak = material{density=3}\n"
    "body{name='plank', box{4,1}, at={0,0}, material=oak, color=3}\n"
    "body{name='disc', circle{1}, at={6,0}}\n"
    "body{name='tile', box{2,2}, at={12,0}}\n"
    "body{name='pin', type='static', box{0.2,0.2}, at={1.5,0}, collides={}}\n"
    "revolute{'pin', 'plank', at={1.5,0}, name='nail'}\n"
    "body{name='pane', box{0.2,2}, at={-8,0}, break_impulse=0.1, break_cells=6}\n"
    "body{name='stone', circle{0.2}, at={-10,0.1}, velocity={20,0}, mass=1}\n"
    "local function yes(name, is) score(name, is and 1 or 0) end\n"
    "on_shatter{a='pane', b='stone', function(b, e)\n"
    "  yes('told', b:name() == 'pane' and #e.parts > 1 and e.energy > 0 and e.other:name() == "
    "'stone')\n"
    "end}\n"
    "at(0.01, function()\n"
    "  local p = find('plank'):cut(0.5, 0, 0, 1)\n"
    "  yes('cut', #p == 1 and p[1]:name() == 'plank.1' and math.abs(p[1]:mass() - 4.5) < 1e-4)\n"
    "  yes('again', #p[1]:cut(1.5, 0, 0, 1) == 1 and find('plank.2') ~= nil)\n"
    "  yes('shattered', #find('disc'):shatter(6, 0, 9, 4, 1) > 3)\n"
    "  find('tile'):scale(0.5)\n"
    "  yes('scaled', math.abs(find('tile'):mass() - 1) < 1e-4)\n"
    "  yes('merged', find('plank'):merge(find('tile')) >= 0 and find('tile') == nil)\n"
    "end)\n";

static void words_and_json(void **state)
{
    (void)state;
    scene *s = load(script);
    steps(s, 30);
    const char *const names[] = { "told", "cut", "again", "shattered", "scaled", "merged" };
    for (int i = 0; i < 6; ++i) {
        assert_true(score(s, names[i]) == 1);
    }
    size_t size;
    char *text = export_json(s, &size);
    scene *t = load_as("test.json", text, size, NULL);
    double mass[2] = { 0, 0 };
    int count[2];
    for (int k = 0; k < 2; ++k) {
        const plumb_body_span span = plumb_world_bodies(scene_world(k == 0 ? s : t));
        count[k] = span.count;
        for (int i = 0; i < span.count; ++i) {
            mass[k] += (double)plumb_body_mass(scene_world(k == 0 ? s : t), span.body[i]);
        }
    }
    assert_true(count[0] == count[1] && count[0] > 15);
    assert_true(mass[0] > 15 && mass[1] / mass[0] > 0.9999 && mass[1] / mass[0] < 1.0001);
    free(text);
    scene_destroy(s);
    scene_destroy(t);
}

// However many shapes and joints come together.
static const char lump[] =
    "scene{gravity={0,0}}\n"
    "body{name='other', circle{0.1}, at={0,1}}\n"
    "body{name='lump', circle{0.1}, at={0,0}}\n"
    "for i = 1, 100 do distance{'other', 'lump', at_a={0,1}, at_b={0,0}, name='between'..i} end\n"
    "for i = 1, 100 do distance{'other', at_a={0,1}, at_b={0,3}, name='rope'..i} end\n"
    "for i = 1, 300 do body{name='grain'..i, circle{0.1}, at={i,0}} end\n"
    "at(0.01, function()\n"
    "  for i = 1, 300 do find('lump'):merge(find('grain'..i)) end\n"
    "  find('lump'):merge(find('other'))\n"
    "  score('done', 1)\n"
    "end)\n";

static void many_come_together(void **state)
{
    (void)state;
    scene *s = load(lump);
    steps(s, 30);
    assert_true(score(s, "done") == 1);
    size_t size;
    char *text = export_json(s, &size);
    scene *t = load_as("test.json", text, size, NULL);
    for (int k = 0; k < 2; ++k) {
        plumb_world *w = scene_world(k == 0 ? s : t);
        const plumb_body_span span = plumb_world_bodies(w);
        int shapes = 0, joints = 0;
        for (int i = 0; i < span.count; ++i) {
            shapes += plumb_body_shapes(w, span.body[i], NULL, 0);
            joints += plumb_body_joints(w, span.body[i], NULL, 0);
        }
        assert_int_equal(shapes, 302);
        assert_int_equal(joints, 100);
    }
    free(text);
    scene_destroy(s);
    scene_destroy(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(words_and_json),
                                        cmocka_unit_test(many_come_together) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
