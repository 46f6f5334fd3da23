// lists.c - one list a constructor: every key of the scene language with its kind, range and unit.
// Reading (fields.c), the JSON form (json_write.c, json_read.c) and "did you mean" follow from the
// rows. What the library's schema says of a property is not said again: see rows.h. To add a key of the language
// alone: one member in the struct of defs.h, one row here, its use in the constructor.
#include "lists.h"

// clang-format off
#define T sc_settings
static const sc_field scene_rows[] = {
    { "description", SC_STRING, AT(T, description), 0, 0, NULL, 0, 0 },
    { "dt", SC_NUMBER, AT(T, dt), 1e-6, 1, "s", 0, 0 },
    { "duration", SC_NUMBER, AT(T, duration), 0, 1e7, "s", 0, SC_ABOVE },
    { "seed", SC_INTEGER, AT(T, seed), 0, 9007199254740991.0, "1", 0, 0 },
    { "title", SC_STRING, AT(T, title), 0, 0, NULL, 0, 0 },
    PL_WORLD_ROWS(SC_ROW, )
};
const sc_list sc_list_scene = { "scene", scene_rows, COUNT(scene_rows) };
#undef T

#define T sc_material_def
static const sc_field material_rows[] = {
    { "name", SC_STRING, AT(T, name), 0, 0, NULL, 0, 0 },
    PL_MATERIAL_ROWS(SC_ROW, )
};
const sc_list sc_list_material = { "material", material_rows, COUNT(material_rows) };
#undef T

#define T sc_pair_def
static const sc_field pair_rows[] = {
    { "a",                  SC_MATERIAL, AT(T, a),                  0, 0, NULL, 1, SC_REQUIRED | SC_MENTION },
    { "b",                  SC_MATERIAL, AT(T, b),                  0, 0, NULL, 2, SC_REQUIRED | SC_MENTION },
    PL_MATERIAL_PAIR_ROWS(SC_ROW, )
};
const sc_list sc_list_pair = { "material_pair", pair_rows, COUNT(pair_rows) };
#undef T

// Which shapes may meet: keys of body{} and of every shape, and what set_filter takes.
#define ROW_APART    { "apart",    SC_STRING, AT(T, filter.apart),    0, 0, NULL, 0, 0 }
#define ROW_CATEGORY { "category", SC_NAMES,  AT(T, filter.category), 0, 0, NULL, 0, 0 }
#define ROW_COLLIDES { "collides", SC_NAMES,  AT(T, filter.collides), 0, 0, NULL, 0, 0 }
#define ROW_IGNORES  { "ignores",  SC_NAMES,  AT(T, filter.ignores),  0, 0, NULL, 0, 0 }
#define ROW_SENSOR   { "sensor",   SC_BOOL,   AT(T, sensor),          0, 0, NULL, 0, 0 }
#define ROW_TOGETHER { "together", SC_STRING, AT(T, filter.together), 0, 0, NULL, 0, 0 }

#define T sc_body_def
static const sc_field filter_rows[] = {
    ROW_APART, ROW_CATEGORY, ROW_COLLIDES, ROW_IGNORES, ROW_TOGETHER,
};
const sc_list sc_list_filter = { "set_filter", filter_rows, COUNT(filter_rows) };
#undef T

#define T sc_body_def
static const sc_field body_rows[] = {
    { "angle_deg",      SC_NUMBER,   AT(T, angle_deg),     -BIG, BIG, "deg", 0, 0 },
    ROW_APART,
    ROW_CATEGORY,
    { "character",      SC_RECORD,   AT(T, character),     0, 0, "character", 0, 0 },
    ROW_COLLIDES,
    { "color",          SC_COLOR,    AT(T, color),         0, 0, NULL, 0, 0 },
    { "density",        SC_NUMBER,   AT(T, density),       0, 1e9, "kg/m^2", 0, SC_ABOVE },
    { "hidden",         SC_BOOL,     AT(T, hidden),        0, 0, NULL, 0, 0 },
    ROW_IGNORES,
    { "label",          SC_STRING,   AT(T, label),         0, 0, NULL, 0, 0 },
    { "lock",           SC_AXES,     AT(T, lock),          0, 0, NULL, 0, 0 },
    { "material",       SC_MATERIAL, AT(T, material),      0, 0, NULL, 0, 0 },
    { "name",           SC_STRING,   AT(T, name),          0, 0, NULL, 0, 0 },
    { "one_way",        SC_VEC2,     AT(T, one_way),       -FAR, FAR, "1", 0, 0 },
    { "one_way_angle",  SC_NUMBER,   AT(T, one_way_angle), 0, 1.5707963, "rad", 0, SC_ABOVE },
    ROW_SENSOR,
    { "shapes",         SC_SHAPES,   AT(T, shape_count),   0, 0, NULL, SC_REST, 0 },
    ROW_TOGETHER,
    { "user",           SC_TABLE,    AT(T, user),          0, 0, NULL, 0, 0 },
    PL_BODY_ROWS(SC_ROW, )
};
const sc_list sc_list_body = { "body", body_rows, COUNT(body_rows) };
#undef T

