#!/bin/bash
# test_extend.sh - what it takes to add things: each is added to a copy of the tree, and the files that this touches are
# counted, without READMEs and tests. Then the float library and the scene loader are built once, and extend/use.c
# uses what was added: from C, Lua, JSON, saved, replayed, listed, and by what it does to bodies.
set -u

. tests/harness/try.sh
skip_sanitized "the copy is not built with sanitizers"

tree=$work/tree
parts=$PWD/tests/api/extend

mkdir "$tree"
cp -r Makefile src include tools "$tree"

# insert FILE PATTERN: the lines of stdin before the first line of the file that matches.
insert()
{
    cat >"$work/lines"
    awk -v pattern="$2" -v lines="$work/lines" '
        !done && $0 ~ pattern { while ((getline line <lines) > 0) print line; done = 1 }
        { print }' "$tree/$1" >"$work/file" && cp "$work/file" "$tree/$1"
}

sums()
{
    (cd "$tree" && find Makefile src include tools -type f -exec cksum {} + | sort)
}

# touches GOAL FUNCTION: as many files, new ones included, are others after it.
touches()
{
    sums >"$work/before"
    "$2"
    local touched
    touched=$(sums | comm -13 "$work/before" - | sed 's/^[0-9]* [0-9]* //')
    echo "$touched"
    [ "$(echo "$touched" | wc -l)" -eq "$1" ]
}

property()
{
    insert src/schema/body.h 'R.X, OWN, BOOL, disabled' <<'C'
    R(X, COLUMN, REAL, tracing, SAID(tracing), "C", FROM(0, 10), 0, NO_ZERO, "of a tracer") \
C
    insert include/plumb/body.h 'bool disabled; ' <<'C'
    plumb_real tracing; ///< [C] 0..10, default 0
C
    insert include/plumb/body.h '^/// Sets the factor on gravity' <<'C'
/// Sets and tells the tracing [C] 0..10. Errors: E_HANDLE, E_NOT_FINITE, E_RANGE.
PLUMB_API plumb_result plumb_body_set_tracing(plumb_world *world, plumb_body body, plumb_real tracing);
PLUMB_API plumb_real plumb_body_tracing(const plumb_world *world, plumb_body body);

C
}

# What users set of the effect is a property.
wind()
{
    insert src/schema/body.h 'R.X, OWN, BOOL, disabled' <<'C'
    R(X, COLUMN, REAL, wind, SAID(wind), "N", ANY, 0, NO_ZERO, "force along x") \
C
    insert include/plumb/body.h 'bool disabled; ' <<'C'
    plumb_real wind; ///< [N] along x, default 0
C
    insert include/plumb/body.h '^/// Sets the factor on gravity' <<'C'
/// Sets and tells the force [N] of the wind along x. Errors: E_HANDLE, E_NOT_FINITE.
PLUMB_API plumb_result plumb_body_set_wind(plumb_world *world, plumb_body body, plumb_real wind);
PLUMB_API plumb_real plumb_body_wind(const plumb_world *world, plumb_body body);

C
}

effect()
{
    cp "$parts/wind.c" "$tree/src/effects/wind.c"
    insert src/schema/passes.h 'X."damping"' <<'C'
    X("wind", MOMENT, IF(pl_want_wind), ACTS(pl_wind_row, pl_wind_acts_on), REPLACEABLE, "solver bodies", "accelerations", ONE) \
C
}

pass()
{
    cp "$parts/edge.c" "$tree/src/continuous/edge.c"
    insert src/schema/passes.h 'X."targets"' <<'C'
    X("edge of the world", FINISH, IF(pl_want_edge), ONCE(pl_run_edge), REPLACEABLE, "poses", "poses, velocities", ONE) \
C
}

material_property()
{
    insert src/schema/material.h 'R.X, COLUMN, MIX, friction_mix' <<'C'
    R(X, COLUMN, REAL, polish, SAID(polish), "1", FROM(0, 1), 0, NO_ZERO, "share of friction that it takes away") \
C
    insert include/plumb/material.h '^    plumb_mix adhesion_mix;' <<'C'
    plumb_real polish;      ///< [-] 0..1, share of friction that it takes away, default 0
C
    insert src/narrow/surface.c '^ *m->kinetic_friction.row. > 0 ' <<'C'
                  m->polish[row] > 0 ||
C
    insert src/narrow/surface.c '^    m->rolling =$' <<'C'
    m->friction *= (near_real)((1 - s->polish[a]) * (1 - s->polish[b]));
C
}

