// graph.c - nodes of a formula: each is there once, numbers are worked out, slopes follow by the rules.
//
// A slope that is 0 everywhere is no node, so nothing of it is left in the program, and it stays 0 where something that it
// would be multiplied with is infinite. Of |u|, min, max and if() it is that of the branch that is taken; of a root it
// counts as 0 at 0, as of r in the middle.
//
// Reads, writes: the graph. Cost: O(1) a node, O(nodes) a slope.
#include "formula/graph.h"

void pl_graph_clear(pl_graph *g)
{
    g->count = g->number_count = 0;
    g->is_full = false;
    for (int i = 0; i < PL_NODE_LISTS; ++i) {
        g->lists[i] = PL_NO_NODE;
    }
}

// The node that is as told, made if it is not there.
static uint16_t find(pl_graph *g, pl_node like)
{
    const uint32_t key = like.op * 31u + like.a * 131u + like.b * 737u + like.c * 1009u;
    uint16_t *list = &g->lists[(key ^ key >> 8) % PL_NODE_LISTS];
    for (uint16_t i = *list; i != PL_NO_NODE; i = g->nodes[i].next) {
        const pl_node *n = &g->nodes[i];
        if (n->op == like.op && n->a == like.a && n->b == like.b && n->c == like.c) {
            return i;
        }
    }
    if (g->count == PL_NODES) {
        g->is_full = true;
        return 0;
    }
    like.next = *list;
    g->nodes[g->count] = like;
    *list = g->count;
    return g->count++;
}

uint16_t pl_graph_number(pl_graph *g, double value)
{
    // What is no number has one sign and one payload, or images of two machines would differ.
    const uint64_t bits = value == value ? pl_lane_bits(value) : UINT64_C(0x7ff8000000000000);
    uint16_t i = 0;
    while (i < g->number_count && pl_lane_bits(g->numbers[i]) != bits) {
        ++i;
    }
    if (i == PL_GRAPH_NUMBERS) {
        g->is_full = true;
        return 0;
    }
    g->numbers[i] = pl_lane_of_bits(bits);
    g->number_count = (uint16_t)(i == g->number_count ? i + 1 : g->number_count);
    return find(g, (pl_node){ .op = PL_OP_NUMBER, .is_even = 1, .a = i });
}

uint16_t pl_graph_leaf(pl_graph *g, pl_formula_op op)
{
    return find(g, (pl_node){ .op = (uint8_t)op, .is_even = op == PL_OP_TIME });
}

uint16_t pl_graph_node(pl_graph *g, pl_formula_op op, uint16_t a, uint16_t b, uint16_t c)
{
    const int takes = pl_formula_takes(op);
    b = takes < 2 ? a : b;
    c = takes < 3 ? a : c;
    if (pl_graph_is_number(g, a) && pl_graph_is_number(g, b) && pl_graph_is_number(g, c)) {
        return pl_graph_number(g, pl_formula_value(op, pl_graph_value(g, a), pl_graph_value(g, b),
                                                   pl_graph_value(g, c)));
    }
    const bool commutes = op == PL_OP_ADD || op == PL_OP_MULTIPLY;
    pl_node n = { .op = (uint8_t)op,
                  .is_even = g->nodes[a].is_even & g->nodes[b].is_even & g->nodes[c].is_even,
                  .a = commutes && b < a ? b : a,
                  .b = commutes && b < a ? a : b };
    n.b = takes < 2 ? 0 : n.b;
    n.c = takes < 3 ? 0 : c;
    return find(g, n);
}

//---- powers --------------------------------------------------------------------------------------

enum { LARGEST_PRODUCT = 64 };

// u^n, n >= 1, by squares.
static uint16_t product(pl_graph *g, uint16_t u, int n)
{
    if (n == 1) {
        return u;
    }
    const uint16_t half = product(g, u, n / 2);
    const uint16_t square = pl_graph_node(g, PL_OP_MULTIPLY, half, half, 0);
    return n % 2 == 0 ? square : pl_graph_node(g, PL_OP_MULTIPLY, square, u, 0);
}

