// filters.c - which shapes may meet, by name: categories, masks, groups, excluded pairs of bodies.
// A category gets the next free bit when it is named first, a group the next number; results do not
// depend on either, so a scene read back from JSON runs the same. Cost: O(names) a shape.
#include <stdio.h>
#include <string.h>

#include "internal.h"

enum { CATEGORY_MOST = 64 }; // bits of plumb_filter

static int find_category(const scene *s, const char *name)
{
    for (int i = 0; i < s->categories.count; i++) {
        if (strcmp(s->categories.items[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

static sc_category *add_category(scene *s, const char *name)
{
    sc_category *c = SC_PUSH(s, s->categories);
    *c = (sc_category){ 0 };
    snprintf(c->name, sizeof c->name, "%s", name);
    return c;
}

// The bit of the category whose name is on top; `has`: a shape is of it.
static uint64_t take_name(const sc_context *c, bool has)
{
    scene *s = c->s;
    char name[SC_NAME_SIZE];
    sc_read_string(c, -1, name, sizeof name);
    if (s->categories.count == 0) { // bit 0: shapes that say nothing
        add_category(s, "default")->is_had = true;
    }
    int bit = find_category(s, name);
    if (bit < 0 && s->categories.count == CATEGORY_MOST) {
        sc_raise(s, SCENE_E_LIMIT, c->site, c->row->name, c->index, NULL,
                 "there are more than %d categories", CATEGORY_MOST - 1);
    }
    if (bit < 0) {
        bit = s->categories.count;
        sc_category *made = add_category(s, name);
        made->line = c->site->line;
        made->construct = c->site->construct;
        made->key = c->row->name;
        snprintf(made->path, sizeof made->path, "%s", c->site->path != NULL ? c->site->path : "");
    }
    s->categories.items[bit].is_had |= has;
    return (uint64_t)1 << bit;
}

uint64_t sc_read_names(const sc_context *c, int value)
{
    lua_State *L = c->s->L;
    bool has = strcmp(c->row->name, "category") == 0;
    if (lua_type(L, value) != LUA_TSTRING && lua_type(L, value) != LUA_TTABLE) {
        sc_fail_type(c, "a name or a list of names", value);
    }
    if (lua_type(L, value) == LUA_TSTRING) {
        lua_pushvalue(L, value);
        uint64_t bit = take_name(c, has);
        lua_pop(L, 1);
        return bit;
    }
    uint64_t bits = 0;
    lua_Integer count = (lua_Integer)lua_rawlen(L, value);
    sc_work(c->s, 20 * (uint64_t)count);
    for (lua_Integer i = 1; i <= count; i++) {
        if (lua_rawgeti(L, value, i) != LUA_TSTRING) {
            sc_raise(c->s, SCENE_E_TYPE, c->site, c->row->name, c->index, NULL,
                     "'%s' of %s{} must be a name or a list of names; value %d is %s", c->row->name,
                     c->site->construct, (int)i, sc_type_name(c->s, -1));
        }
        bits |= take_name(c, has);
        lua_pop(L, 1);
    }
    if (has && bits == 0) {
        sc_raise(c->s, SCENE_E_RANGE, c->site, c->row->name, c->index, NULL,
                 "'category' of %s{} must name at least one", c->site->construct);
    }
    return bits;
}

void sc_filter_check(scene *s, const sc_site *site, const sc_filter_given *g)
{
    if (g->collides && g->ignores) {
        sc_raise(s, SCENE_E_CONFLICT, site, "ignores", 0, NULL,
                 "%s{} takes either 'collides' or 'ignores'", site->construct);
    }
    if (g->apart && g->together) {
        sc_raise(s, SCENE_E_CONFLICT, site, "together", 0, NULL,
                 "%s{} takes either 'apart' or 'together'", site->construct);
    }
}

static int32_t group_number(scene *s, const char *word)
{
    sc_work(s, (uint64_t)s->groups.count);
    for (int i = 0; i < s->groups.count; i++) {
        if (strcmp(s->groups.items[i].text, word) == 0) {
            return i + 1;
        }
    }
    sc_name *made = SC_PUSH(s, s->groups);
    snprintf(made->text, sizeof made->text, "%s", word);
    return s->groups.count;
}

plumb_filter sc_filter_resolve(scene *s, const sc_filter *own, sc_filter_given g,
                               const sc_filter *body, sc_filter_given b)
{
    plumb_filter out = { .category = g.category ? own->category : b.category ? body->category : 1 };
    const sc_filter *meet = g.collides || g.ignores ? own : body;
    sc_filter_given m = g.collides || g.ignores ? g : b;
    uint64_t mask = m.collides ? meet->collides : m.ignores ? ~meet->ignores : ~(uint64_t)0;
    out.nothing = mask == 0;
    out.mask = mask;
    const sc_filter *group = g.apart || g.together ? own : body;
    sc_filter_given k = g.apart || g.together ? g : b;
    if (k.apart || k.together) {
        int32_t number = group_number(s, k.apart ? group->apart : group->together);
        out.group = k.apart ? -number : number;
    }
    return out;
}

static void mark(const sc_list *list, void *def, const size_t offsets[5], sc_filter_given g)
{
    const bool given[] = { g.category, g.collides, g.ignores, g.apart, g.together };
    for (int i = 0; i < 5; i++) {
        sc_mark(list, def, offsets[i], given[i]);
    }
}

#define OFFSETS(T)                                                                                 \
    {                                                                                              \
        offsetof(T, filter.category), offsetof(T, filter.collides), offsetof(T, filter.ignores),   \
            offsetof(T, filter.apart), offsetof(T, filter.together)                                \
    }

void sc_filter_record(sc_body *body, const sc_filter *filter, sc_filter_given g)
{
    static const size_t of_body[] = OFFSETS(sc_body_def), of_shape[] = OFFSETS(sc_shape_def);
    body->def.filter = *filter;
    mark(&sc_list_body, &body->def, of_body, g);
    for (int i = 0; i < body->def.shape_count; i++) {
        mark(&sc_list_shapes[body->shapes[i].kind], &body->shapes[i], of_shape,
             (sc_filter_given){ .category = false });
    }
}

// A mask that names a category that nothing is of: a slip of the pen, or a category that a handler
// will bring. With handlers it is an error only where another word is meant.
void sc_check_categories(scene *s)
{
    for (int i = 1; i < s->categories.count; i++) {
        const sc_category *c = &s->categories.items[i];
        if (c->is_had) {
            continue;
        }
        sc_suggest g = sc_suggest_start(c->name);
        for (int k = 0; k < s->categories.count; k++) {
            if (s->categories.items[k].is_had) {
                sc_suggest_offer(&g, s->categories.items[k].name);
            }
        }
        if (s->handlers.count == 0 || sc_suggest_best(&g) != NULL) {
            sc_site site = { .construct = c->construct, .line = c->line };
            site.path = c->path[0] != 0 ? c->path : NULL;
            sc_raise(s, SCENE_E_NAME, &site, c->key, 0, sc_suggest_best(&g),
                     "no shape is of category '%s'", c->name);
        }
    }
}

// ------------------------------------------------------------------------------- excluded pairs

plumb_result sc_exclude(scene *s, plumb_body a, plumb_body b, bool exclude)
{
    int at = 0;
    sc_work(s, (uint64_t)s->excluded.count);
    while (at < s->excluded.count) {
        const sc_excluded *e = &s->excluded.items[at];
        if ((plumb_same(e->a, a) && plumb_same(e->b, b)) ||
            (plumb_same(e->a, b) && plumb_same(e->b, a))) {
            break;
        }
        at++;
    }
    bool known = at < s->excluded.count;
    if (exclude && !known) {
        *SC_PUSH(s, s->excluded) = (sc_excluded){ a, b };
    }
    plumb_result r = plumb_world_exclude_pair(s->world, a, b, exclude);
    if ((exclude && !known && r != PLUMB_OK) || (!exclude && known && r == PLUMB_OK)) {
        s->excluded.count--;
        memmove(&s->excluded.items[at], &s->excluded.items[at + 1],
                (size_t)(s->excluded.count - at) * sizeof(sc_excluded));
    }
    return r;
}

void sc_excluded_forget(scene *s, plumb_body body)
{
    int kept = 0;
    for (int i = 0; i < s->excluded.count; i++) {
        sc_excluded e = s->excluded.items[i];
        if (!plumb_same(e.a, body) && !plumb_same(e.b, body)) {
            s->excluded.items[kept++] = e;
        }
    }
    s->excluded.count = kept;
}

// A body, or the name of one.
static plumb_body body_argument(scene *s, const sc_site *site, int index)
{
    lua_State *L = s->L;
    plumb_body body;
    if (sc_body_at_index(L, index, &body)) {
        if (sc_body_of(s, body) == NULL) {
            sc_raise(s, SCENE_E_STATE, site, NULL, index, NULL,
                     "exclude() of a body that was destroyed");
        }
        return body;
    }
    if (lua_type(L, index) != LUA_TSTRING) {
        sc_raise(s, SCENE_E_TYPE, site, NULL, index, NULL,
                 "exclude takes two bodies, or their names, not %s", sc_type_name(s, index));
    }
    const char *name = lua_tostring(L, index);
    sc_check_body_name(s, site, NULL, name);
    const sc_body *b = sc_body_named(s, name);
    if (b == NULL) {
        sc_raise(s, SCENE_E_NAME, site, NULL, index, NULL, "no body is called '%s'", name);
    }
    return b->entity;
}

// exclude(a, b): the two never meet; exclude(a, b, false): they do again.
static int lua_exclude(lua_State *L)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, "exclude");
    int count = lua_gettop(L);
    if (count < 2 || count > 3 || (count == 3 && lua_type(L, 3) != LUA_TBOOLEAN)) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL,
                 "exclude takes two bodies and perhaps false: exclude(a, b)");
    }
    plumb_body a = body_argument(s, &site, 1);
    plumb_body b = body_argument(s, &site, 2);
    if (plumb_same(a, b)) {
        sc_raise(s, SCENE_E_CONFLICT, &site, NULL, 2, NULL, "exclude() of a body with itself");
    }
    plumb_result r = sc_exclude(s, a, b, count < 3 || lua_toboolean(L, 3) != 0);
    if (r != PLUMB_OK) {
        sc_refused(s, &site, NULL, r, "exclude()");
    }
    return 0;
}

void sc_open_filters(lua_State *L)
{
    lua_register(L, "exclude", lua_exclude);
}
