// compile.c - texts become a program: nodes in the order in which they are needed, registers for as long as they are.
//
// What is the same at all places (numbers, what follows from the time alone) is worked out once for all of them, and stands
// among the constants. The rest is put down from the results backwards, depth first, so that few values are kept at a time;
// AX and AY first, since what they have in common with the other results is there already. A step never writes where it
// reads: compilers make lanes of its loop then.
//
// Reads: texts. Writes: the program. Cost: O(nodes) but for looking up those that are alike; some 14 kB of stack.
#include "formula/graph.h"

#include <stdio.h>

enum { NO_PLACE = 255, NEVER = UINT16_MAX };

_Static_assert(PL_FORMULA_CONSTANT + PL_FORMULA_CONSTANTS <= NO_PLACE, "places are bytes");
_Static_assert(PL_FORMULA_REGISTERS <= 64, "registers in use are bits");

typedef struct assembly {
    const pl_graph *graph;
    pl_formula *out;
    uint16_t order[PL_NODES]; // nodes that need a column
    uint16_t last[PL_NODES];  // of a node: the place in the order behind which it is not needed
    uint8_t place[PL_NODES];  // of a node: register or constant
    uint16_t count, force_count;
    uint64_t used; // registers
    bool is_full;
} assembly;

//---- order ---------------------------------------------------------------------------------------

static uint16_t operand_of(const pl_node *n, int i)
{
    return i == 0 ? n->a : i == 1 ? n->b : n->c;
}

static int takes(const pl_node *n)
{
    return pl_formula_takes((pl_formula_op)n->op);
}

// Puts down what a result needs, and itself; `place` says who is there already.
static void put(assembly *s, uint16_t root)
{
    uint16_t stack[PL_NODES];
    uint8_t done[PL_NODES]; // operands of who is on the stack
    int depth = 0;
    stack[0] = root, done[0] = 0;
    while (depth >= 0) {
        const uint16_t node = stack[depth];
        const pl_node *n = &s->graph->nodes[node];
        if (n->is_even || s->place[node] != NO_PLACE) {
            --depth;
        } else if (done[depth] < takes(n)) {
            const uint16_t next = operand_of(n, done[depth]++);
            stack[++depth] = next, done[depth] = 0;
        } else {
            s->place[node] = 0; // a register, found later
            s->order[s->count++] = node;
            --depth;
        }
    }
}

//---- what is even --------------------------------------------------------------------------------

static uint8_t new_constant(assembly *s, double value)
{
    pl_formula *out = s->out;
    if (out->constant_count == PL_FORMULA_CONSTANTS) {
        s->is_full = true;
        return PL_FORMULA_CONSTANT;
    }
    out->constants[out->constant_count] = value;
    return (uint8_t)(PL_FORMULA_CONSTANT + out->constant_count++);
}

static void add_step(assembly *s, pl_formula_step step)
{
    if (s->out->end == PL_FORMULA_STEPS) {
        s->is_full = true;
    } else {
        s->out->steps[s->out->end++] = step;
    }
}

// What works a node out, all of whose operands have their places.
static pl_formula_step step_of(const assembly *s, uint16_t node)
{
    const pl_node *n = &s->graph->nodes[node];
    const int count = takes(n);
    return (pl_formula_step){ .op = n->op,
                              .to = s->place[node],
                              .a = s->place[n->a],
                              .b = s->place[count > 1 ? n->b : n->a],
                              .c = s->place[count > 2 ? n->c : n->a] };
}

// Marks the nodes that are even and needed: by what is in order, by results, by one another.
static void call_even(assembly *s, const uint16_t *results, int count, bool *called)
{
    const pl_node *nodes = s->graph->nodes;
    for (int i = 0; i < count; ++i) {
        called[results[i]] |= nodes[results[i]].is_even;
    }
    for (int i = s->graph->count - 1; i >= 0; --i) {
        const bool needed = called[i] || s->place[i] != NO_PLACE;
        for (int k = 0; k < takes(&nodes[i]) && needed; ++k) {
            const uint16_t operand = operand_of(&nodes[i], k);
            called[operand] |= nodes[operand].is_even;
        }
    }
}

static void put_even(assembly *s, const uint16_t *results, int count)
{
    bool called[PL_NODES] = { false };
    call_even(s, results, count, called);
    for (uint16_t i = 0; i < s->graph->count; ++i) {
        const pl_node *n = &s->graph->nodes[i];
        if (!called[i]) {
            continue;
        }
        if (n->op == PL_OP_TIME) {
            s->place[i] = PL_FORMULA_CONSTANT;
            s->out->uses_time = 1;
            continue;
        }
        s->place[i] = new_constant(s, n->op == PL_OP_NUMBER ? s->graph->numbers[n->a] : 0);
        if (n->op != PL_OP_NUMBER) {
            add_step(s, step_of(s, i));
        }
    }
    s->out->even_end = s->out->end;
}

//---- registers -----------------------------------------------------------------------------------

static void find_ends(assembly *s, const uint16_t *results, int count)
{
    for (uint16_t i = 0; i < s->count; ++i) {
        const pl_node *n = &s->graph->nodes[s->order[i]];
        s->last[s->order[i]] = i;
        for (int k = 0; k < takes(n); ++k) {
            s->last[operand_of(n, k)] = i;
        }
    }
    for (int i = 0; i < count; ++i) {
        s->last[results[i]] = NEVER;
    }
}

