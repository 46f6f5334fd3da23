// boxes.simd.c - box against box: separating axes, then the incident edge clipped to the reference
// face.
//
// The test is (v - a) . n > 0 for the four face normals n: the boxes are apart when some face has
// all corners of the other box in front. The face that separates most (or overlaps least) is the
// reference face; in its frame, normal along +u and face along v, the nearest edge of the other box
// is clipped to |v| <= half the face; where nothing of it is left, and the boxes are apart, their
// nearest corners serve. Symbols: h half extents, q = (c, s) rotations, d centre of the incident
// box. Cost: about 270 flops a pair, W pairs at a time, no branches.
#include "narrow/lanes.h"

// The reference face changes side only for a gain of this much, so that it does not flicker. [m]
#define PREFER_A ((near_real)5e-4)

typedef struct face_frame {
    vf c, s;     // rotation whose x axis is the face normal, world
    vf hu, hv;   // half extents of the reference box along normal and face
    vf du, dv;   // centre of the incident box in the frame
    vf ic, is;   // rotation of the incident box relative to the frame
    vf ihx, ihy; // its half extents
    vm flip;     // the reference box is B
    vm code;     // which face
} face_frame;

// Chooses the reference face and expresses everything in its frame.
WIDE_INLINE void choose_face(face_frame *f, const lanes *l)
{
    vf zero = splat(0), one = splat(1);
    // B relative to A: rotation r, centre in A's frame and in B's frame.
    vf rc = l->ac * l->bc + l->as * l->bs;
    vf rs = l->ac * l->bs - l->as * l->bc;
    vf arc = vabs(rc), ars = vabs(rs);
    vf ax = l->ac * l->dx + l->as * l->dy;
    vf ay = l->ac * l->dy - l->as * l->dx;
    vf bx = l->bc * l->dx + l->bs * l->dy;
    vf by = l->bc * l->dy - l->bs * l->dx;
    vf sax = vabs(ax) - l->ahx - (arc * l->bhx + ars * l->bhy);
    vf say = vabs(ay) - l->ahy - (ars * l->bhx + arc * l->bhy);
    vf sbx = vabs(bx) - l->bhx - (arc * l->ahx + ars * l->ahy);
    vf sby = vabs(by) - l->bhy - (ars * l->ahx + arc * l->ahy);
    vm a_is_x = sax >= say;
    vm b_is_x = sbx >= sby;
    vf sa = sel(a_is_x, sax, say);
    vf sb = sel(b_is_x, sbx, sby);
    f->flip = sb > sa + splat(PREFER_A);

    vm is_x = selm(f->flip, b_is_x, a_is_x);
    vf hx = sel(f->flip, l->bhx, l->ahx);
    vf hy = sel(f->flip, l->bhy, l->ahy);
    f->ihx = sel(f->flip, l->ahx, l->bhx);
    f->ihy = sel(f->flip, l->ahy, l->bhy);
    f->hu = sel(is_x, hx, hy);
    f->hv = sel(is_x, hy, hx);
    vf x = sel(f->flip, -bx, ax); // incident centre in the reference box's frame
    vf y = sel(f->flip, -by, ay);
    vf along = sel(is_x, x, y);
    vf sign = sel(along < zero, -one, one);
    // Normal: +-x or +-y of the reference box, as a rotation (fc, fs) within its frame.
    vf fc = sel(is_x, sign, zero);
    vf fs = sel(is_x, zero, sign);
    f->du = fc * x + fs * y;
    f->dv = fc * y - fs * x;
    vf is0 = sel(f->flip, -rs, rs);
    f->ic = fc * rc + fs * is0;
    f->is = fc * is0 - fs * rc;
    vf qc = sel(f->flip, l->bc, l->ac);
    vf qs = sel(f->flip, l->bs, l->as);
    f->c = qc * fc - qs * fs;
    f->s = qs * fc + qc * fs;
    vm two = (vm)splat(0) + 2, four = two + 2, eight = four + 4;
    f->code = (two & ~is_x) | (four & (sign < zero)) | (eight & f->flip);
}

