// limits.c - memory and instructions that a scene may use, and that no script can lift.
//
// Memory: every block of the script, the loader and the world is counted against one limit.
// Instructions: a hook counts them in units of SC_HOOK_STEP; bytes that Lua asks for count too, one
// instruction for each BYTES_PER_INSTRUCTION, so that work hidden in C (copying strings) is paid
// for.
#include <stdlib.h>
#include <string.h>

#include "internal.h"

enum {
    BYTES_PER_INSTRUCTION = 64, // a cache line copied is about as dear as an instruction
    ALIGNMENT = 64              // what plumb_allocator promises
};

// -------------------------------------------------------------------------------------- memory

// Room for the change? Counts it if so.
static bool charge(sc_budget *b, size_t old_size, size_t new_size)
{
    if (new_size > old_size && new_size - old_size > b->limit - b->used) {
        return false;
    }
    b->used = b->used - old_size + new_size;
    return true;
}

void *sc_resize(scene *s, void *p, size_t old_size, size_t new_size)
{
    if (!charge(&s->budget, old_size, new_size)) {
        return NULL;
    }
    if (new_size == 0) {
        free(p);
        return NULL;
    }
    void *q = realloc(p, new_size);
    if (q == NULL) {
        charge(&s->budget, new_size, old_size);
    }
    return q;
}

void *sc_need(scene *s, void *p, size_t old_size, size_t new_size)
{
    void *q = sc_resize(s, p, old_size, new_size);
    if (q == NULL && new_size != 0) {
        sc_site site = sc_here(s, "");
        sc_raise(s, SCENE_E_LIMIT, &site, NULL, 0, NULL,
                 "the scene needs more than %zu bytes of memory", s->budget.limit);
    }
    return q;
}

void sc_grow(scene *s, void *array_of_items, int count, int *capacity, size_t item_size)
{
    if (count < *capacity) {
        return;
    }
    void *items;
    memcpy(&items, array_of_items, sizeof items);
    int more = *capacity == 0 ? 16 : 2 * *capacity;
    items = sc_need(s, items, (size_t)*capacity * item_size, (size_t)more * item_size);
    memcpy(array_of_items, &items, sizeof items);
    *capacity = more;
}

void *sc_world_resize(void *context, void *p, size_t old_size, size_t new_size)
{
    scene *s = context;
    if (new_size > SIZE_MAX - ALIGNMENT || !charge(&s->budget, old_size, new_size)) {
        return NULL;
    }
    if (new_size == 0) {
        free(p);
        return NULL;
    }
    void *q = aligned_alloc(ALIGNMENT, (new_size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
    if (q == NULL) {
        charge(&s->budget, new_size, old_size);
        return NULL;
    }
    if (p != NULL) {
        memcpy(q, p, old_size < new_size ? old_size : new_size);
        free(p);
    }
    return q;
}

// Lua is in the midst of something, so nothing here may call it: where the script stood is asked for
// when the error has come to sc_protect.
void *sc_lua_alloc(void *context, void *p, size_t old_size, size_t new_size)
{
    scene *s = context;
    sc_budget *b = &s->budget;
    size_t held = p == NULL ? 0 : old_size; // without a block, Lua tells the kind of object there
    if (p == NULL && old_size == LUA_TSTRING && new_size > SC_STRING_MAX + 64) {
        b->long_string = true;
        return NULL;
    }
    if (new_size > held) {
        b->spent += (new_size - held) / BYTES_PER_INSTRUCTION;
        if (b->spent > b->spend_limit && new_size - held > BYTES_PER_INSTRUCTION) {
            b->out_of_time = true;
            return NULL;
        }
    }
    return sc_resize(s, p, held, new_size);
}

// ---------------------------------------------------------------------------------- instructions

void sc_count_hook(lua_State *L, lua_Debug *d)
{
    scene *s = sc_of(L);
    (void)d;
    s->budget.spent += SC_HOOK_STEP;
    if (s->budget.spent > s->budget.spend_limit) {
        sc_site site = sc_here(s, "");
        sc_raise(s, SCENE_E_LIMIT, &site, NULL, 0, NULL, "the %s takes more than %llu instructions",
                 s->building ? "scene" : "handler", (unsigned long long)s->budget.spend_limit);
    }
}

void sc_sandbox_budget(scene *s, uint64_t instructions)
{
    s->budget.spent = 0;
    s->budget.spend_limit = instructions;
    s->budget.out_of_time = s->budget.long_string = false;
}