// What every shape may say: where it sits in its body, what it is made of.
#define T sc_shape_def
#define ROW_ANGLE     { "angle",     SC_NUMBER,   AT(T, angle),     -BIG, BIG, "rad", 0, 0 }
#define ROW_ANGLE_DEG { "angle_deg", SC_NUMBER,   AT(T, angle_deg), -BIG, BIG, "deg", 0, 0 }
#define ROW_AT        { "at",        SC_VEC2,     AT(T, at),        -SIZE, SIZE, "m", 0, 0 }
#define ROW_DENSITY   { "density",   SC_NUMBER,   AT(T, density),   0, 1e9, "kg/m^2", 0, SC_ABOVE }
#define ROW_MATERIAL  { "material",  SC_MATERIAL, AT(T, material),  0, 0, NULL, 0, 0 }
#define ROW_ROUND     { "round",     SC_NUMBER,   AT(T, round),     0, SIZE, "m", 0, 0 }
#define ROW_RADIUS(n) { "r",         SC_NUMBER,   AT(T, r),         TINY, SIZE, "m", n, SC_REQUIRED }
#define ROW_POINTS(lo, hi) \
    { "points", SC_POINTS, AT(T, point_count), lo, hi, "points", SC_REST, SC_REQUIRED }

// The rows that every shape but the circle begins with, and those before its material.
#define ROWS_PLACE  ROW_ANGLE, ROW_ANGLE_DEG, ROW_APART, ROW_AT, ROW_CATEGORY
#define ROWS_SOLID  ROW_COLLIDES, ROW_DENSITY
#define ROWS_END    ROW_SENSOR, ROW_TOGETHER

static const sc_field circle_rows[] = {
    ROW_APART, ROW_AT, ROW_CATEGORY, ROWS_SOLID, ROW_IGNORES, ROW_MATERIAL, ROW_RADIUS(1), ROWS_END,
};
static const sc_field capsule_rows[] = {
    ROWS_PLACE, ROWS_SOLID, ROW_IGNORES,
    { "length", SC_NUMBER, AT(T, length), TINY, SIZE, "m", 1, SC_REQUIRED },
    ROW_MATERIAL, ROW_RADIUS(2), ROWS_END,
};
static const sc_field box_rows[] = {
    ROWS_PLACE, ROWS_SOLID,
    { "h", SC_NUMBER, AT(T, h), 2 * TINY, SIZE, "m", 2, SC_REQUIRED },
    ROW_IGNORES, ROW_MATERIAL, ROW_ROUND, ROWS_END,
    { "w", SC_NUMBER, AT(T, w), 2 * TINY, SIZE, "m", 1, SC_REQUIRED },
};
static const sc_field polygon_rows[] = {
    ROWS_PLACE, ROWS_SOLID, ROW_IGNORES, ROW_MATERIAL, ROW_POINTS(3, 64), ROW_ROUND, ROWS_END,
};
static const sc_field outline_rows[] = {
    ROWS_PLACE, ROWS_SOLID, ROW_IGNORES, ROW_MATERIAL, ROW_POINTS(3, 256), ROWS_END,
};
static const sc_field segment_rows[] = {
    ROWS_PLACE, ROW_COLLIDES, ROW_IGNORES, ROW_MATERIAL, ROW_POINTS(2, 2), ROWS_END,
};
static const sc_field chain_rows[] = {
    ROWS_PLACE,
    { "closed", SC_BOOL, AT(T, closed), 0, 0, NULL, 0, 0 },
    ROW_COLLIDES, ROW_IGNORES, ROW_MATERIAL, ROW_POINTS(2, 65536), ROWS_END,
};
static const sc_field regular_rows[] = {
    ROWS_PLACE, ROWS_SOLID, ROW_IGNORES, ROW_MATERIAL,
    { "n", SC_INTEGER, AT(T, n), 3, 16, "corners", 1, SC_REQUIRED },
    ROW_RADIUS(2), ROW_ROUND, ROWS_END,
};
const sc_list sc_list_shapes[SC_SHAPE_KINDS] = {
    [SC_CIRCLE]    = { "circle",  circle_rows,  COUNT(circle_rows) },
    [SC_CAPSULE]   = { "capsule", capsule_rows, COUNT(capsule_rows) },
    [SC_BOX_SHAPE] = { "box",     box_rows,     COUNT(box_rows) },
    [SC_POLYGON]   = { "polygon", polygon_rows, COUNT(polygon_rows) },
    [SC_OUTLINE]   = { "outline", outline_rows, COUNT(outline_rows) },
    [SC_SEGMENT]   = { "segment", segment_rows, COUNT(segment_rows) },
    [SC_CHAIN]     = { "chain",   chain_rows,   COUNT(chain_rows) },
    [SC_REGULAR]   = { "regular", regular_rows, COUNT(regular_rows) },
};
#undef T

