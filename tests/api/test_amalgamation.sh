#!/bin/bash
# test_amalgamation.sh - plumb.c and plumb.h of `make amalgamation`: they compile without a warning, as C17
# and in C++, with flags that would change results elsewhere; the scenes end in the committed hashes; a
# program in C++ runs. And what tools/amalgamate does with names that clash.
set -u

. tests/harness/try.sh
. tests/harness/trials.sh
skip_sanitized "the files are the same with sanitizers"

cc=${CC:-gcc}
cxx=${CXX:-g++}
strict="-Wall -Wextra -Wpedantic -Werror"

# Without a word: notes are no warnings, and would come with every build of a game.
silent()
{
    "$@" >"$work/words" 2>&1 && ! grep . "$work/words"
}

# At -O2 GCC sees more to warn of, and takes twice as long. At -O1 alone GCC never fuses, whatever it is allowed to.
all=0 level="-O1 -fexpensive-optimizations"
trials_at_least 3 && all=1 level=-O2
try "is written" make --no-print-directory amalgamation
try "is C17" silent "$cc" -std=c17 $strict -fsyntax-only "$O/plumb.c"
try "compiles in float for this machine, contraction allowed" \
    silent "$cc" -std=gnu17 $level $strict -march=native -ffp-contract=fast -c "$O/plumb.c" -o "$work/plumb.o"
# A minute and a half each: TRIALS=3 compiles the other precisions, too. Their front end is asked always.
others=(double:PLUMB_DOUBLE far:PLUMB_FAR)
for other in "${others[@]}"; do
    if [ "$all" = 1 ]; then
        try "compiles in ${other%:*}" silent "$cc" -std=c17 $level $strict "-D${other#*:}=1" -c "$O/plumb.c" -o "$work/plumb_${other%:*}.o"
    else
        try "is C17 in ${other%:*}" silent "$cc" -std=c17 $strict "-D${other#*:}=1" -fsyntax-only "$O/plumb.c"
    fi
done
# The other compilers that are here, each once, as far as their front ends have something to say.
asked=$("$cc" --version)
for other in gcc-12 gcc-13 gcc-14 clang clang-14 clang-19; do
    command -v $other >/dev/null || continue
    grep -qF "$($other -dumpfullversion 2>/dev/null || $other -dumpversion)" <<<"$asked" && continue
    asked+=$($other --version)
    for precision in PLUMB_DOUBLE=0 PLUMB_DOUBLE=1 PLUMB_FAR=1; do
        try "$other has nothing to say, $precision" \
            silent $other -std=c17 $strict -D$precision -fsyntax-only "$O/plumb.c"
    done
done
echo '#include "plumb.h"' >"$work/header.cpp"
for other in "$cxx" clang++; do
    command -v $other >/dev/null || continue
    try "the header is C++ to $other" silent $other -std=c++17 $strict -I"$O" -fsyntax-only "$work/header.cpp"
done
try "is refused with -ffast-math" \
    bash -c "! '$cc' -std=c17 -ffast-math -fsyntax-only '$O/plumb.c' 2>'$work/fast' &&
             grep -q 'Plumb needs IEEE arithmetic' '$work/fast'"
no_fused() # object
{
    [ -s "$1" ] && ! objdump -d --no-show-raw-insn "$1" | grep -E '\s(vfn?m(add|sub)|fn?m(add|sub)|fml[as])'
}
for object in "$work"/plumb*.o; do
    try "${object##*/} holds no fused multiply-add" no_fused "$object"
done
exports() # object: only what has a prefix
{
    [ -s "$1" ] && ! nm --defined-only --extern-only "$1" | awk '$NF !~ /^(plumb|pl)_/' | grep .
}
try "exports only names with a prefix" exports "$work/plumb.o"