uint16_t pl_graph_power(pl_graph *g, uint16_t u, uint16_t v)
{
    const double exponent = pl_graph_is_number(g, v) ? pl_graph_value(g, v) : 0.25;
    const double size = pl_lane_abs(exponent), whole = pl_lane_floor(size);
    if (!(size <= LARGEST_PRODUCT) || (size != whole && size != whole + 0.5)) {
        return pl_graph_node(g, PL_OP_POWER, u, v, 0);
    }
    const uint16_t one = pl_graph_number(g, 1);
    uint16_t of = whole > 0 ? product(g, u, (int)whole) : one;
    if (size != whole) {
        const uint16_t root = pl_graph_node(g, PL_OP_SQRT, u, 0, 0);
        of = whole > 0 ? pl_graph_node(g, PL_OP_MULTIPLY, of, root, 0) : root;
    }
    return exponent < 0 ? pl_graph_node(g, PL_OP_DIVIDE, one, of, 0) : of;
}

//---- slopes --------------------------------------------------------------------------------------

static bool is(const pl_graph *g, uint16_t node, double value)
{
    return pl_graph_is_number(g, node) && pl_graph_value(g, node) == value;
}

static uint16_t plus(pl_graph *g, uint16_t a, uint16_t b)
{
    return a == PL_NO_NODE ? b : b == PL_NO_NODE ? a : pl_graph_node(g, PL_OP_ADD, a, b, 0);
}

static uint16_t minus(pl_graph *g, uint16_t a, uint16_t b)
{
    return b == PL_NO_NODE   ? a
           : a == PL_NO_NODE ? pl_graph_node(g, PL_OP_NEGATE, b, 0, 0)
                             : pl_graph_node(g, PL_OP_SUBTRACT, a, b, 0);
}

static uint16_t times(pl_graph *g, uint16_t a, uint16_t b)
{
    return a == PL_NO_NODE || b == PL_NO_NODE || is(g, a, 0) || is(g, b, 0) ? PL_NO_NODE
           : is(g, a, 1)                                                    ? b
           : is(g, b, 1)                                                    ? a
                         : pl_graph_node(g, PL_OP_MULTIPLY, a, b, 0);
}

static uint16_t over(pl_graph *g, pl_formula_op op, uint16_t a, uint16_t b)
{
    return a == PL_NO_NODE ? PL_NO_NODE : pl_graph_node(g, op, a, b, 0);
}

static uint16_t choose(pl_graph *g, uint16_t condition, uint16_t a, uint16_t b)
{
    if (a == b) {
        return a;
    }
    const uint16_t zero = pl_graph_number(g, 0);
    return pl_graph_node(g, PL_OP_CHOOSE, condition, a == PL_NO_NODE ? zero : a,
                         b == PL_NO_NODE ? zero : b);
}

// Of u^v = e^(v ln u): u^v (v u' / u + v' ln u); with a number v, v u^(v - 1) u', which has no u to divide by.
static uint16_t slope_of_power(pl_graph *g, uint16_t node, uint16_t du, uint16_t dv)
{
    const uint16_t u = g->nodes[node].a, v = g->nodes[node].b;
    if (pl_graph_is_number(g, v)) {
        const uint16_t less = pl_graph_number(g, pl_graph_value(g, v) - 1);
        return times(g, times(g, v, pl_graph_power(g, u, less)), du);
    }
    const uint16_t by_u = over(g, PL_OP_DIVIDE, times(g, v, du), u);
    const uint16_t by_v = times(g, pl_graph_node(g, PL_OP_LOG, u, 0, 0), dv);
    return times(g, node, plus(g, by_u, by_v));
}

static uint16_t slope_of_atan2(pl_graph *g, uint16_t y, uint16_t x, uint16_t dy, uint16_t dx)
{
    const uint16_t yy = pl_graph_node(g, PL_OP_MULTIPLY, y, y, 0);
    const uint16_t xx = pl_graph_node(g, PL_OP_MULTIPLY, x, x, 0);
    const uint16_t first = times(g, x, dy), second = times(g, y, dx);
    return over(g, PL_OP_DIVIDE, minus(g, first, second), pl_graph_node(g, PL_OP_ADD, yy, xx, 0));
}

