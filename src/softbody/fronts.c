// fronts.c - L D L^T without pivoting, front by front, and solutions.
//
// Blocks whose columns of L have nearly the same rows are a front: its columns are a dense panel, and what it takes from those behind
// them a dense square, which the front of its parent in the elimination tree takes over (multifrontal: Duff, Reid 1983, ACM Trans.
// Math. Softw. 9). Few zeros are factored as if they were numbers, so that fronts are wide (Ashcraft, Grimes 1989, ACM Trans. Math.
// Softw. 15). As children come before their parents, one behind the other, squares lie on two stacks: those of children on one,
// that of the parent on the other.
//
// Reads: the matrix. Writes: factors; the right side. Cost: O(sum of squares of what columns have), O(entries of L).
#include "softbody/softbody.h"

#include <string.h>

#define WIDEST 32 // unknowns of a front; a wider one is cut into several
// What a front takes, where a number that loses a product takes 1.
#define EACH 60.0 // whatever it has
#define LEFT 6.0  // a number that it leaves to its parent

static size_t four(uint32_t n)
{
    return ((size_t)n + 3) & ~(size_t)3;
}

static size_t tall(const pl_soft_front *f)
{
    return four(f->width) + four(f->below);
}

//---- structure -----------------------------------------------------------------------------------

// What a front of so many unknowns takes.
static double cost_of(double width, double below)
{
    const double middle = below + width / 2;
    return EACH + width * middle * middle / 2 + LEFT * below * below / 2;
}

// Whether block j goes to a front of the blocks before it, its children one of the other.
static bool joins(const pl_soft_matrix *m, uint32_t j, uint32_t width)
{
    if (m->parent[j - 1] != j || width + m->size[j] > WIDEST) {
        return false;
    }
    const double below = 2.0 * m->fill[j], size = m->size[j];
    return cost_of(width + size, below) <=
           cost_of(width, 2.0 * m->fill[j - 1]) + cost_of(size, below);
}

// Which front each block is of. Returns how many fronts there are.
static uint32_t group_blocks(pl_soft_matrix *m)
{
    uint32_t count = 0, width = 0;
    for (uint32_t j = 0; j < m->blocks; ++j) {
        if (j == 0 || !joins(m, j, width)) {
            ++count;
            width = 0;
        }
        width += m->size[j];
        m->front_of[j] = count - 1;
    }
    return count;
}

// Who takes over from whom.
static void link_fronts(pl_soft_matrix *m, uint32_t count)
{
    memset(m->fronts, 0, count * sizeof *m->fronts);
    m->front_count = count;
    for (uint32_t j = 0; j < m->blocks; ++j) {
        pl_soft_front *f = &m->fronts[m->front_of[j]];
        f->first = f->width == 0 ? j : f->first;
        f->end = j + 1;
        f->width += m->size[j];
    }
    for (uint32_t k = count; k-- > 0;) {
        pl_soft_front *f = &m->fronts[k];
        const uint32_t above = m->parent[f->end - 1];
        f->parent = above == PL_NONE ? PL_NONE : m->front_of[above];
        f->child = f->next = PL_NONE;
        if (f->parent != PL_NONE) {
            f->next = m->fronts[f->parent].child;
            m->fronts[f->parent].child = k;
        }
    }
}

static void place_block(const pl_soft_matrix *m, pl_soft_front *f, uint32_t block)
{
    uint32_t *to = m->places + f->at + f->width + f->below;
    for (uint32_t c = 0; c < m->size[block]; ++c) {
        to[c] = 3 * block + c;
    }
    f->below += m->size[block];
}

// The unknowns of fronts: those below are what the column of its last block has.
static void place_unknowns(pl_soft_matrix *m)
{
    uint32_t at = 0;
    for (uint32_t k = 0; k < m->front_count; ++k) {
        pl_soft_front *f = &m->fronts[k];
        f->at = at;
        for (uint32_t j = f->first; j < f->end; ++j) {
            for (uint32_t c = 0; c < m->size[j]; ++c) {
                m->places[at++] = 3 * j + c;
            }
        }
        at += 3 * m->fill[f->end - 1];
    }
    memset(m->mark, 0xff, m->blocks * sizeof *m->mark);
    for (uint32_t k = 0; k < m->blocks; ++k) {
        for (uint32_t top = pl_soft_reach(m, k); top < m->blocks; ++top) {
            const uint32_t j = m->stack[top];
            pl_soft_front *f = &m->fronts[m->front_of[j]];
            if (j + 1 == f->end) {
                place_block(m, f, k);
            }
        }
    }
}

