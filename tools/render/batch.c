// batch.c - the triangle list of one picture.
//
// Holds vertices in pixel coordinates, indices in painter's order and runs of equal state, so
// that a backend needs two state changes a run and one draw call. Cost: amortised O(1) a vertex.
// When memory runs out the batch is marked failed and swallows the rest.
#include "internal.h"

static bool room(plr_batch *batch, void **data, size_t *capacity, size_t need, size_t size)
{
    // Indices are 32 bits wide, which bounds the vertices as well.
    if (batch->failed || need > UINT32_MAX ||
        !plr_reserve(&batch->allocator, data, capacity, need, size)) {
        batch->failed = true;
        return false;
    }
    return true;
}

void plr_batch_clear(plr_batch *batch)
{
    batch->vertex_count = 0;
    batch->index_count = 0;
    batch->run_count = 0;
    batch->failed = false;
}

void plr_batch_free(plr_batch *batch)
{
    const render_allocator *memory = &batch->allocator;
    plr_release(memory, batch->vertices, batch->vertex_capacity, sizeof *batch->vertices);
    plr_release(memory, batch->indices, batch->index_capacity, sizeof *batch->indices);
    plr_release(memory, batch->runs, batch->run_capacity, sizeof *batch->runs);
}

static uint32_t add_vertex(plr_batch *batch, plr_vertex vertex)
{
    if (!room(batch, (void **)&batch->vertices, &batch->vertex_capacity, batch->vertex_count + 1,
              sizeof *batch->vertices)) {
        return 0;
    }
    batch->vertices[batch->vertex_count] = vertex;
    return (uint32_t)batch->vertex_count++;
}

uint32_t plr_batch_vertex(plr_batch *batch, double x, double y, render_rgba color)
{
    return add_vertex(batch, (plr_vertex){ .x = (float)x, .y = (float)y, .color = color });
}

static void add_triangle(plr_batch *batch, bool textured, uint32_t a, uint32_t b, uint32_t c)
{
    if (batch->run_count == 0 || batch->runs[batch->run_count - 1].textured != textured) {
        if (!room(batch, (void **)&batch->runs, &batch->run_capacity, batch->run_count + 1,
                  sizeof *batch->runs)) {
            return;
        }
        batch->runs[batch->run_count++] =
            (plr_run){ .textured = textured, .first = batch->index_count };
    }
    if (!room(batch, (void **)&batch->indices, &batch->index_capacity, batch->index_count + 3,
              sizeof *batch->indices)) {
        return;
    }
    uint32_t *index = batch->indices + batch->index_count;
    index[0] = a;
    index[1] = b;
    index[2] = c;
    batch->index_count += 3;
    batch->runs[batch->run_count - 1].count += 3;
}

void plr_batch_triangle(plr_batch *batch, uint32_t a, uint32_t b, uint32_t c)
{
    add_triangle(batch, false, a, b, c);
}

void plr_batch_quad(plr_batch *batch, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    add_triangle(batch, false, a, b, c);
    add_triangle(batch, false, a, c, d);
}

void plr_batch_glyph(plr_batch *batch, const double rect[4], const double uv[4], render_rgba color)
{
    uint32_t corner[4];
    for (int i = 0; i < 4; i++) {
        const int right = i == 1 || i == 2 ? 2 : 0; // corners go around the rectangle
        const int lower = i >= 2 ? 3 : 1;
        corner[i] = add_vertex(batch, (plr_vertex){ .x = (float)rect[right],
                                                    .y = (float)rect[lower],
                                                    .u = (float)uv[right],
                                                    .v = (float)uv[lower],
                                                    .color = color });
    }
    add_triangle(batch, true, corner[0], corner[1], corner[2]);
    add_triangle(batch, true, corner[0], corner[2], corner[3]);
}
