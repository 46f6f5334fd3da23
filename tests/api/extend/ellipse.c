// ellipse.c - the corners of an ellipse; for src/api/shape_make.c.
static plumb_result make_ellipse(const plumb_shape_desc *d, plumb_convex *convex)
{
    const plumb_rot q = plumb_rot_make(d->angle);
    plumb_vec2 points[PLUMB_POLYGON_MAX_VERTICES];
    for (int i = 0; i < PLUMB_POLYGON_MAX_VERTICES; ++i) {
        const real part = ((real)i + (real)0.5) / PLUMB_POLYGON_MAX_VERTICES;
        const plumb_rot at = plumb_rot_make(PLUMB_REAL(6.283185307179586) * part);
        const plumb_vec2 corner = { d->half.x * at.c, d->half.y * at.s };
        points[i] = plumb_vec2_add(d->center, plumb_rot_apply(q, corner));
    }
    return plumb_convex_polygon(points, PLUMB_POLYGON_MAX_VERTICES, 0, convex);
}