#define T sc_camera
static const sc_field camera_rows[] = {
    { "at",     SC_NUMBER, AT(T, at), 0, 1e7, "s", 0, 0 },
    { "center", SC_VEC2,   AT(T, center), -FAR, FAR, "m", 0, 0 },
    { "fit",    SC_BOX,    AT(T, fit),    -FAR, FAR, "m", 0, 0 },
    { "follow", SC_BODY,   AT(T, follow), 0, 0, NULL, 0, 0 },
    { "height", SC_NUMBER, AT(T, height), 0, FAR, "m", 0, SC_ABOVE },
    { "trail",  SC_NUMBER, AT(T, trail), 0, 1e7, "s", 0, 0 },
};
const sc_list sc_list_camera = { "camera", camera_rows, COUNT(camera_rows) };
#undef T

#define T sc_expect_def
static const sc_field expect_rows[] = {
    { "alarm",           SC_STRING,   AT(T, alarm),           0, 0, NULL, 0, 0 },
    { "alarms",          SC_RANGE,    AT(T, alarms),          0, 1e9, "1", 0, 0 },
    { "always",          SC_BOOL,     AT(T, always),          0, 0, NULL, 0, 0 },
    { "angle",           SC_RANGE,    AT(T, angle),           -BIG, BIG, "rad", 0, 0 },
    { "at",              SC_NUMBER,   AT(T, at),              0, 1e7, "s", 0, 0 },
    { "body",            SC_BODY,     AT(T, body),            0, 0, NULL, 0, 0 },
    { "broken",          SC_RANGE,    AT(T, broken),          0, 1e9, "1", 0, 0 },
    { "count",           SC_RANGE,    AT(T, count),           0, 1e9, "1", 0, 0 },
    { "energy_drift",    SC_NUMBER,   AT(T, energy_drift),    0, BIG, "1", 0, 0 },
    { "exact",           SC_STRING,   AT(T, exact),           0, 0, NULL, 0, 0 },
    { "from",            SC_NUMBER,   AT(T, from),            0, 1e7, "s", 0, 0 },
    { "inside",          SC_RANGE,    AT(T, inside),          0, 1e9, "1", 0, 0 },
    { "joint",           SC_JOINT,    AT(T, joint),           0, 0, NULL, 0, 0 },
    { "joint_value",     SC_RANGE,    AT(T, joint_value),     -BIG, BIG, "rad or m", 0, 0 },
    { "max_joint_error", SC_NUMBER,   AT(T, max_joint_error), 0, BIG, "m", 0, 0 },
    { "max_penetration", SC_NUMBER,   AT(T, max_penetration), 0, BIG, "m", 0, 0 },
    { "max_speed",       SC_NUMBER,   AT(T, max_speed),       0, BIG, "m/s", 0, 0 },
    { "max_spin",        SC_NUMBER,   AT(T, max_spin),        0, BIG, "rad/s", 0, 0 },
    { "min_speed",       SC_NUMBER,   AT(T, min_speed),       0, BIG, "m/s", 0, 0 },
    { "momentum_drift",  SC_NUMBER,   AT(T, momentum_drift),  0, BIG, "1", 0, 0 },
    { "name",            SC_STRING,   AT(T, name),            0, 0, NULL, 1, SC_REQUIRED },
    { "position",        SC_VEC2,     AT(T, position),        -FAR, FAR, "m", 0, 0 },
    { "reaction",        SC_RANGE,    AT(T, reaction),        0, BIG, "N", 0, 0 },
    { "reaction_torque", SC_RANGE,    AT(T, reaction_torque), -BIG, BIG, "N m", 0, 0 },
    { "score",           SC_STRING,   AT(T, score),           0, 0, NULL, 0, 0 },
    { "speed",           SC_RANGE,    AT(T, speed),           0, BIG, "m/s", 0, 0 },
    { "spin",            SC_RANGE,    AT(T, spin),            -BIG, BIG, "rad/s", 0, 0 },
    { "temperature",     SC_RANGE,    AT(T, temperature),     0, BIG, "K", 0, 0 },
    { "test",            SC_FUNCTION, AT(T, test),            0, 0, NULL, 0, 0 },
    { "till",            SC_NUMBER,   AT(T, till),            0, 1e7, "s", 0, 0 },
    { "tolerance",       SC_NUMBER,   AT(T, tolerance),       0, BIG, "1", 0, 0 },
    { "value",           SC_RANGE,    AT(T, value),           -BIG, BIG, "1", 0, 0 },
    { "visits",          SC_RANGE,    AT(T, visits),          0, 1e9, "1", 0, 0 },
    { "vx",              SC_RANGE,    AT(T, vx),              -BIG, BIG, "m/s", 0, 0 },
    { "vy",              SC_RANGE,    AT(T, vy),              -BIG, BIG, "m/s", 0, 0 },
    { "x",               SC_RANGE,    AT(T, x),               -FAR, FAR, "m", 0, 0 },
    { "y",               SC_RANGE,    AT(T, y),               -FAR, FAR, "m", 0, 0 },
};
const sc_list sc_list_expect = { "expect", expect_rows, COUNT(expect_rows) };
#undef T

