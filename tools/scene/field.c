// field.c - field{}: accelerations that a script gives bodies in every substep.
//
// The function is asked for the middle of the substep: place x + v h / 2, velocity v + a h / 2. The solver then moves by
// v h + a h^2 / 2 and adds a h: half a drift, the kick, half a drift. That is the leapfrog, of second order, which
// keeps the energy of orbits; asked for the beginning, they would spiral out by first order. As a is what the function
// answers, it is asked again with its own answer until that stays: twice where velocity plays no part. A magnetic
// force so answered turns the velocity and does no work (implicit midpoint).
// A system of the substep, registered with the first field{}. Cost: 2 to 6 calls of Lua a body, field and substep.
#include <math.h>

#include "internal.h"

/// Answers that differ by less, relatively, are the same.
static const double SAME = 1e-7;
enum { ROUNDS_MOST = 6 };

/// A body of a substep.
typedef struct moved {
    const sc_handler *handler;
    const sc_body *body;
    double x, y, vx, vy, angle, spin,
        time; ///< in the middle of the substep, without what the field does
} moved;

// A number that the function has returned, `index` from the top; none is 0.
static double returned(scene *s, const sc_site *site, int index)
{
    lua_State *L = s->L;
    if (lua_isnil(L, index)) {
        return 0;
    }
    if (lua_type(L, index) != LUA_TNUMBER || !isfinite(lua_tonumber(L, index))) {
        sc_raise(s, SCENE_E_TYPE, site, NULL, 0, NULL,
                 "the function of field{} must return finite numbers ax, ay [m/s^2] and perhaps "
                 "aw [rad/s^2], not %s",
                 sc_type_name(s, index));
    }
    return lua_tonumber(L, index);
}

// What the field gives the body when its own answer changes velocities by half of `a` h.
static void ask(scene *s, const moved *m, double half, double a[3])
{
    lua_State *L = s->L;
    const sc_site site = { .construct = "field", .line = m->handler->line };
    lua_rawgeti(L, LUA_REGISTRYINDEX, m->handler->contact.function);
    lua_pushnumber(L, m->x);
    lua_pushnumber(L, m->y);
    lua_pushnumber(L, m->vx + half * a[0]);
    lua_pushnumber(L, m->vy + half * a[1]);
    lua_pushnumber(L, m->time);
    sc_body_push(s, m->body);
    lua_pushnumber(L, m->angle);
    lua_pushnumber(L, m->spin + half * a[2]);
    sc_call(s, 8, 3);
    for (int k = 0; k < 3; k++) {
        a[k] = returned(s, &site, k - 3);
    }
    lua_pop(L, 3);
}

static void accelerate(scene *s, const moved *m, double half, plumb_substep_motion *motion)
{
    double a[3] = { 0 }, before[3], change, size;
    int round = 0;
    do {
        change = size = 0;
        for (int k = 0; k < 3; k++) {
            before[k] = a[k];
        }
        ask(s, m, half, a);
        for (int k = 0; k < 3; k++) {
            change = fmax(change, fabs(a[k] - before[k]));
            size = fmax(size, fabs(a[k]));
        }
    } while (++round < ROUNDS_MOST && change > SAME * size);
    motion->ax += (plumb_near)a[0];
    motion->ay += (plumb_near)a[1];
    motion->aw += (plumb_near)a[2];
}

static void accelerate_all(scene *s, void *argument)
{
    const plumb_system_call *call = argument;
    const plumb_substep *sub = call->substep;
    const plumb_body_span span = plumb_world_bodies(call->world);
    const double half = (double)call->dt / 2;
    for (int n = 0; n < s->handlers.count; n++) {
        sc_step_work(s, 1 + (uint64_t)sub->count);
        for (int i = 0; s->handlers.items[n].kind == SC_FIELD && i < sub->count; i++) {
            const sc_handler *h = &s->handlers.items[n];
            uint32_t row = sub->row[i];
            const sc_body *body = sc_body_of(s, span.body[row]);
            if (body == NULL || !sc_name_matches(h->contact.a, body->def.name)) {
                continue;
            }
            const plumb_substep_body *b = &sub->bodies[sub->slot[i]];
            plumb_substep_motion *motion = &sub->motions[sub->slot[i]];
            double vx = (double)b->vx, vy = (double)b->vy, w = (double)b->w;
            const moved m = {
                .handler = h,
                .body = body,
                .x = (double)span.center_x[row] + (double)b->dx + half * vx,
                .y = (double)span.center_y[row] + (double)b->dy + half * vy,
                .vx = vx + half * (double)motion->ax,
                .vy = vy + half * (double)motion->ay,
                .angle = (double)plumb_body_angle(call->world, span.body[row]) + (double)b->da +
                         half * w,
                .spin = w + half * (double)motion->aw,
                .time = call->time + half,
            };
            accelerate(s, &m, half, motion);
        }
    }
}

// The system. An error must not leave through the world's step: it is kept for scene.c to raise.
static void run_fields(const plumb_system_call *call)
{
    plumb_system_call copy = *call;
    scene *s = call->context;
    if (!s->edit_failed) {
        s->edit_failed = !sc_protect(s, accelerate_all, &copy);
    }
}

// field{ body = ..., function }
static int lua_field(lua_State *L)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, "field");
    if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL,
                 "field takes one table: field{body = ..., function}");
    }
    sc_contact_def def = { .function = LUA_NOREF };
    sc_read(s, &site, &sc_list_field, 1, &def);
    if (!s->building) {
        sc_check_body_name(s, &site, "body", def.a);
    }
    sc_handler_add(s, SC_FIELD, &site)->contact = def;
    plumb_system_desc system = { .name = "field",
                                 .phase = PLUMB_PHASE_SUBSTEP,
                                 .run = run_fields,
                                 .reads = "solver bodies",
                                 .writes = "accelerations",
                                 .context = s };
    plumb_result r = s->fields ? PLUMB_OK : plumb_system_create(s->world, &system);
    if (r != PLUMB_OK) {
        sc_refused(s, &site, NULL, r, "field");
    }
    s->fields = true;
    return 0;
}

void sc_open_field(lua_State *L)
{
    lua_register(L, "field", lua_field);
}
