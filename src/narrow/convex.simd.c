// convex.simd.c - the general pair: convex cores of 2 to 16 corners with radii, and a circle
// against one.
//
// Separating axes over the face normals of both; the face that separates most is the reference
// face, the incident edge of the other core is clipped to it. Where the cores are apart and the
// nearest features are two corners, no face normal is the direction of least distance; then the
// corners give the normal and one point. Corners and normals of W pairs are gathered into lanes;
// lanes with fewer corners repeat their last one, which changes no minimum. Cost: O(corners of A x
// corners of B).
#include "narrow/lanes.h"

#define MAX_CORNERS PLUMB_POLYGON_MAX_VERTICES

// A reference face changes sides only for a gain of this much, so that it does not flicker. [m]
#define PREFER_A ((near_real)5e-4)

// Corners and edge normals of one side of W pairs, in world axes about A's core centre.
typedef struct outline {
    int count; // of the lane with most
    vm last;   // corner of each lane
    vf x[MAX_CORNERS], y[MAX_CORNERS];
    vf nx[MAX_CORNERS], ny[MAX_CORNERS];
} outline;

WIDE_PART void outline_gather(outline *o, const pl_narrow_input *in, const lanes *l,
                              const bool of_b)
{
    const uint32_t *piece = of_b ? l->b : l->a;
    const vf c = of_b ? l->pbc : l->pac, s = of_b ? l->pbs : l->pas;
    const vf cx = of_b ? l->bcx : l->acx, cy = of_b ? l->bcy : l->acy;
    const vf ox = of_b ? l->dx : splat(0), oy = of_b ? l->dy : splat(0);
    const pl_vertex *corner[PL_WIDTH];
    const plumb_real *center[PL_WIDTH];
    uint32_t count[PL_WIDTH];
    pl_lane last[PL_WIDTH];
    o->count = 0;
    for (int i = 0; i < PL_WIDTH; ++i) {
        corner[i] = in->vertices + in->vertex_first[piece[i]];
        center[i] = &in->cores[piece[i]].x;
        count[i] = in->vertex_count[piece[i]];
        last[i] = (pl_lane)count[i] - 1;
        o->count = (int)count[i] > o->count ? (int)count[i] : o->count;
    }
    memcpy(&o->last, last, sizeof last);
    for (int k = 0; k < o->count; ++k) {
        const plumb_real *row[PL_WIDTH];
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = (uint32_t)k < count[i] ? (uint32_t)k : count[i] - 1;
            row[i] = &corner[i][at].x;
        }
        vf v[4];
        gather4_from(v, row, center, cx, cy);
        o->x[k] = ox + (c * v[0] - s * v[1]);
        o->y[k] = oy + (s * v[0] + c * v[1]);
        o->nx[k] = c * v[2] - s * v[3];
        o->ny[k] = s * v[2] + c * v[3];
    }
}

typedef struct best_face {
    vf separation;
    vf nx, ny;
    vm index;
} best_face;

// The face of `a` that separates it most from `b`.
static inline best_face find_face(const outline *a, const outline *b)
{
    best_face best = { splat(-PL_APART), splat(0), splat(0), (vm){ 0 } };
    for (int i = 0; i < a->count; ++i) {
        vf nearest = splat(PL_APART);
        for (int j = 0; j < b->count; ++j) {
            vf along = (b->x[j] - a->x[i]) * a->nx[i] + (b->y[j] - a->y[i]) * a->ny[i];
            nearest = vmin(nearest, along);
        }
        vm better = nearest > best.separation;
        best.separation = sel(better, nearest, best.separation);
        best.nx = sel(better, a->nx[i], best.nx);
        best.ny = sel(better, a->ny[i], best.ny);
        best.index = selm(better, (vm)splat(0) + i, best.index);
    }
    return best;
}

// Ends of edge k: corner k and the one after it. Lanes that have fewer edges get their last one.
WIDE_INLINE void edge_ends(const outline *o, int k, vf end[4])
{
    const vm inner = o->last > (pl_lane)k;
    const int next = k + 1 < o->count ? k + 1 : 0;
    end[0] = o->x[k], end[1] = o->y[k];
    end[2] = sel(inner, o->x[next], o->x[0]), end[3] = sel(inner, o->y[next], o->y[0]);
}

