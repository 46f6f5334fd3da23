#!/bin/bash
# test_cmake.sh - tools/cmake: a game that takes Plumb as a folder, by FetchContent and by find_package, static and
# shared, in two precisions, ends in the same bits as with the library of make.
set -u

. tests/harness/try.sh
. tests/harness/trials.sh
skip_sanitized "a game is not made of sanitized libraries"

top=$PWD

cc=${CC:-gcc}
export CMAKE_BUILD_PARALLEL_LEVEL=2
unset CFLAGS LDFLAGS

# A pile that falls in a heap; the hash of the end.
mkdir "$work/game"
cat >"$work/game/game.c" <<'END'
#include <inttypes.h>
#include <plumb/plumb.h>
#include <stdio.h>
int main(void)
{
    plumb_world *world;
    if (plumb_world_create(NULL, &world) != PLUMB_OK) {
        return 1;
    }
    plumb_body ground = plumb_body_create(world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(world, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 30, 1 } });
    for (int i = 0; i < 60; ++i) {
        plumb_body_desc at = { .position = { (plumb_real)(i % 7) / 3, 2 + (plumb_real)i / 2 }, .angle = (plumb_real)i };
        plumb_shape_desc shape = { .kind = i % 2 ? PLUMB_CIRCLE : PLUMB_BOX, .radius = (plumb_real)(i % 2) / 4 };
        shape.half = i % 2 ? (plumb_vec2){ 0, 0 } : (plumb_vec2){ (plumb_real)0.4, (plumb_real)0.2 };
        plumb_shape_create(world, plumb_body_create(world, &at), &shape);
    }
    for (int i = 0; i < 200; ++i) {
        plumb_world_step(world, (plumb_real)(1.0 / 60));
    }
    printf("%016" PRIx64 "\n", plumb_world_hash(world));
    plumb_world_destroy(world);
}
END
declare -A defines=([float]= [far]=-DPLUMB_FAR=1) suffix=([float]= [far]=_far)
for precision in float far; do
    try "the game with the $precision library of make" bash -c "'$cc' -std=c17 ${defines[$precision]} -Iinclude \
        '$work/game/game.c' '$O/libplumb${suffix[$precision]}.a' -o '$work/made' -lm -lpthread &&
        '$work/made' >'$work/$precision.hash' && grep -qE '^[0-9a-f]{16}$' '$work/$precision.hash'"
done

# The README's lines are those that are tried.
lines=$(grep '^    add_subdirectory(plumb/tools/cmake)' README.md)
try "README.md shows the line" test -n "$lines"
link=$(grep '^    target_link_libraries(game PRIVATE plumb::plumb)' README.md)
try "README.md shows the target" test -n "$link"

options=(-DCMAKE_C_COMPILER="$cc" -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS=-O0 -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
# game folder precision options...: builds without optimisation, as that costs least; runs and compares.
game()
{
    local precision=$1
    shift
    rm -rf "$work/build"
    cmake -S "$work/game" -B "$work/build" "${options[@]}" "$@" &&
        cmake --build "$work/build" && "$work/build/game" | diff - "$work/$precision.hash"
}
lists() # of CMakeLists.txt
{
    { printf 'cmake_minimum_required(VERSION 3.16)\nproject(game C)\nset(CMAKE_C_STANDARD 17)\n'
      cat
      printf 'add_executable(game game.c)\n%s\n' "$link"; } >"$work/game/CMakeLists.txt"
}
needs_shared() # or not
{
    ldd "$work/build/game" | grep -q libplumb
}

ln -s "$top" "$work/game/plumb"
lists <<<"$lines"
# A build takes half a minute, and one more is below: the commands are compared with its; TRIALS=3 runs them, too.
try "as a folder" cmake -S "$work/game" -B "$work/folder" "${options[@]}"
if trials_at_least 3; then
    try "as a folder, built" game float
    try "is linked statically" bash -c "! ldd '$work/build/game' | grep libplumb"
fi
# compiles folder, where the sources are, a word that counts for nothing: the commands that compile the library
compiles()
{
    sed -n "s|.*\"command\": \"\(.*$2/src/.*\)\",\$|\1|p" "$1/compile_commands.json" |
        sed "s| -I[^ ]*||g; s| -o [^ ]*||; s|$2||; s| -Dplumb_EXPORTS||; s| $3||" | sort
}
refused()
{
    ! cmake -S "$work/game" -B "$work/other" -DCMAKE_C_COMPILER="$cc" -DPLUMB_PRECISION=half >"$work/words" 2>&1 &&
        grep -q "must be float, double or far" <(tr -s ' \n' ' ' <"$work/words")
}
try "an unknown precision is refused" refused

# What a release would hold, and nothing else: what is left out is not needed.
tar -czf "$work/plumb.tar.gz" include src tools/cmake tools/make LICENSE
lists <<END
include(FetchContent)
FetchContent_Declare(plumb URL file://$work/plumb.tar.gz SOURCE_SUBDIR tools/cmake)
FetchContent_MakeAvailable(plumb)
END
try "by FetchContent, for far worlds, shared" game far -DPLUMB_PRECISION=far -DBUILD_SHARED_LIBS=ON
try "is linked with the shared library" needs_shared
compiles "$work/folder" "$work/game/plumb" -none >"$work/folder.txt"
compiles "$work/build" "$work/build/_deps/plumb-src" -DPLUMB_FAR=1 >"$work/fetched.txt"
try "has hundreds of sources" test "$(wc -l <"$work/folder.txt")" -gt 300
try "as a folder the library is compiled likewise" diff "$work/folder.txt" "$work/fetched.txt"
try "installs" cmake --install "$work/build/_deps/plumb-build" --prefix "$work/prefix"
lists <<<"find_package(plumb 0.1 REQUIRED)"
try "by find_package" game far -DCMAKE_PREFIX_PATH="$work/prefix"
try "is linked with what was installed" bash -c "ldd '$work/build/game' | grep 'libplumb_far.so.*$work/prefix'"
lists <<<"find_package(plumb 7.0 REQUIRED)"
try "another version is not found" bash -c "! cmake -S '$work/game' -B '$work/build7' -DCMAKE_PREFIX_PATH='$work/prefix'"

if command -v x86_64-w64-mingw32-gcc >/dev/null; then
    lists <<<"$lines"
    for_windows()
    {
        cmake -S "$work/game" -B "$work/windows" -DCMAKE_SYSTEM_NAME=Windows -DCMAKE_SYSTEM_PROCESSOR=x86_64 \
            -DCMAKE_C_COMPILER=x86_64-w64-mingw32-gcc -DCMAKE_BUILD_TYPE=Debug &&
            cmake --build "$work/windows" && test -s "$work/windows/game.exe"
    }
    try "for Windows, as a folder" for_windows
else
    echo "ok - # SKIP mingw-w64 is not here"
fi