#define T sc_exact_def
static const sc_field exact_rows[] = {
    { "angle",   SC_FUNCTION, AT(T, angle),   0, 0, NULL, 0, 0 },
    { "at",      SC_NUMBER,   AT(T, at),      0, 1e7, "s", 0, SC_ABOVE },
    { "body",    SC_BODY,     AT(T, body),    0, 0, NULL, 0, 0 },
    { "from",    SC_NUMBER,   AT(T, from),    0, 1e7, "s", 0, 0 },
    { "measure", SC_FUNCTION, AT(T, measure), 0, 0, NULL, 0, 0 },
    { "name",    SC_STRING,   AT(T, name),    0, 0, NULL, 1, 0 },
    { "scale",   SC_NUMBER,   AT(T, scale),   0, BIG, NULL, 0, SC_ABOVE },
    { "spin",    SC_FUNCTION, AT(T, spin),    0, 0, NULL, 0, 0 },
    { "till",    SC_NUMBER,   AT(T, till),    0, 1e7, "s", 0, SC_ABOVE },
    { "unit",    SC_STRING,   AT(T, unit),    0, 0, NULL, 0, 0 },
    { "value",   SC_FUNCTION, AT(T, value),   0, 0, NULL, 0, 0 },
    { "vx",      SC_FUNCTION, AT(T, vx),      0, 0, NULL, 0, 0 },
    { "vy",      SC_FUNCTION, AT(T, vy),      0, 0, NULL, 0, 0 },
    { "x",       SC_FUNCTION, AT(T, x),       0, 0, NULL, 0, 0 },
    { "y",       SC_FUNCTION, AT(T, y),       0, 0, NULL, 0, 0 },
};
const sc_list sc_list_exact = { "exact", exact_rows, COUNT(exact_rows) };
#undef T

#define T sc_blast_def
static const sc_field blast_rows[] = {
    { "at",        SC_VEC2,   AT(T, at),        -FAR, FAR, "m", 0, SC_REQUIRED },
    { "falloff",   SC_NUMBER, AT(T, falloff),   0, SIZE, "m", 0, 0 },
    { "ignore",    SC_BODY,   AT(T, ignore),    0, 0, NULL, 0, 0 },
    { "impulse",   SC_NUMBER, AT(T, impulse),   -BIG, BIG, "N s/m", 0, SC_REQUIRED },
    { "occlusion", SC_CHOICE, AT(T, occlusion), 0, 0, "none|walls|all", 0, 0 },
    { "per_body",  SC_BOOL,   AT(T, per_body),  0, 0, NULL, 0, 0 },
    { "radius",    SC_NUMBER, AT(T, radius),    0, SIZE, "m", 0, SC_REQUIRED },
};
const sc_list sc_list_blast = { "blast", blast_rows, COUNT(blast_rows) };
#undef T

#define T sc_liquid_def
static const sc_field liquid_rows[] = {
    { "color",     SC_COLOR,  AT(T, color),       0, 0, NULL, 0, 0 },
    { "density",   SC_NUMBER, AT(T, density),     1e-6, 1e9, "kg/m^2", 0, 0 },
    { "dye",       SC_COLOR,  AT(T, dye),         0, 0, NULL, 0, 0 },
    { "friction",  SC_NUMBER, AT(T, friction),    0, 10, "-", 0, 0 },
    { "name",      SC_STRING, AT(T, name),        0, 0, NULL, 0, 0 },
    { "particles", SC_TABLE,  AT(T, particles),   0, 0, NULL, 0, 0 },
    { "phase",     SC_STRING, AT(T, phase),       0, 0, NULL, 0, 0 },
    { "phases",    SC_TABLE,  AT(T, phases),      0, 0, NULL, 0, 0 },
    { "refill",    SC_BOOL,   AT(T, refill),      0, 0, NULL, 0, 0 },
    { "shapes",    SC_SHAPES, AT(T, shape_count), 0, 0, NULL, SC_REST, 0 },
    { "spacing",   SC_NUMBER, AT(T, spacing),     1e-4, 1e3, "m", 0, 0 },
    { "tension",   SC_NUMBER, AT(T, tension),     0, 1e9, "N/m", 0, 0 },
    { "velocity",  SC_VEC2,   AT(T, velocity),    -1e6, 1e6, "m/s", 0, 0 },
    { "viscosity", SC_NUMBER, AT(T, viscosity),   0, 1e9, "Pa s", 0, 0 },
};
const sc_list sc_list_liquid = { "liquid", liquid_rows, COUNT(liquid_rows) };
#undef T

#define T sc_phase_def
static const sc_field phase_rows[] = {
    { "color",     SC_COLOR,  AT(T, color),     0, 0, NULL, 0, 0 },
    { "density",   SC_NUMBER, AT(T, density),   1e-9, 1e12, "kg/m^2", 0, 0 },
    { "friction",  SC_NUMBER, AT(T, friction),  0, 10, "-", 0, 0 },
    { "name",      SC_STRING, AT(T, name),      0, 0, NULL, 0, SC_REQUIRED },
    { "viscosity", SC_NUMBER, AT(T, viscosity), 0, 1e9, "Pa s", 0, 0 },
};
const sc_list sc_list_phase = { "phases", phase_rows, COUNT(phase_rows) };
#undef T