// Those of edge `index` of each lane in `here`; the others keep what they have.
WIDE_PART void edge_pick(const outline *o, vm index, vm here, vf end[4])
{
    for (int k = 0; k < o->count; ++k) {
        const vm it = here & (index == (pl_lane)k);
        vf e[4];
        edge_ends(o, k, e);
        for (int i = 0; i < 4; ++i) {
            end[i] = sel(it, e[i], end[i]);
        }
    }
}

// The edge of the incident core whose normal is most against (nx, ny).
static inline vm incident_edge(const outline *a, const outline *b, vm flip, vf nx, vf ny)
{
    vf least = splat(2);
    vm index = (vm){ 0 };
    int count = a->count > b->count ? a->count : b->count;
    for (int k = 0; k < count; ++k) {
        int ka = k < a->count ? k : a->count - 1;
        int kb = k < b->count ? k : b->count - 1;
        vf dot = nx * sel(flip, a->nx[ka], b->nx[kb]) + ny * sel(flip, a->ny[ka], b->ny[kb]);
        vm better = dot < least;
        least = sel(better, dot, least);
        index = selm(better, (vm)splat(0) + k, index);
    }
    return index;
}

// Squared distance of (px, py) from the segment e0-e1, and the nearest point on it.
WIDE_INLINE vf segment_distance(vf px, vf py, const vf e[4], vf *qx, vf *qy)
{
    vf ex = e[2] - e[0], ey = e[3] - e[1];
    vf length = ex * ex + ey * ey;
    vf at = ((px - e[0]) * ex + (py - e[1]) * ey) / length;
    at = vclamp(at, splat(0), splat(1));
    *qx = e[0] + at * ex;
    *qy = e[1] + at * ey;
    vf rx = px - *qx, ry = py - *qy;
    return rx * rx + ry * ry;
}

// The nearest points of two cores that are apart, found so far.
typedef struct nearest {
    vf square;         // [m^2] of the distance
    vf ax, ay, bx, by; // on the core of A, on that of B
} nearest;

// Every corner of `from` against every edge of `to`.
WIDE_PART void nearest_corners(nearest *n, const outline *from, const outline *to, bool from_a)
{
    for (int k = 0; k < to->count; ++k) {
        vf e[4];
        edge_ends(to, k, e);
        for (int i = 0; i < from->count; ++i) {
            vf qx, qy;
            vf d = segment_distance(from->x[i], from->y[i], e, &qx, &qy);
            vm nearer = d < n->square;
            n->square = sel(nearer, d, n->square);
            n->ax = sel(nearer, from_a ? from->x[i] : qx, n->ax);
            n->ay = sel(nearer, from_a ? from->y[i] : qy, n->ay);
            n->bx = sel(nearer, from_a ? qx : from->x[i], n->bx);
            n->by = sel(nearer, from_a ? qy : from->y[i], n->by);
        }
    }
}

// Distance of the reference edge from the incident one, each end against the other edge.
WIDE_INLINE vf edge_distance(const vf r[4], const vf w[4])
{
    vf qx, qy;
    vf d = segment_distance(w[0], w[1], r, &qx, &qy);
    d = vmin(d, segment_distance(w[2], w[3], r, &qx, &qy));
    d = vmin(d, segment_distance(r[0], r[1], w, &qx, &qy));
    d = vmin(d, segment_distance(r[2], r[3], w, &qx, &qy));
    return vsqrt(d);
}

// Edges that lean less than this against the face lie on it: a hundredth of a radian and a little.
#define FLAT_SLOPE ((near_real)0.02)
#define MOST_CUT   ((near_real)1e-4) // [m]

