// limits.c - memory, work and time that a scene may use, and that no script can lift.
//
// Memory: every block of the script, the loader and the world is counted against one limit.
// Work: a hook counts Lua's instructions in units of SC_HOOK_STEP; bytes that Lua asks for count too, one
// instruction for each BYTES_PER_INSTRUCTION; so does what functions in C do (sc_work), in proportion to what
// they touch. Counts are the same on every machine: so is the place where a script ends.
// Time: what one instruction may hide (comparing long strings, keys that collide in a table) is bounded by
// processor time alone, at some ten times what the counted work takes. It only ever ends a script.
#define _POSIX_C_SOURCE 200809L // clock_gettime

#include <stdlib.h>
#include <string.h>
#include <time.h>

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

// ----------------------------------------------------------------------------------- work and time

static const double LOOK_EVERY =
    0.005; // [s] between two questions for processor time, which cost a system call

static double clock_now(clockid_t clock)
{
    struct timespec t = { 0 };
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void check_stop(scene *s)
{
    const scene_options *o = &s->options;
    if (o->stop != NULL && o->stop(o->stop_context)) {
        sc_site site = sc_here(s, "");
        sc_raise(s, SCENE_E_STOPPED, &site, NULL, 0, NULL, "the %s was stopped",
                 s->building ? "scene" : "run");
    }
}

static void check_time(scene *s)
{
    sc_budget *b = &s->budget;
    double now = clock_now(CLOCK_MONOTONIC);
    if (now - b->looked < LOOK_EVERY) {
        return;
    }
    b->looked = now;
    double used = clock_now(CLOCK_THREAD_CPUTIME_ID);
    b->began = b->began < 0 ? used : b->began;
    if (used - b->began > b->seconds_limit) {
        sc_site site = sc_here(s, "");
        sc_raise(s, SCENE_E_LIMIT, &site, NULL, 0, NULL, "the %s more than %g s of processor time",
                 s->building ? "scene takes" : "handlers of a step take", b->seconds_limit);
    }
}

// Asks for a stop and for the time, but not at every call of a getter.
static void look_around(scene *s, uint64_t work)
{
    sc_budget *b = &s->budget;
    b->since_look += work < SC_HOOK_STEP ? work : SC_HOOK_STEP;
    if (b->since_look >= SC_HOOK_STEP) {
        b->since_look = 0;
        check_stop(s);
        check_time(s);
    }
}

static void check_work(scene *s)
{
    const sc_budget *b = &s->budget;
    bool call = b->spent > b->spend_limit;
    if (call || b->step_spent + b->spent > b->step_limit) {
        sc_site site = sc_here(s, "");
        sc_raise(s, SCENE_E_LIMIT, &site, NULL, 0, NULL, "the %s more than %llu instructions",
                 s->building ? "scene takes"
                 : call      ? "handler takes"
                             : "handlers of a step take",
                 (unsigned long long)(call ? b->spend_limit : b->step_limit));
    }
}

void sc_work(scene *s, uint64_t work)
{
    s->budget.spent += work < UINT64_MAX / 4 - s->budget.spent ? work : UINT64_MAX / 4;
    check_work(s);
    look_around(s, work);
}

void sc_step_work(scene *s, uint64_t work)
{
    s->budget.step_spent += work;
    check_work(s);
    look_around(s, work);
}

void sc_query_work(scene *s)
{
    // A ray through a pile of 10,000 took 30 us, the nearest of as many 110 us: 4 to 16 instructions a shape. Most
    // questions look at a hundredth of the world.
    sc_work(s, 100 + plumb_world_stats(s->world).shape_count / 16);
}

void sc_count_hook(lua_State *L, lua_Debug *d)
{
    (void)d;
    sc_work(sc_of(L), SC_HOOK_STEP);
}

void sc_budget_begin(scene *s, uint64_t instructions, uint64_t most, double seconds)
{
    sc_budget *b = &s->budget;
    b->spent = b->step_spent = 0;
    b->spend_limit = instructions;
    b->step_limit = most;
    b->seconds_limit = seconds;
    b->looked = clock_now(CLOCK_MONOTONIC);
    b->began = -1;
    b->out_of_time = b->long_string = false;
}

void sc_budget_call(scene *s)
{
    sc_budget *b = &s->budget;
    b->step_spent += b->spent;
    b->spent = 0;
    b->out_of_time = b->long_string = false;
}