#define T sc_air_def
#define SIDES "open|closed|periodic|flow"
static const sc_field air_rows[] = {
    { "at",          SC_VEC2,   AT(T, at),          -1e6, 1e6, "m", 0, 0 },
    { "bottom",      SC_CHOICE, AT(T, bottom),      0, 0, SIDES, 0, 0 },
    { "cell",        SC_NUMBER, AT(T, cell),        1e-4, 1e4, "m", 0, 0 },
    { "cells",       SC_TABLE,  AT(T, cells),       0, 0, NULL, 0, 0 },
    { "color",       SC_COLOR,  AT(T, color),       0, 0, NULL, 0, 0 },
    { "cooling",     SC_NUMBER, AT(T, cooling),     0, 1e6, "1/s", 0, 0 },
    { "density",     SC_NUMBER, AT(T, density),     1e-9, 1e9, "kg/m^2", 0, 0 },
    { "fading",      SC_NUMBER, AT(T, fading),      0, 1e6, "1/s", 0, 0 },
    { "flow",        SC_VEC2,   AT(T, flow),        -1e4, 1e4, "m/s", 0, 0 },
    { "hidden",      SC_BOOL,   AT(T, hidden),      0, 0, NULL, 0, 0 },
    { "left",        SC_CHOICE, AT(T, left),        0, 0, SIDES, 0, 0 },
    { "right",       SC_CHOICE, AT(T, right),       0, 0, SIDES, 0, 0 },
    { "size",        SC_VEC2,   AT(T, size),        2e-4, 2e6, "m", 0, SC_REQUIRED },
    { "temperature", SC_NUMBER, AT(T, temperature), 1e-3, 1e6, "K", 0, 0 },
    { "top",         SC_CHOICE, AT(T, top),         0, 0, SIDES, 0, 0 },
    { "viscosity",   SC_NUMBER, AT(T, viscosity),   0, 1e9, "m^2/s", 0, 0 },
};
const sc_list sc_list_air = { "air", air_rows, COUNT(air_rows) };
#undef T

#define T sc_waves_def
static const sc_field waves_rows[] = {
    { "body",         SC_BODY,    AT(T, body),         0, 0, NULL, 0, SC_REQUIRED },
    { "damping",      SC_NUMBER,  AT(T, damping),      0, 1000, "1/s", 0, 0 },
    { "height",       SC_NUMBER,  AT(T, height),       0, 1e6, "m", 0, SC_ABOVE },
    { "modes",        SC_INTEGER, AT(T, modes),        1, 512, "1", 0, 0 },
    { "state",        SC_TABLE,   AT(T, state),        0, 0, NULL, 0, 0 },
    { "swell",        SC_NUMBER,  AT(T, swell),        0, 1000, "m", 0, 0 },
    { "swell_length", SC_NUMBER,  AT(T, swell_length), -1e6, 1e6, "m", 0, 0 },
};
const sc_list sc_list_waves = { "waves", waves_rows, COUNT(waves_rows) };
#undef T

#define T sc_light_def
static const sc_field light_rows[] = {
    { "angle",        SC_NUMBER,  AT(T, angle),        -BIG, BIG, "rad", 0, 0 },
    { "around",       SC_NUMBER,  AT(T, around),       0, 10, "1", 0, 0 },
    { "at",           SC_VEC2,    AT(T, at),           -FAR, FAR, "m", 0, 0 },
    { "body",         SC_BODY,    AT(T, body),         0, 0, NULL, 0, 0 },
    { "bounces",      SC_INTEGER, AT(T, bounces),      1, PLUMB_LIGHT_MAX_BOUNCES, "1", 0, 0 },
    { "color",        SC_COLOR,   AT(T, color),        0, 0, NULL, 0, 0 },
    { "hidden",       SC_BOOL,    AT(T, hidden),       0, 0, NULL, 0, 0 },
    { "least",        SC_NUMBER,  AT(T, least),        0, BIG, "W", 0, SC_ABOVE },
    { "length",       SC_NUMBER,  AT(T, length),       0, BIG, "m", 0, SC_ABOVE },
    { "name",         SC_STRING,  AT(T, name),         0, 0, NULL, 0, 0 },
    { "polarization", SC_NUMBER,  AT(T, polarization), -1, 1, "1", 0, 0 },
    { "power",        SC_NUMBER,  AT(T, power),        0, BIG, "W", 0, SC_ABOVE },
    { "rays",         SC_INTEGER, AT(T, rays),         1, 64, "1", 0, 0 },
    { "sensors",      SC_BOOL,    AT(T, sensors),      0, 0, NULL, 0, 0 },
    { "spread",       SC_NUMBER,  AT(T, spread),       0, 6.2831853, "rad", 0, 0 },
    { "width",        SC_NUMBER,  AT(T, width),        0, SIZE, "m", 0, 0 },
};
const sc_list sc_list_light = { "light", light_rows, COUNT(light_rows) };
#undef T