// Where the cores are apart and two corners face each other, no face separates them by their distance:
// one point along the connection of the nearest corners replaces the clip. Lines end to end, which have
// no face across their direction, are such a case at face separation 0. Edges that all but lie on the
// face keep both points, or a body that overhangs would lose its second support at the least tilt (a
// stack of overhanging capsules then walks); only the depth beside the corner is set right.
// `separation` [m]: of the reference face; `other`: of the face of the other side, which separates lines in line where they
// cross the reference face. It counts where edges are far from one another: beside a corner that bears, it is by chance the larger.
// `cut` [m]: by so much the clip has raised the deeper end. Of an edge that is steep it may raise it out of reach, while
// its corner is hardly beside the face.
WIDE_PART void round_corners(touch *t, const lanes *l, const outline *a, const outline *b,
                             const vf r[4], const vf w[4], vf separation, vf other, vf cut,
                             vm lies_flat, vm low_is_nearer)
{
    vf zero = splat(0), between = edge_distance(r, w);
    vf most = sel(between > splat(2 * PREFER_A), vmax(separation, other), separation);
    vm corner =
        (most > splat((near_real)-1e-5)) &
        ((between > vmax(separation, zero) * splat((near_real)1.000002) + splat((near_real)4e-6)) |
         ((cut > splat(MOST_CUT)) & ~lies_flat));
    if (!any(corner)) {
        return; // the result of a lane does not depend on the others: it would not be taken
    }
    nearest n = { splat(PL_APART), zero, zero, zero, zero };
    nearest_corners(&n, a, b, true);
    nearest_corners(&n, b, a, false);
    vf distance = vsqrt(n.square);
    vf divisor = sel(corner & (distance > zero), distance, splat(1));
    vf nx = (n.bx - n.ax) / divisor, ny = (n.by - n.ay) / divisor;
    vf sep = distance - l->ar - l->br;
    vf out = l->ar + sep * splat((near_real)0.5); // from A's core: its radius and half the gap
    t->sep[0] = sel(corner & lies_flat & low_is_nearer, sep, t->sep[0]);
    t->sep[1] = sel(corner & lies_flat & ~low_is_nearer, sep, t->sep[1]);
    corner &= ~lies_flat;
    t->nx = sel(corner, nx, t->nx);
    t->ny = sel(corner, ny, t->ny);
    t->px[0] = sel(corner, n.ax + nx * out, t->px[0]);
    t->py[0] = sel(corner, n.ay + ny * out, t->py[0]);
    t->sep[0] = sel(corner, sep, t->sep[0]);
    t->sep[1] = sel(corner, splat(PL_APART), t->sep[1]);
    t->feature[0] = selm(corner, t->feature[0] | (pl_lane)PL_CONVEX_CORNERS, t->feature[0]);
    t->turns = selm(corner, (vm){ 0 } + PL_MET_TURNS_MID, t->turns);
}