static uint8_t new_register(assembly *s)
{
    for (uint8_t i = 0; i < PL_FORMULA_REGISTERS; ++i) {
        if ((s->used >> i & 1) == 0) {
            s->used |= UINT64_C(1) << i;
            return i;
        }
    }
    s->is_full = true;
    return 0;
}

static void release(assembly *s, uint16_t node, uint16_t now)
{
    if (!s->graph->nodes[node].is_even && s->last[node] == now) {
        s->used &= ~(UINT64_C(1) << s->place[node]);
    }
}

// Of a variable: its register; NO_PLACE of others.
static uint8_t input_of(const pl_node *n)
{
    return n->op == PL_OP_PLACE_X   ? PL_FORMULA_X
           : n->op == PL_OP_PLACE_Y ? PL_FORMULA_Y
           : n->op == PL_OP_SPEED_X ? PL_FORMULA_VX
           : n->op == PL_OP_SPEED_Y ? PL_FORMULA_VY
                                    : NO_PLACE;
}

// Those that are taken before the first step.
static void put_inputs(assembly *s)
{
    for (uint16_t i = 0; i < s->count; ++i) {
        const uint8_t input = input_of(&s->graph->nodes[s->order[i]]);
        if (input != NO_PLACE) {
            s->place[s->order[i]] = input;
            s->used |= UINT64_C(1) << input;
            s->out->uses_velocity |= input == PL_FORMULA_VX || input == PL_FORMULA_VY;
        }
    }
}

static void put_columns(assembly *s)
{
    for (uint16_t i = 0; i < s->count && !s->is_full; ++i) {
        const uint16_t node = s->order[i];
        const pl_node *n = &s->graph->nodes[node];
        if (input_of(n) == NO_PLACE) {
            s->place[node] = new_register(s);
            add_step(s, step_of(s, node));
            for (int k = 0; k < takes(n); ++k) {
                release(s, operand_of(n, k), i);
            }
        }
        s->out->force_end = i + 1 == s->force_count ? s->out->end : s->out->force_end;
    }
}

static bool assemble(const pl_graph *g, const uint16_t results[PL_FORMULA_RESULTS], int count,
                     pl_formula *out)
{
    assembly s = { .graph = g, .out = out };
    memset(s.place, NO_PLACE, sizeof s.place);
    memset(out, 0, sizeof *out);
    out->constant_count = 1; // the time
    for (int i = 0; i < count; ++i) {
        put(&s, results[i]);
        s.force_count = i == PL_FORMULA_AY ? s.count : s.force_count;
    }
    put_even(&s, results, count);
    out->force_end = out->end; // where neither needs a column
    find_ends(&s, results, count);
    put_inputs(&s);
    put_columns(&s);
    for (int i = 0; i < count; ++i) {
        out->results[i] = s.place[results[i]];
    }
    return !s.is_full;
}

//---- texts ---------------------------------------------------------------------------------------

static uint16_t something(pl_graph *g, uint16_t node)
{
    return node == PL_NO_NODE ? pl_graph_number(g, 0) : node;
}

static int find_results(pl_graph *g, bool is_potential, const uint16_t roots[2],
                        uint16_t results[PL_FORMULA_RESULTS])
{
    if (is_potential) {
        results[PL_FORMULA_AX] = something(g, pl_graph_slope(g, roots[0], PL_OP_PLACE_X));
        results[PL_FORMULA_AY] = something(g, pl_graph_slope(g, roots[0], PL_OP_PLACE_Y));
        results[PL_FORMULA_POTENTIAL] = roots[0];
        return PL_FORMULA_POTENTIAL + 1;
    }
    results[PL_FORMULA_AX] = roots[0];
    results[PL_FORMULA_AY] = roots[1];
    results[PL_FORMULA_AX_VX] = something(g, pl_graph_slope(g, roots[0], PL_OP_SPEED_X));
    results[PL_FORMULA_AX_VY] = something(g, pl_graph_slope(g, roots[0], PL_OP_SPEED_Y));
    results[PL_FORMULA_AY_VX] = something(g, pl_graph_slope(g, roots[1], PL_OP_SPEED_X));
    results[PL_FORMULA_AY_VY] = something(g, pl_graph_slope(g, roots[1], PL_OP_SPEED_Y));
    return PL_FORMULA_RESULTS;
}

bool pl_formula_compile(const char *const texts[2], bool is_potential, pl_formula *out,
                        pl_formula_fault *fault)
{
    pl_graph g;
    uint16_t roots[2], results[PL_FORMULA_RESULTS] = { 0 };
    pl_graph_clear(&g);
    for (int i = 0; i < (is_potential ? 1 : 2); ++i) {
        fault->text = i;
        roots[i] = pl_graph_number(&g, 0);
        if (texts[i] != NULL && !pl_formula_parse(&g, texts[i], is_potential, fault, &roots[i])) {
            return false;
        }
    }
    fault->text = 0;
    const int count = find_results(&g, is_potential, roots, results);
    if (g.is_full || !assemble(&g, results, count, out)) {
        snprintf(fault->says, sizeof fault->says,
                 "too long: it takes more than %d steps, or %d values at a time", PL_FORMULA_STEPS,
                 PL_FORMULA_REGISTERS);
        return false;
    }
    out->is_potential = is_potential;
    return true;
}