#define T sc_source_def
static const sc_field source_rows[] = {
    { "at",     SC_VEC2,   AT(T, at),     -1e6, 1e6, "m", 0, 0 },
    { "body",   SC_BODY,   AT(T, body),   0, 0, NULL, 0, 0 },
    { "heat",   SC_NUMBER, AT(T, heat),   -1e6, 1e6, "K/s", 0, 0 },
    { "push",   SC_VEC2,   AT(T, push),   -1e6, 1e6, "m/s^2", 0, 0 },
    { "radius", SC_NUMBER, AT(T, radius), 0, 1e6, "m", 0, SC_ABOVE },
    { "smoke",  SC_NUMBER, AT(T, smoke),  -1e6, 1e6, "1/s", 0, 0 },
};
const sc_list sc_list_source = { "air_source", source_rows, COUNT(source_rows) };
#undef T

#define T sc_softbody_def
#define ROW_SOFT_AT       { "at",           SC_VEC2,    AT(T, at),           -1e9, 1e9, "m", 0, SC_REQUIRED }
#define ROW_BENDING       { "bending",      SC_NUMBER,  AT(T, bending),      0, 1e15, "N m^2", 0, 0 }
#define ROW_BREAK_STRAIN  { "break_strain", SC_NUMBER,  AT(T, break_strain), 0, 1e6, "1", 0, 0 }
#define ROW_SOFT_COLOR    { "color",        SC_COLOR,   AT(T, color),        0, 0, NULL, 0, 0 }
#define ROW_SOFT_DAMPING(unit) { "damping", SC_NUMBER,  AT(T, damping),      0, 1e15, unit, 0, 0 }
#define ROW_SOFT_DRAG     { "drag",         SC_NUMBER,  AT(T, drag),         0, 1e6, "1/s", 0, 0 }
#define ROW_SOFT_FRICTION { "friction",     SC_NUMBER,  AT(T, friction),     0, 1e3, "1", 0, 0 }
#define ROW_SOFT_MASS     { "mass",         SC_NUMBER,  AT(T, mass),         0, 1e9, "kg", 0, SC_ABOVE }
#define ROW_SOFT_RADIUS   { "radius",       SC_NUMBER,  AT(T, radius),       0, 1e5, "m", 0, SC_ABOVE }
#define ROW_STIFFNESS(unit) { "stiffness",  SC_NUMBER,  AT(T, stiffness),    0, 1e15, unit, 0, SC_ABOVE }
#define ROW_GAS_AMBIENT   { "ambient",      SC_NUMBER,  AT(T, ambient),      0, 1e12, "N/m", 0, 0 }
#define ROW_GAS_PRESSURE  { "pressure",     SC_NUMBER,  AT(T, pressure),     0, 1e12, "N/m", 0, 0 }
#define ROW_SOFT_SLEEP    { "sleep",        SC_BOOL,    AT(T, sleep),        0, 0, NULL, 0, 0 }
#define ROW_SOFT_NODES    { "nodes",        SC_INTEGER, AT(T, node_count),   2, 10000, "1", 0, 0 }
#define ROW_SOFT_VELOCITY { "velocity",     SC_VEC2,    AT(T, velocity),     -1e6, 1e6, "m/s", 0, 0 }
#define ROW_PART(name)    { #name,          SC_TABLE,   AT(T, name),         0, 0, NULL, 0, 0 }
static const sc_field rope_rows[] = {
    ROW_BENDING, ROW_BREAK_STRAIN, ROW_CATEGORY, ROW_COLLIDES, ROW_SOFT_COLOR, ROW_SOFT_DAMPING("N s"), ROW_SOFT_DRAG,
    ROW_SOFT_FRICTION,
    { "from",         SC_VEC2,   AT(T, from),         -1e9, 1e9, "m", 0, SC_REQUIRED },
    { "from_body",    SC_BODY,   AT(T, from_body),    0, 0, NULL, 0, 0 },
    { "hold",         SC_CHOICE, AT(T, hold),         0, 0, "none|from|to|both", 0, 0 },
    ROW_IGNORES,
    { "length",       SC_NUMBER, AT(T, length),       0, 1e6, "m", 0, SC_ABOVE },
    ROW_SOFT_MASS, ROW_SOFT_NODES,
    { "pushes",       SC_BOOL,   AT(T, pushes),       0, 0, NULL, 0, 0 },
    ROW_SOFT_RADIUS, ROW_SOFT_SLEEP, ROW_STIFFNESS("N"),
    { "to",           SC_VEC2,   AT(T, to),           -1e9, 1e9, "m", 0, SC_REQUIRED },
    { "to_body",      SC_BODY,   AT(T, to_body),      0, 0, NULL, 0, 0 },
    { "yield_strain", SC_NUMBER, AT(T, yield_strain), 0, 1e6, "1", 0, 0 },
};
static const sc_field cloth_rows[] = {
    ROW_SOFT_AT, ROW_BREAK_STRAIN, ROW_CATEGORY, ROW_COLLIDES, ROW_SOFT_COLOR,
    { "columns", SC_INTEGER, AT(T, columns),   1, 300, "1", 0, 0 },
    ROW_SOFT_DAMPING("N s/m"), ROW_SOFT_DRAG, ROW_SOFT_FRICTION,
    { "hold",    SC_CHOICE,  AT(T, held),      0, 0, "none|top|corners", 0, 0 },
    ROW_IGNORES, ROW_SOFT_MASS, ROW_SOFT_RADIUS,
    { "rows",    SC_INTEGER, AT(T, row_count), 1, 300, "1", 0, 0 },
    { "shear",   SC_NUMBER,  AT(T, shear),     0, 1e15, "N/m", 0, 0 },
    { "size",    SC_VEC2,    AT(T, size),      1e-6, 1e6, "m", 0, SC_REQUIRED },
    ROW_SOFT_SLEEP, ROW_STIFFNESS("N/m"),
};
static const sc_field jelly_rows[] = {
    ROW_CATEGORY, ROW_COLLIDES, ROW_SOFT_COLOR, ROW_SOFT_DAMPING("s"),
    { "density", SC_NUMBER, AT(T, density),     0, 1e9, "kg/m^2", 0, SC_ABOVE },
    ROW_SOFT_DRAG, ROW_SOFT_FRICTION, ROW_IGNORES,
    { "poisson", SC_NUMBER, AT(T, poisson),     0, 0.95, "1", 0, 0 },
    { "shape",   SC_SHAPES, AT(T, shape_count), 0, 0, NULL, SC_REST, 0 },
    ROW_SOFT_SLEEP,
    { "spacing", SC_NUMBER, AT(T, spacing),     0, 1e6, "m", 0, SC_ABOVE },
    ROW_SOFT_VELOCITY,
    { "young",   SC_NUMBER, AT(T, young),       0, 1e15, "N/m", 0, SC_ABOVE },
};
static const sc_field balloon_rows[] = {
    ROW_GAS_AMBIENT, ROW_SOFT_AT, ROW_BENDING, ROW_BREAK_STRAIN, ROW_CATEGORY, ROW_COLLIDES, ROW_SOFT_COLOR,
    ROW_SOFT_DAMPING("N s"), ROW_SOFT_DRAG, ROW_SOFT_FRICTION, ROW_IGNORES, ROW_SOFT_MASS, ROW_SOFT_NODES,
    ROW_GAS_PRESSURE, ROW_SOFT_RADIUS, ROW_SOFT_SLEEP, ROW_STIFFNESS("N"), ROW_SOFT_VELOCITY,
};
static const sc_field softbody_rows[] = {
    ROW_GAS_AMBIENT,
    { "area",   SC_NUMBER, AT(T, area),   0, 1e12, "m^2", 0, 0 },
    { "asleep", SC_BOOL,   AT(T, asleep), 0, 0, NULL, 0, 0 },
    ROW_PART(bends), ROW_CATEGORY, ROW_COLLIDES, ROW_SOFT_COLOR, ROW_SOFT_DRAG, ROW_PART(edges), ROW_SOFT_FRICTION,
    ROW_IGNORES, ROW_PART(nodes), ROW_PART(pins), ROW_GAS_PRESSURE, ROW_PART(ring), ROW_SOFT_SLEEP,
    ROW_PART(triangles),
};
const sc_list sc_list_softbodies[SC_SOFTBODY_KINDS] = {
    [SC_ROPE]     = { "rope",     rope_rows,     COUNT(rope_rows) },
    [SC_CLOTH]    = { "cloth",    cloth_rows,    COUNT(cloth_rows) },
    [SC_JELLY]    = { "jelly",    jelly_rows,    COUNT(jelly_rows) },
    [SC_BALLOON]  = { "balloon",  balloon_rows,  COUNT(balloon_rows) },
    [SC_SOFTBODY] = { "softbody", softbody_rows, COUNT(softbody_rows) },
};
#undef T