// `flip_out` and `face_out`: which side has the reference face, and its edge.
WIDE_PART void meet_outlines(touch *t, const lanes *l, const outline *a, const outline *b,
                             vm *flip_out, vm *face_out)
{
    vf zero = splat(0), half = splat((near_real)0.5);
    best_face fa = find_face(a, b);
    best_face fb = find_face(b, a);
    vm flip = fb.separation > fa.separation + splat(PREFER_A);
    vf nx = sel(flip, fb.nx, fa.nx), ny = sel(flip, fb.ny, fa.ny);
    vm face = selm(flip, fb.index, fa.index);
    vm edge = incident_edge(a, b, flip, nx, ny);
    vf r[4] = { zero, zero, zero, zero }, w[4] = { zero, zero, zero, zero };
    edge_pick(a, face, ~flip, r);
    edge_pick(b, face, flip, r);
    edge_pick(b, edge, ~flip, w);
    edge_pick(a, edge, flip, w);

    // Face frame: u along the normal from r0, v along the face; the incident edge runs against v.
    vf face_v = (r[3] - r[1]) * nx - (r[2] - r[0]) * ny; // length of the face
    vf pu = (w[2] - r[0]) * nx + (w[3] - r[1]) * ny;
    vf pv = (w[3] - r[1]) * nx - (w[2] - r[0]) * ny;
    vf qu = (w[0] - r[0]) * nx + (w[1] - r[1]) * ny;
    vf qv = (w[1] - r[1]) * nx - (w[0] - r[0]) * ny;
    vf run = qv - pv;
    vm flat = run > splat((near_real)1e-6);
    vf slope = sel(flat, (qu - pu) / sel(flat, run, splat(1)), zero);
    vf low = vmax(pv, zero);
    vf high = vmin(qv, face_v);
    vf low_u = pu + slope * (low - pv);
    vf high_u = qu + slope * (high - qv);
    // No common stretch, or an edge that stands on its corner: the deepest corner alone.
    vm beside = (low > high) | ~flat;
    vm p_deeper = pu < qu;
    vf cut = sel(beside, zero, sel(p_deeper, low_u - pu, high_u - qu));
    vf corner_v = sel(p_deeper, pv, qv);
    vf corner_u = sel(p_deeper, pu, qu);
    low = sel(beside, corner_v, low);
    low_u = sel(beside, corner_u, low_u);

    vf ref_radius = sel(flip, l->br, l->ar);
    vf inc_radius = sel(flip, l->ar, l->br);
    vf radii = ref_radius + inc_radius;
    t->sep[0] = low_u - radii;
    t->sep[1] = sel(beside, splat(PL_APART), high_u - radii);
    vf u0 = half * (low_u + ref_radius - inc_radius);
    vf u1 = half * (high_u + ref_radius - inc_radius);
    t->px[0] = r[0] + nx * u0 - ny * low;
    t->py[0] = r[1] + ny * u0 + nx * low;
    t->px[1] = r[0] + nx * u1 - ny * high;
    t->py[1] = r[1] + ny * u1 + nx * high;
    t->nx = sel(flip, -nx, nx);
    t->ny = sel(flip, -ny, ny);
    vm code = PL_CONVEX_FEATURE(face, edge) | (flip & (pl_lane)PL_CONVEX_OF_B);
    t->feature[0] = code;
    t->feature[1] = code | 1;
    t->turns = selm(flip, (vm){ 0 } + PL_MET_TURNS_B, (vm){ 0 } + PL_MET_TURNS_A);
    vm lies_flat = ~beside & (vabs(slope) < splat(FLAT_SLOPE));
    round_corners(t, l, a, b, r, w, sel(flip, fb.separation, fa.separation),
                  sel(flip, fa.separation, fb.separation), cut, lies_flat, p_deeper);
    *flip_out = flip;
    *face_out = face;
}

WIDE_PART void convex_convex(touch *t, const lanes *l, const pl_narrow_input *in, const outline *a,
                             vm *flip, vm *face)
{
    outline b;
    outline_gather(&b, in, l, true);
    meet_outlines(t, l, a, &b, flip, face);
}

// The circle is a core of one corner: faces of B alone, then the corners of the best face.
WIDE_PART void circle_convex(touch *t, const lanes *l, const pl_narrow_input *in, int kind_b)
{
    (void)kind_b;
    outline b;
    vf zero = splat(0);
    outline_gather(&b, in, l, true);
    best_face best = { splat(-PL_APART), zero, zero, (vm){ 0 } };
    for (int i = 0; i < b.count; ++i) {
        vf along = -(b.x[i] * b.nx[i] + b.y[i] * b.ny[i]);
        vm better = along > best.separation;
        best.separation = sel(better, along, best.separation);
        best.nx = sel(better, b.nx[i], best.nx);
        best.ny = sel(better, b.ny[i], best.ny);
        best.index = selm(better, (vm)splat(0) + i, best.index);
    }
    vf e[4] = { zero, zero, zero, zero }, qx, qy;
    edge_pick(&b, best.index, ~(vm){ 0 }, e);
    vf distance = vsqrt(segment_distance(zero, zero, e, &qx, &qy));
    // Before a corner the connection is longer than the way to the face.
    vm corner = distance > best.separation * splat((near_real)1.000002) + splat((near_real)1e-6);
    vm apart = (best.separation > zero) & (distance > splat((near_real)1e-9));
    vf inv = splat(1) / sel(apart, distance, splat(1));
    t->nx = sel(apart, qx * inv, -best.nx);
    t->ny = sel(apart, qy * inv, -best.ny);
    t->sep[0] = sel(apart, distance, best.separation) - l->ar - l->br;
    vf out = l->ar + t->sep[0] * splat((near_real)0.5);
    t->px[0] = t->nx * out;
    t->py[0] = t->ny * out;
    t->px[1] = t->py[1] = zero;
    t->sep[1] = splat(PL_APART);
    t->feature[0] = t->feature[1] = (vm){ 0 };
    t->turns = selm(apart & corner, (vm){ 0 } + PL_MET_TURNS_MID, (vm){ 0 } + PL_MET_TURNS_B);
}