# ---- the same bits
scenes="-llua5.4 -lcjson -lcmocka -lm -lpthread"
# Every eighth line of the file is enough: what is compared is not the scenes but two ways to compile.
hashes() # object variant
{
    "$cc" -o "$work/hashes" -Itests "-DTESTS=TEST(test_scene_hashes)" tests/harness/main.c \
        "$O/$2/tests/determinism/test_scene_hashes.o" "$O/$2/libscene.a" \
        "$1" $scenes && "$work/hashes" test_scene_hashes --every 8
}
objects_of_make() # variant
{
    make --no-print-directory "$O/$1/tests/determinism/test_scene_hashes.o" "$O/$1/libscene.a"
}
try "the hashes' test is there" objects_of_make float
try "ends in the committed hashes when compiled for this machine" hashes "$work/plumb.o" float
for other in "${others[@]}"; do
    [ "$all" = 1 ] || continue
    try "the hashes' test is there in ${other%:*}" objects_of_make "${other%:*}"
    try "ends in the committed hashes in ${other%:*}" hashes "$work/plumb_${other%:*}.o" "${other%:*}"
done

# ---- C++
cat >"$work/hello.cpp" <<'END'
#include "plumb.h"
#include <cstdio>
int main()
{
    plumb_world *world = nullptr;
    plumb_body_desc falling = {};
    if (plumb_world_create(nullptr, &world) != PLUMB_OK) {
        return 1;
    }
    plumb_body body = plumb_body_create(world, &falling);
    for (int i = 0; i < 60; ++i) {
        plumb_world_step(world, plumb_real(1.0 / 60));
    }
    std::printf("%.4f\n", double(plumb_body_position(world, body).y));
    plumb_world_destroy(world);
    return 0;
}
END
runs_in_cpp() # standard
{
    "$cxx" -std="$1" $strict -I"$O" "$work/hello.cpp" "$work/plumb.o" -o "$work/hello" -lm -lpthread &&
        [ "$("$work/hello")" = -4.9050 ]
}
try "is used from C++17" runs_in_cpp c++17
try "is used from C++20" runs_in_cpp c++20

# ---- names that clash: two files with the same ones, as function, type, enumerator, macro, member
mkdir -p "$work/tree/include/plumb" "$work/tree/src/a" "$work/tree/out"
cd "$work/tree" || exit 1
echo "// none" >LICENSE
echo "int plumb_one(int); int plumb_two(int);" >include/plumb/plumb.h
cat >src/a/one.c <<'END'
#include "plumb/plumb.h"
#define TWICE(x) ((x) + (x))
typedef struct item { int find, size; } item;
enum { FIRST, LAST };
static int find(item i)
{
    return i.find + TWICE(i.size) + LAST;
}
int plumb_one(int x)
{
    item i = { .find = x, .size = 10 };
    return find(i);
}
END
cat >src/a/two.c <<'END'
#include "plumb/plumb.h"
#define TWICE(x) (2 * (x) + 1)
typedef struct item { int size; double find; } item;
enum { LAST = 100, FIRST };
static const int find[] = { 1000, 2000 };
int plumb_two(int x)
{
    const item i = { x, 0 };
    return find[1] + TWICE(i.size) + FIRST;
}
END
cat >main.c <<'END'
#include "plumb.h"
int main(void)
{
    return plumb_one(1) == 22 && plumb_two(1) == 2104 ? 0 : 1;
}
END
try "tells clashing names apart" bash -c "
    '$O/amalgamate' out LICENSE include/plumb/plumb.h src/a/one.c src/a/two.c &&
    $cc -std=c17 -Wall -Wextra -Werror -Iout out/plumb.c main.c -o clash && ./clash"
echo "static int a_two_find; int plumb_three(void); int plumb_three(void) { return a_two_find; }" >src/a/three.c
try "says when a new name is taken" bash -c "
    ! '$O/amalgamate' out LICENSE include/plumb/plumb.h src/a/one.c src/a/two.c src/a/three.c 2>said &&
    grep -q \"would become 'a_two_find', which is taken\" said"
try "says when a file is missing" bash -c "
    ! '$O/amalgamate' out LICENSE include/plumb/plumb.h src/a/none.c 2>said && grep -q 'none.c cannot be read' said"
