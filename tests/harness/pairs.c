// pairs.c - the arrays that a narrow-phase kernel reads, filled by hand. Reads, writes: the batch.
#include "narrow/narrow.h"
#include "harness/pairs.h"
#include "world/rows.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A pair has pieces and bodies of its own: 2 i and 2 i + 1.
struct pair_batch {
    int count, capacity;
    pair_side *sides;
    pl_pose *poses;
    pl_core *cores;
    pl_vertex *vertices; // MAX_CORNERS a piece
    uint32_t *first;
    uint8_t *corners;
    plumb_real *friction, *restitution;
    pl_pair *pairs;
    pl_narrow out;
};

#define MAX_CORNERS PLUMB_POLYGON_MAX_VERTICES

static void need(bool ok, const char *what)
{
    if (!ok) {
        fprintf(stderr, "pairs: %s\n", what);
        abort();
    }
}

// The shape as a world stores it: kind, core and corners are what the kernels would get. One world
// serves all shapes of a program; it holds one body with one shape at a time.
static pair_shape make(const plumb_shape_desc *desc)
{
    static plumb_world *world;
    if (world == NULL) {
        need(plumb_world_create(NULL, &world) == PLUMB_OK, "no world");
    }
    plumb_body body = plumb_body_create(world, &(plumb_body_desc){ 0 });
    need(!plumb_is_null(plumb_shape_create(world, body, desc)), "a shape was refused");
    uint32_t piece = world->bodies.first_piece[0];
    pair_shape s = { .kind = (pl_piece_kind)world->pieces.kind[piece],
                     .core = world->pieces.core[piece] };
    pl_piece_convex(world, piece, &s.convex);
    plumb_body_destroy(world, body);
    return s;
}

pair_shape pair_circle(double r)
{
    return make(&(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = (plumb_real)r });
}

pair_shape pair_capsule(double half, double r)
{
    plumb_vec2 ends[2] = { { (plumb_real)-half, 0 }, { (plumb_real)half, 0 } };
    return make(&(plumb_shape_desc){ .kind = r > 0 ? PLUMB_CAPSULE : PLUMB_SEGMENT,
                                     .radius = (plumb_real)r,
                                     .points = ends,
                                     .count = 2 });
}

pair_shape pair_box(double hx, double hy, double r)
{
    return make(&(plumb_shape_desc){
        .kind = PLUMB_BOX, .half = { (plumb_real)hx, (plumb_real)hy }, .radius = (plumb_real)r });
}

pair_shape pair_polygon(const plumb_vec2 *points, int count, double r)
{
    return make(&(plumb_shape_desc){
        .kind = PLUMB_POLYGON, .radius = (plumb_real)r, .points = points, .count = count });
}

static void *room(size_t count, size_t size)
{
    size_t bytes = (count * size + PL_ALIGN - 1) / PL_ALIGN * PL_ALIGN;
    void *memory = aligned_alloc(PL_ALIGN, bytes);
    need(memory != NULL, "out of memory");
    memset(memory, 0, bytes);
    return memory;
}

pair_batch *pairs_create(int capacity)
{
    pair_batch *b = calloc(1, sizeof *b);
    need(b != NULL, "out of memory");
    size_t pieces = (size_t)capacity * 2;
    b->capacity = capacity;
    b->sides = room(pieces, sizeof *b->sides);
    b->poses = room(pieces, sizeof *b->poses);
    b->cores = room(pieces, sizeof *b->cores);
    b->vertices = room(pieces * MAX_CORNERS, sizeof *b->vertices);
    b->first = room(pieces, sizeof *b->first);
    b->corners = room(pieces, sizeof *b->corners);
    b->friction = room(pieces, sizeof *b->friction);
    b->restitution = room(pieces, sizeof *b->restitution);
    b->pairs = room((size_t)capacity, sizeof *b->pairs);
    b->out.manifolds.size = ((size_t)capacity + 1) * sizeof(pl_manifold);
    b->out.manifolds.data = room((size_t)capacity + 1, sizeof(pl_manifold));
    b->out.ends.data = room((size_t)capacity + 1, sizeof(pl_ends));
    b->out.fresh.data = room((size_t)capacity + 1, sizeof(uint32_t));
    b->out.candidates.data = room((size_t)capacity + 1, sizeof(uint32_t));
    return b;
}

void pairs_destroy(pair_batch *b)
{
    free(b->sides);
    free(b->poses);
    free(b->cores);
    free(b->vertices);
    free(b->first);
    free(b->corners);
    free(b->friction);
    free(b->restitution);
    free(b->pairs);
    free(b->out.manifolds.data);
    free(b->out.ends.data);
    free(b->out.fresh.data);
    free(b->out.candidates.data);
    free(b);
}

