// lists_play.c - the keys of character{} and of the queries. Rows are sorted by name, as in lists.c.
#include "lists.h"

// clang-format off
#define T sc_character_def
static const sc_field character_rows[] = {
    { "acceleration",     SC_NUMBER, AT(T, acceleration),     0, 1e9, "m/s^2", 0, 0 },
    { "air_acceleration", SC_NUMBER, AT(T, air_acceleration), 0, 1e9, "m/s^2", 0, 0 },
    { "air_control",      SC_BOOL,   AT(T, air_control),      0, 0, NULL, 0, 0 },
    { "gravity_scale",    SC_NUMBER, AT(T, gravity_scale),    -1e6, 1e6, "1", 0, 0 },
    { "mass",             SC_NUMBER, AT(T, mass),             0, BIG, "kg", 0, SC_ABOVE },
    { "max_fall_speed",   SC_NUMBER, AT(T, max_fall_speed),   0, 1e6, "m/s", 0, SC_ABOVE },
    { "max_slope",        SC_NUMBER, AT(T, max_slope),        0, 1.5, "rad", 0, SC_ABOVE },
    { "max_slope_deg",    SC_NUMBER, AT(T, max_slope_deg),    0, 85, "deg", 0, SC_ABOVE },
    { "push",             SC_BOOL,   AT(T, push),             0, 0, NULL, 0, 0 },
    { "push_force",       SC_NUMBER, AT(T, push_force),       0, BIG, "N", 0, SC_ABOVE },
    { "skin",             SC_NUMBER, AT(T, skin),             0, SIZE, "m", 0, SC_ABOVE },
    { "snap",             SC_BOOL,   AT(T, snap),             0, 0, NULL, 0, 0 },
    { "snap_distance",    SC_NUMBER, AT(T, snap_distance),    0, SIZE, "m", 0, SC_ABOVE },
    { "step_height",      SC_NUMBER, AT(T, step_height),      0, SIZE, "m", 0, SC_ABOVE },
    { "step_width",       SC_NUMBER, AT(T, step_width),       0, SIZE, "m", 0, SC_ABOVE },
    { "steps",            SC_BOOL,   AT(T, steps),            0, 0, NULL, 0, 0 },
    { "up",               SC_VEC2,   AT(T, up),               -FAR, FAR, "1", 0, 0 },
};
const sc_list sc_list_character = { "character", character_rows, COUNT(character_rows) };
#undef T

#define T sc_query_def
#define ROW_IGNORE  { "ignore",  SC_BODY, AT(T, ignore),  0, 0, NULL, 0, 0 }
#define ROW_ONE_WAY { "one_way", SC_BOOL, AT(T, one_way), 0, 0, NULL, 0, 0 }
#define ROW_SENSORS { "sensors", SC_BOOL, AT(T, sensors), 0, 0, NULL, 0, 0 }
static const sc_field ray_rows[] = {
    { "from", SC_VEC2, AT(T, from), -FAR, FAR, "m", 1, SC_REQUIRED },
    ROW_IGNORE, ROW_ONE_WAY, ROW_SENSORS,
    { "to",   SC_VEC2, AT(T, to),   -FAR, FAR, "m", 2, SC_REQUIRED },
};
static const sc_field cast_rows[] = {
    { "angle", SC_NUMBER, AT(T, angle), -BIG, BIG, "rad", 0, 0 },
    { "from",  SC_VEC2,   AT(T, from),  -FAR, FAR, "m", 0, SC_REQUIRED },
    ROW_IGNORE, ROW_ONE_WAY, ROW_SENSORS,
    { "shapes", SC_SHAPES, AT(T, shape_count), 0, 0, NULL, SC_REST, 0 },
    { "to",    SC_VEC2,   AT(T, to),    -FAR, FAR, "m", 0, SC_REQUIRED },
};
static const sc_field nearest_rows[] = {
    { "at", SC_VEC2, AT(T, from), -FAR, FAR, "m", 1, SC_REQUIRED },
    ROW_IGNORE, ROW_SENSORS,
    { "within", SC_NUMBER, AT(T, within), 0, FAR, "m", 0, SC_ABOVE },
};
static const sc_field inside_rows[] = {
    { "at", SC_VEC2, AT(T, from), -FAR, FAR, "m", 1, SC_REQUIRED },
    ROW_IGNORE, ROW_SENSORS,
};
const sc_list sc_list_queries[SC_QUERIES] = {
    [SC_RAY]     = { "ray",     ray_rows,     COUNT(ray_rows) },
    [SC_CAST]    = { "cast",    cast_rows,    COUNT(cast_rows) },
    [SC_NEAREST] = { "nearest", nearest_rows, COUNT(nearest_rows) },
    [SC_INSIDE]  = { "inside",  inside_rows,  COUNT(inside_rows) },
};
#undef T
// clang-format on

// In the order in which they are thought of when a key stands in the wrong place.
const sc_list *sc_list_at(int i)
{
    static const sc_list *const single[] = { &sc_list_material, &sc_list_body,   &sc_list_scene,
                                             &sc_list_camera,   &sc_list_pair,   &sc_list_character,
                                             &sc_list_motor,    &sc_list_spring, &sc_list_expect,
                                             &sc_list_blast,    &sc_list_liquid, &sc_list_phase,
                                             &sc_list_air,      &sc_list_source, &sc_list_waves,
                                             &sc_list_light };
    const int count = (int)(sizeof single / sizeof *single),
              all = count + SC_JOINT_KINDS + SC_SHAPE_KINDS;
    return i < count                    ? single[i]
           : i < count + SC_JOINT_KINDS ? &sc_list_joints[i - count]
           : i < count + SC_JOINT_KINDS + SC_SHAPE_KINDS
               ? &sc_list_shapes[i - count - SC_JOINT_KINDS]
           : i < all + SC_LAW_KINDS ? &sc_list_laws[i - all]
           : i < all + SC_LAW_KINDS + SC_SOFTBODY_KINDS
               ? &sc_list_softbodies[i - all - SC_LAW_KINDS]
               : NULL;
}