WIDE_INLINE void box_box(touch *t, const lanes *l, const pl_narrow_input *in, int kind_b)
{
    (void)in, (void)kind_b;
    face_frame f;
    choose_face(&f, l);
    vf zero = splat(0), one = splat(1), half = splat((near_real)0.5);
    // Incident face: the normal most against +u is -+x = -+(ic, is) or -+y = -+(-is, ic).
    vm by_x = vabs(f.ic) >= vabs(f.is);
    vf dot = sel(by_x, f.ic, -f.is);
    vf sign = sel(dot > zero, -one, one);
    vf nu = sign * sel(by_x, f.ic, -f.is); // that normal
    vf nv = sign * sel(by_x, f.is, f.ic);
    vf depth = sel(by_x, f.ihx, f.ihy);
    vf length = sel(by_x, f.ihy, f.ihx);
    // Its edge runs along (nv, -nu), which climbs in v since nu < 0; low end P, high end Q.
    vf mu = f.du + nu * depth;
    vf mv = f.dv + nv * depth;
    vf pu = mu - nv * length, pv = mv + nu * length;
    vf qu = mu + nv * length, qv = mv - nu * length;
    vf slope = (qu - pu) / (qv - pv); // the edge is within 45 degrees of the face: never 0 / 0
    vf low = vmax(pv, -f.hv);
    vf high = vmin(qv, f.hv);
    vf low_u = pu + slope * (low - pv);
    vf high_u = qu + slope * (high - qv);
    // The edge passes beside the face: an overlapping box touches with its deepest corner; of boxes that are apart the ends of edge
    // and face are the nearest corners. These only lie ahead (narrow/ahead.c judges them by the flight): a plane between near
    // corners would hold a brick out of a slot that it fits.
    vm beside = low > high;
    vm p_deeper = pu < qu;
    vm above = pv > f.hv;
    vf end_u = sel(above, pu, qu), end_v = sel(above, pv, qv), face_v = sel(above, f.hv, -f.hv);
    low = sel(beside, sel(p_deeper, pv, qv), low);
    low_u = sel(beside, sel(p_deeper, pu, qu), low_u);
    vf sep0 = low_u - f.hu;
    vf sep1 = high_u - f.hu;
    vm corners = beside & (sep0 > zero);
    vf wide_u = end_u - f.hu, wide_v = end_v - face_v;
    vf distance = sel(corners, vsqrt(wide_u * wide_u + wide_v * wide_v), one);
    vf out_u = sel(corners, wide_u / distance, one); // the normal in the frame
    vf out_v = sel(corners, wide_v / distance, zero);
    t->sep[0] =
        sel(corners, sel(distance > splat(PL_SPECULATIVE), distance, splat(PL_APART)), sep0);
    t->sep[1] = sel(beside, splat(PL_APART), sep1);

    vf sign_ab = sel(f.flip, -one, one);
    t->nx = sign_ab * (f.c * out_u - f.s * out_v);
    t->ny = sign_ab * (f.s * out_u + f.c * out_v);
    vf u0 = sel(corners, half * (end_u + f.hu), half * (low_u + f.hu));
    vf v0 = sel(corners, half * (end_v + face_v), low);
    vf u1 = half * (high_u + f.hu);
    // Back to world axes; the frame's origin is the reference box's centre.
    vf ox = sel(f.flip, l->dx, zero);
    vf oy = sel(f.flip, l->dy, zero);
    t->px[0] = ox + f.c * u0 - f.s * v0;
    t->py[0] = oy + f.s * u0 + f.c * v0;
    t->px[1] = ox + f.c * u1 - f.s * high;
    t->py[1] = oy + f.s * u1 + f.c * high;
    vm sixteen = (vm)splat(0) + 16;
    vm face = f.code | (sixteen & by_x) | ((sixteen + sixteen) & (sign < zero));
    t->feature[0] = face;
    t->feature[1] = face + 1;
    vm on_face = selm(f.flip, (vm){ 0 } + PL_MET_TURNS_B, (vm){ 0 } + PL_MET_TURNS_A);
    t->turns = selm(corners, (vm){ 0 } + PL_MET_TURNS_MID, on_face);
}

DEFINE_KERNEL(box_box)
