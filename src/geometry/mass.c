// mass.c - mass, centre and moment of inertia of flat shapes, exactly.
//
// A shape is cut into parts whose moments about a reference point are known in closed form, the
// moments are added in double, and the centre and the inertia about it follow at the end. The
// reference lies on the shape, so nothing is lost far from the origin.
//
// Symbols: A area, S = integral of r dA, J = integral of r^2 dA, r from the reference.
//   triangle (0, a, b):  A = a x b / 2,  S = A (a + b) / 3,  J = A (a^2 + a.b + b^2) / 6
//   rectangle l x w about its own centre:  A = l w,  J = A (l^2 + w^2) / 12
//   circular sector of angle t, from the unit vector n to m, about its apex:
//                        A = R^2 t / 2,  S = R^3 / 3 (m_y - n_y, n_x - m_x),  J = R^4 t / 4
//     (S: the integral of (cos, sin) from the angle of n to that of m, times that of r^2 dr)
//   moved by p:          S' = S + A p,   J' = J + 2 p.S + A p^2
// Steiner's (parallel axis) theorem: I = J - A c^2 with c = S / A. Triangle and shoelace sums:
// e.g. Bourke, "Calculating the area and centroid of a polygon" (1988); the rest is integration.
//
// Reads: arguments. Writes: the answer. Cost: O(vertices), one arc tangent a rounded corner.

#include "geometry/exact.h"
#include "math/trig.h"

// The double nearest to pi: sector angles of a shape sum to 2 pi.
#define PI 3.141592653589793

typedef struct vec {
    double x;
    double y;
} vec;

typedef struct moments {
    double area;
    vec first;     // S
    double second; // J
} moments;

static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y;
}

static double cross(vec a, vec b)
{
    return a.x * b.y - a.y * b.x;
}

// A point relative to the reference.
static vec from(plumb_vec2 reference, plumb_vec2 point)
{
    vec r = { (double)point.x - (double)reference.x, (double)point.y - (double)reference.y };
    return r;
}

// Adds a part whose moments are about the point p.
static void add_part(moments *sum, moments part, vec p)
{
    sum->area += part.area;
    sum->first.x += part.first.x + part.area * p.x;
    sum->first.y += part.first.y + part.area * p.y;
    sum->second += part.second + 2 * dot(p, part.first) + part.area * dot(p, p);
}

// The polygon as triangles from its first vertex, which is the reference; signed.
static moments polygon_moments(const plumb_vec2 *points, int count)
{
    moments sum = { 0, { 0, 0 }, 0 };
    for (int i = 1; i + 1 < count; i++) {
        vec a = from(points[0], points[i]);
        vec b = from(points[0], points[i + 1]);
        double area = cross(a, b) / 2;
        sum.area += area;
        sum.first.x += area * (a.x + b.x) / 3;
        sum.first.y += area * (a.y + b.y) / 3;
        sum.second += area * (dot(a, a) + dot(a, b) + dot(b, b)) / 6;
    }
    return sum;
}

static double length_of(vec v)
{
    return sqrt(dot(v, v));
}

// Outward unit normal of the edge from a to b, whose length is l > 0.
static vec outward(vec a, vec b, double l)
{
    vec n = { (b.y - a.y) / l, (a.x - b.x) / l };
    return n;
}

// Adds the strip of width w along the outside of an edge.
static void add_strip(moments *sum, vec a, vec b, double w)
{
    double l = length_of((vec){ b.x - a.x, b.y - a.y });
    vec n = outward(a, b, l);
    vec middle = { (a.x + b.x + n.x * w) / 2, (a.y + b.y + n.y * w) / 2 };
    moments strip = { l * w, { 0, 0 }, l * w * (l * l + w * w) / 12 };
    add_part(sum, strip, middle);
}

// Adds the sector about vertex b between the normals of the edges a b and b c.
static void add_sector(moments *sum, vec a, vec b, vec c, double radius)
{
    vec n = outward(a, b, length_of((vec){ b.x - a.x, b.y - a.y }));
    vec m = outward(b, c, length_of((vec){ c.x - b.x, c.y - b.y }));
    double turn = pl_atan2(cross(n, m), dot(n, m));
    // The end of a capsule turns by pi, which rounding may have made -pi.
    turn = turn < 0 && dot(n, m) < 0 ? turn + 2 * PI : turn;
    double r2 = radius * radius;
    double k = r2 * radius / 3;
    moments sector = { r2 * turn / 2, { k * (m.y - n.y), k * (n.x - m.x) }, r2 * r2 * turn / 4 };
    add_part(sum, sector, b);
}

// Mass properties from moments about the reference; `center` serves when there is no area.
static plumb_mass_properties from_moments(moments sum, plumb_vec2 reference, double density,
                                          plumb_vec2 center)
{
    plumb_mass_properties out = { 0, center, 0 };
    if (sum.area > 0) {
        vec c = { sum.first.x / sum.area, sum.first.y / sum.area };
        out.mass = (plumb_real)(density * sum.area);
        out.center.x = (plumb_real)((double)reference.x + c.x);
        out.center.y = (plumb_real)((double)reference.y + c.y);
        out.inertia = (plumb_real)(density * (sum.second - sum.area * dot(c, c)));
    }
    return out;
}

