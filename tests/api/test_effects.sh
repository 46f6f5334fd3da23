#!/bin/bash
# test_effects.sh - `make EFFECTS="gravity friction"`: the library without the rest is built from the same files, gives the bits of
# the whole one, and refuses what it has not (effects/use.c).
set -u

. tests/harness/try.sh
skip_sanitized "the copy is not built with sanitizers"

fresh_make()
{
    env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS make --no-print-directory JOBS=2 "$@"
}

build()
{
    fresh_make O="$work/small" CFLAGS=-O1 WERROR=1 PRECISION=float EFFECTS="gravity friction" \
        "$work/small/libplumb.so" "$work/small/libplumb.a" "$work/small/float/libscene.a"
}

link() # folder of libraries, program
{
    # shellcheck disable=SC2046
    ${CC:-gcc} -std=c17 -D_POSIX_C_SOURCE=200809L -Iinclude -Itools tests/api/effects/use.c "$1/float/libscene.a" \
        "$1/libplumb.a" $(pkg-config --libs lua5.4 libcjson 2>/dev/null || echo -llua5.4 -lcjson) -lm -lpthread -o "$2"
}

same_bits()
{
    link "${O:-build}" "$work/whole" && "$work/whole" bits >"$work/whole.txt" && "$work/part" bits >"$work/part.txt" &&
        diff "$work/whole.txt" "$work/part.txt" && [ "$(wc -l <"$work/part.txt")" -eq 450 ]
}

smaller()
{
    [ "$(stat -c %s "$work/small/libplumb.a")" -lt "$(($(stat -c %s "${O:-build}/libplumb.a") * 3 / 4))" ] &&
        ! nm "$work/small/libplumb.a" 2>/dev/null | grep -E ' T pl_(liquid_project|exact_solve|direct_solve)'
}

says() # words, EFFECTS
{
    ! fresh_make -n O="$work/none" EFFECTS="$2" lib >"$work/said" 2>&1 && grep -F "$1" "$work/said"
}

try "a library of gravity and friction alone is linked without a warning" build
try "a program links with it" link "$work/small" "$work/part"
try "it is smaller by a quarter, and has no code of the others" smaller
try "a pile has the bits that it has in the whole library" same_bits
try "what it has not is refused, by C and by scenes, with its name" "$work/part" refusals
try "make tells of a name that is no effect" says "must be all, none, or some of: gravity" "gravity frictoin"
try "make tells of an effect without what it needs" says "EFFECTS has 'fluids', which needs 'sensors'" "fluids"
[ "$failures" -eq 0 ]
