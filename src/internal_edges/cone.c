// cone.c - intersections of sets of normals. See README.md for what they mean.
//
// Every set here is an arc of at most half a turn, or the two ends of one. Two arcs meet in one arc,
// except two opposite half circles (a straight chain of lines), which meet in their ends.
#include "internal_edges/cone.h"

#include <stddef.h>

typedef struct direction {
    double x, y;
} direction;

static bool agree(direction a, direction b, double angle)
{
    return pl_directions_agree(a.x, a.y, b.x, b.y, angle);
}

static double cross(direction a, direction b)
{
    return a.x * b.y - a.y * b.x;
}

static double dot(direction a, direction b)
{
    return a.x * b.x + a.y * b.y;
}

static direction lo_of(const pl_cone *c)
{
    return (direction){ c->lo_x, c->lo_y };
}

static direction hi_of(const pl_cone *c)
{
    return (direction){ c->hi_x, c->hi_y };
}

static pl_cone cone_of(pl_cone_form form, direction lo, direction hi)
{
    return (pl_cone){ lo.x, lo.y, hi.x, hi.y, form };
}

static bool allows(const pl_cone *c, direction n, double angle)
{
    direction lo = lo_of(c), hi = hi_of(c);
    switch (c->form) {
    case PL_CONE_ARC:
        // Left of lo and right of hi also holds opposite an arc of no width.
        return cross(lo, n) >= -angle && cross(n, hi) >= -angle &&
               (dot(n, lo) > -1e-6 || dot(n, hi) > -1e-6);
    case PL_CONE_ENDS:
        return agree(lo, n, angle) || agree(hi, n, angle);
    default:
        return false;
    }
}

bool pl_cone_contains(const pl_cone *cone, double x, double y, double angle)
{
    return allows(cone, (direction){ x, y }, angle);
}

// The ends of `own` that `other` has.
static pl_cone keep_ends(const pl_cone *own, const pl_cone *other, double angle)
{
    bool lo = allows(other, lo_of(own), angle), hi = allows(other, hi_of(own), angle);
    if (lo && hi) {
        return *own;
    }
    if (!lo && !hi) {
        return (pl_cone){ 0 };
    }
    direction left = lo ? lo_of(own) : hi_of(own);
    return cone_of(PL_CONE_ARC, left, left);
}

static direction snap(direction d, const pl_cone *own, double angle)
{
    return agree(d, lo_of(own), angle) ? lo_of(own) : agree(d, hi_of(own), angle) ? hi_of(own) : d;
}

static pl_cone meet_arcs(const pl_cone *own, const pl_cone *other, double angle)
{
    const double rounding = 1e-12;
    direction a = lo_of(own), b = hi_of(own);
    direction c = snap(lo_of(other), own, angle), d = snap(hi_of(other), own, angle);
    pl_cone snapped = cone_of(PL_CONE_ARC, c, d);
    if (agree(b, c, rounding) && agree(d, a, rounding) && !agree(a, b, angle)) {
        return cone_of(PL_CONE_ENDS, a, b);
    }
    direction lo = c, hi = d;
    if (!allows(own, c, rounding)) {
        if (!allows(&snapped, a, rounding)) {
            return (pl_cone){ 0 };
        }
        lo = a;
    }
    if (!allows(own, d, rounding)) {
        if (!allows(&snapped, b, rounding)) {
            return (pl_cone){ 0 };
        }
        hi = b;
    }
    return cone_of(PL_CONE_ARC, lo, hi);
}

pl_cone pl_cone_meet(const pl_cone *own, const pl_cone *other, double angle)
{
    if (own->form == PL_CONE_NONE || other->form == PL_CONE_NONE) {
        return (pl_cone){ 0 };
    }
    if (own->form == PL_CONE_ENDS) {
        return keep_ends(own, other, angle);
    }
    if (other->form == PL_CONE_ARC) {
        return meet_arcs(own, other, angle);
    }
    pl_cone ends =
        cone_of(PL_CONE_ENDS, snap(lo_of(other), own, angle), snap(hi_of(other), own, angle));
    return keep_ends(&ends, own, 1e-12);
}