// Where an unknown stands in the panel of a front.
static uint32_t row_in(const pl_soft_matrix *m, const pl_soft_front *f, uint32_t place)
{
    const uint32_t *places = m->places + f->at;
    const bool own = place < 3 * f->end;
    uint32_t low = own ? 0 : f->width, high = own ? f->width : f->width + f->below;
    while (low + 1 < high) {
        const uint32_t middle = (low + high) / 2;
        if (places[middle] <= place) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return own ? low : low - f->width + (uint32_t)four(f->width);
}

// Where all of it lies; *rests: numbers that squares take on both stacks, *most: of a panel, *longest: of its column.
static void place_numbers(pl_soft_matrix *m, size_t *rests, size_t *most, size_t *longest)
{
    size_t top[2] = { 0, 0 }, highest[2] = { 0, 0 };
    uint8_t *side = (uint8_t *)m->stack;
    for (uint32_t k = m->front_count; k-- > 0;) {
        const uint32_t parent = m->fronts[k].parent;
        side[k] = parent == PL_NONE ? 0 : !side[parent];
    }
    m->panel_size = *most = *longest = 0;
    for (uint32_t k = 0; k < m->front_count; ++k) {
        pl_soft_front *f = &m->fronts[k];
        size_t *own = &top[side[k]];
        f->panel = m->panel_size;
        m->panel_size += tall(f) * f->width;
        *most = tall(f) * f->width > *most ? tall(f) * f->width : *most;
        *longest = tall(f) > *longest ? tall(f) : *longest;
        f->rest = *own;
        *own += four(f->below) * four(f->below);
        highest[side[k]] = *own > highest[side[k]] ? *own : highest[side[k]];
        if (f->child != PL_NONE) {
            top[!side[k]] = m->fronts[f->child].rest;
        }
    }
    for (uint32_t k = 0; k < m->front_count; ++k) {
        m->fronts[k].rest += side[k] ? highest[0] : 0;
    }
    *rests = highest[0] + highest[1];
}

static void find_rows(pl_soft_matrix *m)
{
    for (uint32_t k = 0; k < m->front_count; ++k) {
        const pl_soft_front *f = &m->fronts[k];
        uint32_t *local = m->local + f->at, *run = m->run + f->at;
        const uint32_t end = f->width + f->below;
        for (uint32_t i = end; i-- > f->width;) {
            local[i] = row_in(m, &m->fronts[f->parent], m->places[f->at + i]);
            run[i] = i + 1 < end && local[i + 1] == local[i] + 1 ? run[i + 1] + 1 : 1;
        }
    }
    for (uint32_t k = 0; k < m->blocks; ++k) {
        for (uint32_t p = m->first[k]; p < m->first[k + 1]; ++p) {
            const pl_soft_front *f = &m->fronts[m->front_of[m->column[p]]];
            m->into[p] = f->panel + row_in(m, f, 3 * m->column[p]) * tall(f) + row_in(m, f, 3 * k);
        }
    }
}

bool pl_soft_make_fronts(pl_memory *memory, pl_soft_step *step)
{
    pl_soft_matrix *m = &step->matrix;
    const uint32_t count = group_blocks(m);
    size_t unknowns = 3 * (size_t)m->blocks;
    for (uint32_t j = 0; j < m->blocks; ++j) {
        const bool last = j + 1 == m->blocks || m->front_of[j + 1] != m->front_of[j];
        unknowns += last ? 3 * (size_t)m->fill[j] : 0;
    }
    const size_t bytes =
        count * sizeof *m->fronts + m->entries * sizeof *m->into + 3 * unknowns * sizeof *m->places;
    if (!pl_buffer_reserve(memory, &step->fronts, bytes)) {
        return false;
    }
    m->fronts = step->fronts.data;
    m->into = (size_t *)(void *)(m->fronts + count);
    m->places = (uint32_t *)(void *)(m->into + m->entries);
    m->local = m->places + unknowns;
    m->run = m->local + unknowns;
    link_fronts(m, count);
    place_unknowns(m);
    size_t rests, most, longest;
    place_numbers(m, &rests, &most, &longest);
    find_rows(m);
    const size_t blocks = m->blocks;
    const size_t numbers =
        m->panel_size + rests + most + longest + 9 * (blocks + m->entries) + 7 * 3 * blocks;
    if (!pl_buffer_reserve(memory, &step->numbers, numbers * sizeof(double))) {
        return false;
    }
    double *d = step->numbers.data;
    m->panels = d, d += m->panel_size;
    m->rests = d, d += rests;
    m->scaled = d, d += most;
    m->piece = d, d += longest;
    m->diagonal = d, d += 9 * blocks;
    m->off = d, d += 9 * (size_t)m->entries;
    double **vectors[] = {
        &m->inverse, &m->right, &m->u, &m->tried, &m->slope, &m->way, &m->sheets
    };
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; ++i) {
        *vectors[i] = d, d += 3 * blocks;
    }
    return true;
}