//---- pairs that were apart -----------------------------------------------------------------------

// Most pairs whose fat boxes overlap are apart, and the face that parted them in the last step does
// so in this one. Such a pair is done with after one face instead of all. The test asks for more room
// than any look-ahead of lanes_emit: what it dismisses would get no manifold.
enum { chunk = 64 };

static void remember_face(const lanes *l, const pl_narrow_input *in, uint32_t count, vm flip,
                          vm face)
{
    for (uint32_t i = 0; i < count; ++i) {
        pl_pair *pair = &in->pairs[l->pair[i]];
        uint32_t code = 0;
        if (pair->manifold == PL_NONE) {
            code = 1 + 2 * (uint32_t)face[i] + (flip[i] ? 1 : 0);
        }
        pair->flags = (pair->flags & ~PL_PAIR_FACE_MASK) | code << PL_PAIR_FACE_SHIFT;
    }
}

// [m/s] at most, by which the turning of A and B brings points of theirs together.
WIDE_INLINE vf corner_speeds(const lanes *l, const pl_narrow_input *in)
{
    if (in->w == NULL) {
        return splat(0);
    }
    near_real speeds[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        const uint32_t a = in->pairs[l->pair[i]].body_a, b = in->pairs[l->pair[i]].body_b;
        speeds[i] =
            (near_real)(plumb_abs(in->w[a]) * in->extent[a] + plumb_abs(in->w[b]) * in->extent[b]);
    }
    return load(speeds);
}

// Lanes whose remembered face still parts them.
static inline vm parted(const lanes *l, const pl_narrow_input *in)
{
    const pl_vertex *corner[PL_WIDTH];
    const plumb_real *row[PL_WIDTH], *center[PL_WIDTH], *other_center[PL_WIDTH];
    uint32_t count[PL_WIDTH];
    uint32_t most = 0;
    vm of_b = (vm){ 0 };
    for (int i = 0; i < PL_WIDTH; ++i) {
        uint32_t code = (in->pairs[l->pair[i]].flags & PL_PAIR_FACE_MASK) >> PL_PAIR_FACE_SHIFT;
        bool flip = ((code - 1) & 1) != 0;
        uint32_t ref = flip ? l->b[i] : l->a[i], other = flip ? l->a[i] : l->b[i];
        // A slot may hold another piece by now: any face of it will do.
        uint32_t edge = (code - 1) >> 1, edges = in->vertex_count[ref];
        row[i] = &in->vertices[in->vertex_first[ref] + (edge < edges ? edge : 0)].x;
        center[i] = &in->cores[ref].x;
        corner[i] = in->vertices + in->vertex_first[other];
        other_center[i] = &in->cores[other].x;
        count[i] = in->vertex_count[other];
        most = count[i] > most ? count[i] : most;
        of_b[i] = flip ? -1 : 0;
    }
    // The face in world axes about A's core centre, then in the other body's frame.
    vf zero = splat(0);
    vf rc = sel(of_b, l->pbc, l->pac), rs = sel(of_b, l->pbs, l->pas);
    vf oc = sel(of_b, l->pac, l->pbc), os = sel(of_b, l->pas, l->pbs);
    vf face[4];
    gather4_from(face, row, center, sel(of_b, l->bcx, l->acx), sel(of_b, l->bcy, l->acy));
    vf fx = sel(of_b, l->dx, zero) + (rc * face[0] - rs * face[1]);
    vf fy = sel(of_b, l->dy, zero) + (rs * face[0] + rc * face[1]);
    vf nx = rc * face[2] - rs * face[3], ny = rs * face[2] + rc * face[3];
    vf to_x = sel(of_b, zero, l->dx) - fx, to_y = sel(of_b, zero, l->dy) - fy;
    vf mx = oc * nx + os * ny, my = oc * ny - os * nx;
    vf from = to_x * nx + to_y * ny;
    if (!PLUMB_IS_FAR) { // corners are seen from the body's origin, which in the far build may be far away
        from -= sel(of_b, l->acx, l->bcx) * mx + sel(of_b, l->acy, l->bcy) * my;
    }
    vf least = splat(PL_APART);
    for (uint32_t k = 0; k < most; ++k) {
        for (int i = 0; i < PL_WIDTH; ++i) {
            row[i] = &corner[i][k < count[i] ? k : count[i] - 1].x;
        }
        vf v[4];
        if (PLUMB_IS_FAR) {
            gather4_from(v, row, other_center, zero, zero);
        } else {
            gather4_far(v, row, 0);
        }
        least = vmin(least, v[0] * mx + v[1] * my);
    }
    const vf dt = splat(in->dt), way = vsqrt(l->vx * l->vx + l->vy * l->vy) * dt;
    const vf spin = corner_speeds(l, in) * dt + splat(PL_BESIDE_SPIN);
    return from + least - l->ar - l->br > vmax(splat(PL_SPECULATIVE), spin) + way;
}

