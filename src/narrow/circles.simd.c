// circles.simd.c - a circle against a circle, a capsule, a box: nearest point, one contact.
//
// Cost: about 100 flops a pair, W pairs at a time.
#include "narrow/lanes.h"

// Turns "nearest point of B's core at (qx, qy), at distance `distance`" into a one-point contact.
WIDE_INLINE void touch_point(touch *t, const lanes *l, vf nx, vf ny, vf distance)
{
    t->nx = nx;
    t->ny = ny;
    t->sep[0] = distance - l->ar - l->br;
    vf along = l->ar + t->sep[0] * splat((near_real)0.5);
    t->px[0] = nx * along;
    t->py[0] = ny * along;
    t->px[1] = t->py[1] = splat(0);
    t->sep[1] = splat(PL_APART);
    t->feature[0] = t->feature[1] = (vm){ 0 };
    t->turns = (vm){ 0 } + PL_MET_TURNS_MID;
}

// Unit vector of (x, y); where that is too short, (fx, fy).
WIDE_INLINE vf unit(vf x, vf y, vf fx, vf fy, vf *nx, vf *ny)
{
    vf length = vsqrt(x * x + y * y);
    vm ok = length > splat((near_real)1e-9);
    vf divisor = sel(ok, length, splat(1)); // division, not its inverse times: exact along the axes
    *nx = sel(ok, x / divisor, fx);
    *ny = sel(ok, y / divisor, fy);
    return length;
}

WIDE_INLINE void circle_circle(touch *t, const lanes *l)
{
    vf nx, ny;
    vf distance = unit(l->dx, l->dy, splat(0), splat(1), &nx, &ny);
    touch_point(t, l, nx, ny, distance);
}

WIDE_INLINE void circle_capsule(touch *t, const lanes *l)
{
    vf at = -(l->dx * l->bc + l->dy * l->bs);
    vf along = vclamp(at, -l->bhx, l->bhx);
    vf qx = l->dx + l->bc * along;
    vf qy = l->dy + l->bs * along;
    vf nx, ny;
    vf distance = unit(qx, qy, -l->bs, l->bc, &nx, &ny);
    touch_point(t, l, nx, ny, distance);
    t->turns = selm(along == at, (vm){ 0 } + PL_MET_TURNS_B, t->turns);
}

// The circle's centre in the box's frame: outside, the nearest point by clamping; inside, the face
// of least depth.
WIDE_INLINE void circle_box(touch *t, const lanes *l)
{
    vf zero = splat(0), one = splat(1);
    vf cx = -(l->dx * l->bc + l->dy * l->bs);
    vf cy = -(l->dy * l->bc - l->dx * l->bs);
    vf ex = cx - vclamp(cx, -l->bhx, l->bhx); // from the nearest point to the centre
    vf ey = cy - vclamp(cy, -l->bhy, l->bhy);
    vf signx = sel(cx < zero, -one, one);
    vf signy = sel(cy < zero, -one, one);
    vf depth_x = l->bhx - vabs(cx);
    vf depth_y = l->bhy - vabs(cy);
    vm by_x = depth_x < depth_y;
    vf ux, uy;
    vf distance = unit(ex, ey, zero, one, &ux, &uy);
    vm inside = (depth_x > zero) & (depth_y > zero);
    vm surface = ~inside & (distance <= splat((near_real)1e-9)); // exactly on a face
    vm face = inside | surface;
    ux = sel(face, sel(by_x, signx, zero), ux);
    uy = sel(face, sel(by_x, zero, signy), uy);
    distance = sel(face, -sel(by_x, depth_x, depth_y), distance);
    // u points from the box to the circle; the normal from A (circle) to B (box).
    touch_point(t, l, -(ux * l->bc - uy * l->bs), -(ux * l->bs + uy * l->bc), distance);
    const vm corner = ~face & (depth_x < zero) & (depth_y < zero);
    t->turns = selm(corner, t->turns, (vm){ 0 } + PL_MET_TURNS_B);
}

// The three share what is around them, which is most of a kernel's code.
WIDE_INLINE void circle(touch *t, const lanes *l, const pl_narrow_input *in, int kind_b)
{
    (void)in;
    if (kind_b == PL_PIECE_CIRCLE) {
        circle_circle(t, l);
    } else if (kind_b == PL_PIECE_CAPSULE) {
        circle_capsule(t, l);
    } else {
        circle_box(t, l);
    }
}

DEFINE_KERNEL(circle)