//---- numbers: blocks of the matrix are by rows, 3 numbers a row ----------------------------------

// What the matrix has of the columns of a front.
static void enter_block(double *to, const double *from, size_t height, int rows, int columns)
{
    for (int c = 0; c < columns; ++c) {
        for (int r = 0; r < rows; ++r) {
            to[(size_t)c * height + (size_t)r] = from[3 * r + c];
        }
    }
}

static void enter_rows(const pl_soft_matrix *m, uint32_t first, uint32_t end)
{
    for (uint32_t k = first; k < end; ++k) {
        const pl_soft_front *own = &m->fronts[m->front_of[k]];
        const size_t at = row_in(m, own, 3 * k);
        enter_block(m->panels + own->panel + at * tall(own) + at, m->diagonal + 9 * (size_t)k,
                    tall(own), m->size[k], m->size[k]);
        for (uint32_t p = m->first[k]; p < m->first[k + 1]; ++p) {
            const uint32_t j = m->column[p];
            enter_block(m->panels + m->into[p], m->off + 9 * (size_t)p,
                        tall(&m->fronts[m->front_of[j]]), m->size[k], m->size[j]);
        }
    }
}

// What a child leaves goes to its parent's panel, and to what that leaves.
static void take_over(const pl_soft_matrix *m, const pl_soft_front *child, const pl_soft_front *f)
{
    const uint32_t *local = m->local + child->at + child->width;
    const uint32_t *run = m->run + child->at + child->width;
    const size_t own = four(f->width), height = tall(f), square = four(f->below);
    for (uint32_t j = 0; j < child->below; ++j) {
        const double *from = m->rests + child->rest + j * four(child->below);
        const bool in_panel = local[j] < own;
        double *to = in_panel ? m->panels + f->panel + local[j] * height
                              : m->rests + f->rest + (local[j] - own) * square;
        m->kernels->add(to, from, j, child->below, local, run, in_panel ? 0 : own);
    }
}

void pl_soft_factor(pl_soft_matrix *m, uint32_t first, uint32_t end)
{
    if (first == end) {
        return;
    }
    const uint32_t from = m->front_of[first], until = m->front_of[end - 1] + 1;
    const size_t start = m->fronts[from].panel;
    const size_t stop = until < m->front_count ? m->fronts[until].panel : m->panel_size;
    memset(m->panels + start, 0, (stop - start) * sizeof(double));
    enter_rows(m, first, end);
    for (uint32_t k = from; k < until; ++k) {
        const pl_soft_front *f = &m->fronts[k];
        double *rest = m->rests + f->rest;
        m->kernels->clear(rest, four(f->below));
        for (uint32_t c = f->child; c != PL_NONE; c = m->fronts[c].next) {
            take_over(m, &m->fronts[c], f);
        }
        m->kernels->factor(m->panels + f->panel, f->width, f->below,
                           m->inverse + 3 * (size_t)f->first, m->scaled, rest);
    }
}

// The numbers of a vector that a front has to do with, and the zeros that fill them up.
static void gather(const pl_soft_matrix *m, const pl_soft_front *f, const double *x, bool all)
{
    const uint32_t *places = m->places + f->at;
    const size_t own = four(f->width);
    memset(m->piece, 0, tall(f) * sizeof(double));
    for (uint32_t i = 0; i < f->width; ++i) {
        m->piece[i] = x[places[i]];
    }
    for (uint32_t i = 0; i < f->below && all; ++i) {
        m->piece[own + i] = x[places[f->width + i]];
    }
}

void pl_soft_solve(const pl_soft_matrix *m, uint32_t first, uint32_t end)
{
    if (first == end) {
        return;
    }
    double *x = m->right;
    const uint32_t from = m->front_of[first], until = m->front_of[end - 1] + 1;
    for (uint32_t k = from; k < until; ++k) {
        const pl_soft_front *f = &m->fronts[k];
        const uint32_t *places = m->places + f->at;
        const double *inverse = m->inverse + 3 * (size_t)f->first;
        gather(m, f, x, false);
        m->kernels->push(m->panels + f->panel, f->width, f->below, m->piece);
        for (uint32_t i = 0; i < f->width; ++i) {
            x[places[i]] = m->piece[i] * inverse[i];
        }
        for (uint32_t i = 0; i < f->below; ++i) {
            x[places[f->width + i]] += m->piece[four(f->width) + i];
        }
    }
    for (uint32_t k = until; k-- > from;) {
        const pl_soft_front *f = &m->fronts[k];
        const uint32_t *places = m->places + f->at;
        gather(m, f, x, true);
        m->kernels->pull(m->panels + f->panel, f->width, f->below, m->piece);
        for (uint32_t i = 0; i < f->width; ++i) {
            x[places[i]] = m->piece[i];
        }
    }
}