// Which of the `count` <= 64 pairs from `first` are still parted by their remembered face: a bit each.
static uint64_t find_parted(const pl_narrow_input *in, uint32_t first, uint32_t count)
{
    uint32_t places[chunk];
    uint32_t tried = 0;
    for (uint32_t i = 0; i < count; ++i) {
        places[tried] = first + i;
        tried += (in->pairs[first + i].flags & PL_PAIR_FACE_MASK) != 0 ? 1 : 0;
    }
    uint64_t bits = 0;
    for (uint32_t i = 0; i < tried; i += PL_WIDTH) {
        uint32_t n = tried - i < PL_WIDTH ? tried - i : PL_WIDTH;
        lanes l;
        lanes_gather(&l, in, places + i, n);
        vm apart = parted(&l, in);
        for (uint32_t j = 0; j < n; ++j) {
            bits |= (uint64_t)(apart[j] & 1) << (l.pair[j] - first);
        }
    }
    return bits;
}

static __attribute__((noinline)) void look_closely(const pl_narrow_input *in,
                                                   const uint32_t *places, uint32_t count,
                                                   pl_narrow *out)
{
    lanes l;
    touch t;
    vm flip, face;
    outline a;
    lanes_gather(&l, in, places, count);
    outline_gather(&a, in, &l, false);
    convex_convex(&t, &l, in, &a, &flip, &face);
    lanes_emit(&l, &t, in, count, out);
    remember_face(&l, in, count, flip, face);
}

// In order of pairs, so that the order of manifolds does not depend on the width.
pl_narrow_kernel PL_WIDE_NAME(pl_convex_convex);
void PL_WIDE_NAME(pl_convex_convex)(const pl_narrow_input *in, uint32_t first, uint32_t count,
                                    int kind_b, pl_narrow *out)
{
    (void)kind_b;
    uint32_t waiting[chunk + PL_WIDTH];
    uint32_t held = 0;
    for (uint32_t i = 0; i < count; i += chunk) {
        uint32_t n = count - i < chunk ? count - i : chunk;
        uint64_t apart = find_parted(in, first + i, n);
        for (uint32_t j = 0; j < n; ++j) {
            if ((apart >> j & 1) != 0) {
                part(&in->pairs[first + i + j]);
            } else {
                waiting[held++] = first + i + j;
            }
        }
        // Full lanes; behind the last chunk what is left. One call, which is compiled once.
        const uint32_t least = i + n < count ? PL_WIDTH : 1;
        uint32_t done = 0;
        while (held - done >= least) {
            const uint32_t next = held - done < PL_WIDTH ? held - done : PL_WIDTH;
            look_closely(in, waiting + done, next, out);
            done += next;
        }
        memmove(waiting, waiting + done, (held - done) * sizeof waiting[0]);
        held -= done;
    }
}

DEFINE_KERNEL(circle_convex)