// Of one argument.
static uint16_t slope_of_function(pl_graph *g, uint16_t node, uint16_t da)
{
    const uint16_t a = g->nodes[node].a;
    const uint16_t one = pl_graph_number(g, 1);
    uint16_t square;
    switch ((pl_formula_op)g->nodes[node].op) {
    case PL_OP_NEGATE:
        return minus(g, PL_NO_NODE, da);
    case PL_OP_ABS:
        return times(g, pl_graph_node(g, PL_OP_SIGN, a, 0, 0), da);
    case PL_OP_SQRT:
        return over(g, PL_OP_SHARE, times(g, pl_graph_number(g, 0.5), da), node);
    case PL_OP_EXP:
        return times(g, node, da);
    case PL_OP_LOG:
        return over(g, PL_OP_DIVIDE, da, a);
    case PL_OP_SIN:
        return times(g, pl_graph_node(g, PL_OP_COS, a, 0, 0), da);
    case PL_OP_COS:
        return minus(g, PL_NO_NODE, times(g, pl_graph_node(g, PL_OP_SIN, a, 0, 0), da));
    case PL_OP_TAN:
        square = pl_graph_node(g, PL_OP_MULTIPLY, node, node, 0);
        return times(g, pl_graph_node(g, PL_OP_ADD, one, square, 0), da);
    case PL_OP_TANH:
        square = pl_graph_node(g, PL_OP_MULTIPLY, node, node, 0);
        return times(g, pl_graph_node(g, PL_OP_SUBTRACT, one, square, 0), da);
    default: // sign, floor
        return PL_NO_NODE;
    }
}

// a da + b db: one behind the other, so that nodes have the same numbers whatever the compiler.
static uint16_t sum_of_products(pl_graph *g, uint16_t a, uint16_t da, uint16_t b, uint16_t db)
{
    const uint16_t first = times(g, a, da), second = times(g, b, db);
    return plus(g, first, second);
}

// da, db, dc: slopes of what it takes.
static uint16_t slope_of(pl_graph *g, uint16_t node, uint16_t da, uint16_t db, uint16_t dc)
{
    const pl_node n = g->nodes[node];
    switch ((pl_formula_op)n.op) {
    case PL_OP_ADD:
        return plus(g, da, db);
    case PL_OP_SUBTRACT:
        return minus(g, da, db);
    case PL_OP_MULTIPLY:
        return n.a == n.b ? times(g, times(g, pl_graph_number(g, 2), n.a), da)
                          : sum_of_products(g, n.b, da, n.a, db);
    case PL_OP_DIVIDE:
        return over(g, PL_OP_DIVIDE, minus(g, da, times(g, node, db)), n.b);
    case PL_OP_MIN:
        return choose(g, pl_graph_node(g, PL_OP_LESS, n.a, n.b, 0), da, db);
    case PL_OP_MAX:
        return choose(g, pl_graph_node(g, PL_OP_LESS, n.b, n.a, 0), da, db);
    case PL_OP_HYPOT:
        return over(g, PL_OP_SHARE, sum_of_products(g, n.a, da, n.b, db), node);
    case PL_OP_ATAN2:
        return slope_of_atan2(g, n.a, n.b, da, db);
    case PL_OP_POWER:
        return slope_of_power(g, node, da, db);
    case PL_OP_CHOOSE:
        return choose(g, n.a, db, dc);
    case PL_OP_LESS:
    case PL_OP_AT_MOST:
        return PL_NO_NODE;
    default:
        return slope_of_function(g, node, da);
    }
}

uint16_t pl_graph_slope(pl_graph *g, uint16_t node, pl_formula_op variable)
{
    uint16_t slopes[PL_NODES];
    for (uint16_t i = 0; i <= node; ++i) {
        const pl_node n = g->nodes[i];
        const int takes = pl_formula_takes((pl_formula_op)n.op);
        const uint16_t da = takes > 0 ? slopes[n.a] : PL_NO_NODE;
        const uint16_t db = takes > 1 ? slopes[n.b] : PL_NO_NODE;
        const uint16_t dc = takes > 2 ? slopes[n.c] : PL_NO_NODE;
        const bool changes = da != PL_NO_NODE || db != PL_NO_NODE || dc != PL_NO_NODE;
        slopes[i] = n.op == variable ? pl_graph_number(g, 1)
                    : changes        ? slope_of(g, i, da, db, dc)
                                     : PL_NO_NODE;
    }
    return slopes[node];
}