joint()
{
    cp "$parts/rail.c" "$tree/src/joints/rail.c"
    insert include/plumb/joint.h '^    X.FRICTION, ' <<'C'
    X(RAIL,      rail,      "B's anchor stays on a line of A")                                      \
C
}

# Of pieces that there are.
shape()
{
    sed -i -e 's/PLUMB_CHAIN  /PLUMB_CHAIN, /; s/(PLUMB_CHAIN + 1)/(PLUMB_ELLIPSE + 1)/' "$tree/include/plumb/shape.h"
    insert include/plumb/shape.h '^} plumb_shape_kind;' <<'C'
    PLUMB_ELLIPSE  ///< half, center, angle: 16 corners, two of them on each side of the axes
C
    insert src/api/shape_make.c 'PLUMB_CHAIN. = . "a chain"' <<'C'
    [PLUMB_ELLIPSE] = { "an ellipse", HAS_CENTER | HAS_HALF | HAS_ANGLE, 0, 0, 0 },
C
    insert src/api/shape_make.c '^static plumb_result make_convex' <"$parts/ellipse.c"
    insert src/api/shape_make.c '^    case PLUMB_BOX:' <<'C'
    case PLUMB_ELLIPSE:
        return make_ellipse(d, convex);
C
    insert tools/scene/defs.h '^    SC_SHAPE_KINDS' <<'C'
    SC_ELLIPSE,
C
    insert tools/scene/lists.c '^static const sc_field polygon_rows' <<'C'
static const sc_field ellipse_rows[] = {
    ROWS_PLACE, ROWS_SOLID,
    { "h", SC_NUMBER, AT(T, h), 2 * TINY, SIZE, "m", 2, SC_REQUIRED },
    ROW_IGNORES, ROW_MATERIAL, ROWS_END,
    { "w", SC_NUMBER, AT(T, w), 2 * TINY, SIZE, "m", 1, SC_REQUIRED },
};
C
    insert tools/scene/lists.c 'SC_REGULAR. *= ' <<'C'
    [SC_ELLIPSE]   = { "ellipse", ellipse_rows, COUNT(ellipse_rows) },
C
    insert tools/scene/shapes.c '^    case SC_POLYGON:' <<'C'
    case SC_ELLIPSE:
        desc.kind = PLUMB_ELLIPSE;
        desc.half = (plumb_vec2){ (plumb_real)(d->w / 2), (plumb_real)(d->h / 2) };
        desc.center = place(d, 0, 0);
        desc.angle = (plumb_real)d->angle;
        break;
C
}

try "a body property is two files" touches 2 property
try "a force effect is two files" touches 2 effect
try "what users set of it is a property: two more" touches 2 wind
try "a pass is two files" touches 2 pass
try "a material property is three files: its row, its docstring, what it does" touches 3 material_property
try "a kind of joint is two files" touches 2 joint
try "a kind of shape is five files: two, and three of the scene language" touches 5 shape

built()
{
    env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS make -C "$tree" --no-print-directory JOBS=1 O=build CFLAGS=-O0 WERROR=1 \
        EFFECTS="all -liquid -air -softbodies -characters -light -watchdog" build/libplumb.a build/float/libscene.a build/float/tools/plumb/engine_joints.o
}
try "library, loader and pictures of joints are built without a warning" built

used()
{
    # shellcheck disable=SC2046
    ${CC:-gcc} -std=c17 -D_POSIX_C_SOURCE=200809L -I"$tree/include" -I"$tree/tools" "$parts/use.c" \
        "$tree/build/float/libscene.a" "$tree/build/libplumb.a" \
        $(pkg-config --libs lua5.4 libcjson 2>/dev/null || echo -llua5.4 -lcjson) -lm -lpthread -o "$work/use" &&
        "$work/use"
}
try "all of it does what it should" used
[ "$failures" -eq 0 ]