static plumb_vec2 mean_of(const plumb_vec2 *points, int count)
{
    double x = 0;
    double y = 0;
    for (int i = 0; i < count; i++) {
        x += (double)points[i].x;
        y += (double)points[i].y;
    }
    return plumb_v2((plumb_real)(x / count), (plumb_real)(y / count));
}

plumb_mass_properties plumb_circle_mass(plumb_vec2 center, plumb_real radius, plumb_real density)
{
    double r2 = (double)radius * (double)radius;
    double mass = PI * r2 * (double)density;
    plumb_mass_properties out = { (plumb_real)mass, center, (plumb_real)(mass * r2 / 2) };
    return out;
}

// The middle rectangle of length l and width 2 r, and two half discs at l / 2 from the centre. A
// half disc has S = 2 r^3 / 3 = A 4 r / (3 pi) away from its flat side, hence
// J = m_d (r^2 / 2 + l^2 / 4 + l 4 r / (3 pi)) for both, m_d being the mass of the whole disc.
plumb_mass_properties plumb_capsule_mass(plumb_vec2 a, plumb_vec2 b, plumb_real radius,
                                         plumb_real density)
{
    plumb_vec2 ends[2] = { a, b };
    double r = (double)radius;
    double l = pl_distance(a, b);
    double middle = 2 * r * l * (double)density;
    double discs = PI * r * r * (double)density;
    double inertia =
        middle * (l * l + 4 * r * r) / 12 + discs * (r * r / 2 + l * l / 4 + 4 * l * r / (3 * PI));
    plumb_mass_properties out = { (plumb_real)(middle + discs), mean_of(ends, 2),
                                  (plumb_real)inertia };
    return out;
}

plumb_mass_properties plumb_convex_mass(const plumb_convex *shape, plumb_real density)
{
    const plumb_vec2 *p = shape->points;
    int n = shape->count;
    if (n == 1) {
        return plumb_circle_mass(p[0], shape->radius, density);
    }
    if (n == 2) {
        return plumb_capsule_mass(p[0], p[1], shape->radius, density);
    }
    moments sum = polygon_moments(p, n);
    for (int i = 0; shape->radius > 0 && i < n; i++) {
        vec a = from(p[0], p[i]);
        vec b = from(p[0], p[(i + 1) % n]);
        vec c = from(p[0], p[(i + 2) % n]);
        add_strip(&sum, a, b, (double)shape->radius);
        add_sector(&sum, a, b, c, (double)shape->radius);
    }
    return from_moments(sum, p[0], (double)density, mean_of(p, n));
}

plumb_mass_properties plumb_outline_mass(const plumb_vec2 *points, int count, plumb_real density)
{
    moments sum = polygon_moments(points, count);
    if (sum.area < 0) { // clockwise: every moment has the other sign
        sum.area = -sum.area;
        sum.first.x = -sum.first.x;
        sum.first.y = -sum.first.y;
        sum.second = -sum.second;
    }
    return from_moments(sum, points[0], (double)density, mean_of(points, count));
}

plumb_mass_properties plumb_mass_combine(const plumb_mass_properties *parts, int count)
{
    plumb_mass_properties out = { 0, { 0, 0 }, 0 };
    double mass = 0;
    double x = 0;
    double y = 0;
    double even_x = 0;
    double even_y = 0;
    for (int i = 0; i < count; i++) {
        mass += (double)parts[i].mass;
        x += (double)parts[i].mass * (double)parts[i].center.x;
        y += (double)parts[i].mass * (double)parts[i].center.y;
        even_x += (double)parts[i].center.x / count;
        even_y += (double)parts[i].center.y / count;
    }
    x = mass > 0 ? x / mass : even_x;
    y = mass > 0 ? y / mass : even_y;
    double inertia = 0;
    for (int i = 0; i < count; i++) {
        vec d = { (double)parts[i].center.x - x, (double)parts[i].center.y - y };
        inertia += (double)parts[i].inertia + (double)parts[i].mass * dot(d, d);
    }
    out.mass = (plumb_real)mass;
    out.center = plumb_v2((plumb_real)x, (plumb_real)y);
    out.inertia = (plumb_real)inertia;
    return out;
}

plumb_mass_properties plumb_mass_with_total(plumb_mass_properties m, plumb_real total)
{
    if (m.mass > 0) {
        m.inertia = (plumb_real)((double)m.inertia * ((double)total / (double)m.mass));
        m.mass = total;
    }
    return m;
}

plumb_real plumb_mass_inertia_about(plumb_mass_properties m, plumb_vec2 point)
{
    return m.inertia + m.mass * plumb_vec2_distance_sq(m.center, point);
}