#define T sc_law_def
#define ROW_LAW_ANGLE { "angle",     SC_NUMBER,  AT(T, angle),     -FAR, FAR, "rad", 0, 0 }
#define ROW_LAW_AT    { "at",        SC_VEC2,    AT(T, at),        -FAR, FAR, "m", 0, 0 }
#define ROW_LAW_BODY  { "body",      SC_BODY,    AT(T, body),      0, 0, NULL, 0, 0 }
#define ROW_FALLOFF   { "falloff",   SC_CHOICE,  AT(T, falloff),   0, 0, "square|inverse|cube|none|spring", 0, 0 }
#define ROW_LAW_HALF  { "half",      SC_VEC2,    AT(T, half),      0, FAR, "m", 0, 0 }
#define ROW_ON        { "on",        SC_CHOICE,  AT(T, on),        0, 0, "mass|charge", 0, 0 }
#define ROW_ONLY      { "only",      SC_NAMES,   AT(T, only),      0, 0, NULL, 0, 0 }
#define ROW_PRIORITY  { "priority",  SC_INTEGER, AT(T, priority),  -1e6, 1e6, "1", 0, 0 }
#define ROW_REACH     { "radius",    SC_NUMBER,  AT(T, radius),    0, FAR, "m", 0, SC_ABOVE }
#define ROW_REPLACE   { "replace",   SC_BOOL,    AT(T, replace),   0, 0, NULL, 0, 0 }
#define ROW_SOFTENING { "softening", SC_NUMBER,  AT(T, softening), 0, FAR, "m", 0, 0 }
#define ROW_STRENGTH(unit) { "strength", SC_NUMBER, AT(T, strength), -1e30, 1e30, unit, 0, 0 }