void pairs_clear(pair_batch *b)
{
    b->count = 0;
}

static pl_pose pose_of(pair_pose at)
{
    return (pl_pose){ .x = (plumb_real)at.x,
                      .y = (plumb_real)at.y,
                      .c = (plumb_real)cos(at.angle),
                      .s = (plumb_real)sin(at.angle) };
}

static void put_side(pair_batch *b, uint32_t piece, const pair_side *side)
{
    const plumb_convex *convex = &side->shape.convex;
    b->sides[piece] = *side;
    b->poses[piece] = side->pose;
    b->cores[piece] = side->shape.core;
    b->first[piece] = piece * MAX_CORNERS;
    int count = convex->count > 1 ? convex->count : 0;
    b->corners[piece] = (uint8_t)count;
    for (int k = 0; k < MAX_CORNERS && count > 0; ++k) {
        int i = k < count ? k : count - 1;
        plumb_vec2 p = convex->points[i], n = convex->normals[i];
        b->vertices[piece * MAX_CORNERS + (uint32_t)k] = (pl_vertex){ p.x, p.y, n.x, n.y };
    }
}

int pairs_add_sides(pair_batch *b, const pair_side *p, const pair_side *q)
{
    need(b->count < b->capacity, "the batch is full");
    uint32_t i = (uint32_t)b->count++;
    put_side(b, 2 * i, p);
    put_side(b, 2 * i + 1, q);
    need(b->sides[2 * i].shape.kind == b->sides[0].shape.kind &&
             b->sides[2 * i + 1].shape.kind == b->sides[1].shape.kind,
         "a batch is of one combination of kinds");
    b->pairs[i] = (pl_pair){ .a = 2 * i,
                             .b = 2 * i + 1,
                             .body_a = 2 * i,
                             .body_b = 2 * i + 1,
                             .feature = { PL_NONE, PL_NONE },
                             .manifold = PL_NONE };
    return (int)i;
}

int pairs_add(pair_batch *b, const pair_shape *p, pair_pose at_p, const pair_shape *q,
              pair_pose at_q)
{
    pair_side side_p = { *p, pose_of(at_p) }, side_q = { *q, pose_of(at_q) };
    bool swap = p->kind > q->kind;
    return pairs_add_sides(b, swap ? &side_q : &side_p, swap ? &side_p : &side_q);
}

void pairs_set_impulses(pair_batch *b, int i, double first, double second)
{
    b->pairs[i].normal[0] = (near_real)first;
    b->pairs[i].normal[1] = (near_real)second;
}

int pairs_count(const pair_batch *b)
{
    return b->count;
}

void pairs_move_b(pair_batch *b, int i, pair_pose at)
{
    b->poses[2 * i + 1] = b->sides[2 * i + 1].pose = pose_of(at);
}

bool pairs_width_runs(int width)
{
#if defined(__x86_64__) || defined(__i386__)
    switch (width) {
    case 8:
        return __builtin_cpu_supports("avx2");
    case 16:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    default:
        return width == 4;
    }
#else
    return width == 4 || width == 8 || width == 16;
#endif
}

void pairs_run(pair_batch *b, int width)
{
    pl_narrow_input in = { .poses = &b->poses[0].x,
                           .cores = b->cores,
                           .vertices = b->vertices,
                           .vertex_first = b->first,
                           .vertex_count = b->corners,
                           .friction = b->friction,
                           .restitution = b->restitution,
                           .dt = (near_real)(1.0 / 60),
                           .pairs = b->pairs };
    pl_narrow_clear(&b->out);
    memset(b->out.manifolds.data, 0, b->out.manifolds.size);
    for (int i = 0; i < b->count; ++i) {
        b->pairs[i].manifold = PL_NONE; // as if they had been apart, whatever ran before
    }
    if (b->count > 0) {
        const int kind_a = (int)b->sides[0].shape.kind, kind_b = (int)b->sides[1].shape.kind;
        pl_narrow_kernel_for(width, kind_a, kind_b)(&in, 0, (uint32_t)b->count, kind_b, &b->out);
    }
}

const pair_side *pairs_a(const pair_batch *b, int i)
{
    return &b->sides[2 * i];
}

const pair_side *pairs_b(const pair_batch *b, int i)
{
    return &b->sides[2 * i + 1];
}

bool pairs_manifold(const pair_batch *b, int i, pl_manifold *out)
{
    uint32_t at = b->pairs[i].manifold;
    if (at == PL_NONE) {
        return false;
    }
    *out = pl_manifolds(&b->out)[at];
    return true;
}

const void *pairs_output(const pair_batch *b, size_t *size)
{
    *size = b->out.manifold_count * sizeof(pl_manifold);
    return b->out.manifolds.data;
}