static const sc_field attractor_rows[] = {
    ROW_LAW_AT, ROW_LAW_BODY, ROW_FALLOFF, ROW_ON, ROW_ONLY, ROW_PRIORITY, ROW_REACH, ROW_REPLACE,
    ROW_SOFTENING, ROW_STRENGTH("m^3/s^2 where square"),
};
static const sc_field zone_rows[] = {
    ROW_LAW_ANGLE, ROW_LAW_AT, ROW_LAW_BODY,
    { "electric", SC_VEC2, AT(T, electric), -BIG, BIG, "N/C", 0, 0 },
    { "gravity",  SC_VEC2, AT(T, gravity),  -BIG, BIG, "m/s^2", 0, 0 },
    ROW_LAW_HALF, ROW_ONLY, ROW_PRIORITY, ROW_REACH, ROW_REPLACE,
};
static const sc_field magnetic_rows[] = {
    ROW_LAW_ANGLE, ROW_LAW_AT, ROW_LAW_BODY, ROW_LAW_HALF, ROW_ONLY, ROW_REACH, ROW_STRENGTH("T"),
};
static const sc_field mutual_rows[] = {
    ROW_FALLOFF, ROW_ON, ROW_ONLY, ROW_REACH, ROW_SOFTENING, ROW_STRENGTH("G, or k of charges"),
};
static const sc_field formula_rows[] = {
    ROW_LAW_ANGLE, ROW_LAW_AT, ROW_LAW_BODY, ROW_LAW_HALF, ROW_ON, ROW_ONLY,
    { "potential", SC_STRING, AT(T, potential), 0, 0, NULL, 0, 0 },
    ROW_PRIORITY, ROW_REACH, ROW_REPLACE,
    { "x", SC_STRING, AT(T, x), 0, 0, NULL, 0, 0 },
    { "y", SC_STRING, AT(T, y), 0, 0, NULL, 0, 0 },
};
const sc_list sc_list_laws[SC_LAW_KINDS] = {
    [SC_ATTRACTOR] = { "attractor", attractor_rows, COUNT(attractor_rows) },
    [SC_ZONE]      = { "zone",      zone_rows,      COUNT(zone_rows) },
    [SC_MAGNETIC]  = { "magnetic",  magnetic_rows,  COUNT(magnetic_rows) },
    [SC_MUTUAL]    = { "mutual",    mutual_rows,    COUNT(mutual_rows) },
    [SC_FORMULA]   = { "formula",   formula_rows,   COUNT(formula_rows) },
};
#undef T

#define T sc_orbits_def
static const sc_field orbits_rows[] = {
    { "order",     SC_INTEGER, AT(T, order),     2, 4, "2 or 4", 0, 0 },
    { "tolerance", SC_NUMBER,  AT(T, tolerance), 0, 0.01, "1", 0, 0 },
};
const sc_list sc_list_orbits = { "orbits", orbits_rows, COUNT(orbits_rows) };
#undef T

#define T sc_contact_def
static const sc_field contact_rows[] = {
    { "a",        SC_BODY,     AT(T, a),        0, 0, NULL, 0, 0 },
    { "b",        SC_BODY,     AT(T, b),        0, 0, NULL, 0, 0 },
    { "function", SC_FUNCTION, AT(T, function), 0, 0, NULL, 1, SC_REQUIRED },
};
const sc_list sc_list_contact = { "on_contact", contact_rows, COUNT(contact_rows) };
static const sc_field hit_rows[] = {
    { "a",        SC_BODY,     AT(T, a),        0, 0, NULL, 0, 0 },
    { "b",        SC_BODY,     AT(T, b),        0, 0, NULL, 0, 0 },
    { "function", SC_FUNCTION, AT(T, function), 0, 0, NULL, 1, SC_REQUIRED },
    { "speed",    SC_NUMBER,   AT(T, speed),    0, 1e6, "m/s", 0, SC_ABOVE },
};
const sc_list sc_list_hit = { "on_hit", hit_rows, COUNT(hit_rows) };
static const sc_field field_rows[] = {
    { "body",     SC_BODY,     AT(T, a),        0, 0, NULL, 0, SC_REQUIRED },
    { "function", SC_FUNCTION, AT(T, function), 0, 0, NULL, 1, SC_REQUIRED },
};
const sc_list sc_list_field = { "field", field_rows, COUNT(field_rows) };
static const sc_field break_rows[] = {
    { "function", SC_FUNCTION, AT(T, function), 0, 0, NULL, 1, SC_REQUIRED },
    { "joint",    SC_JOINT,    AT(T, joint),    0, 0, NULL, 0, 0 },
};
const sc_list sc_list_break = { "on_break", break_rows, COUNT(break_rows) };
#undef T
// clang-format on
