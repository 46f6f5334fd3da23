#!/bin/bash
# test_install.sh - `make install` into an empty folder, then programs built against what is there:
# through pkg-config and CMake, static and shared, in all three precisions, in C and in C++.
set -u

. tests/harness/try.sh
skip_sanitized "a package is not made of sanitized libraries"

cc=${CC:-gcc}
cxx=${CXX:-g++}
prefix=/opt/plumb
root=$work/root
lib=$root$prefix/lib
warnings="-Wall -Wextra -Wpedantic -Werror"

try "installs" make --no-print-directory install DESTDIR="$root" PREFIX=$prefix
share=$root$prefix/share
for file in doc/plumb/README.md doc/plumb/scenes.md doc/plumb/library.md doc/plumb/command-line.md \
    doc/plumb/LICENSE man/man1/plumb.1 plumb/scenes/stack.lua plumb/examples/hello.c \
    plumb/examples/sdl2/show.c; do
    try "brings share/$file" test -s "$share/$file"
done
try "the installed scenes run" bash -c "'$root$prefix/bin/plumb' check -q '$share/plumb/scenes/stack.lua'"
try "all of them are there" diff -r assets/scenes "$share/plumb/scenes"
lint_man()
{
    ! mandoc -T lint -W warning "$share/man/man1/plumb.1" | grep .
}
try "the manual page has no slip" lint_man
man_tells() # of every command and its options
{
    local command option text
    text=$(mandoc -T utf8 "$share/man/man1/plumb.1" | sed 's/.\x08//g')
    for command in run render check explain cost convert replay diff list; do
        grep -q "plumb $command" <<<"$text" || return 1
        while read -r option; do
            grep -qe "$option" <<<"$text" || { echo "$command $option"; return 1; }
        done < <("$root$prefix/bin/plumb" help "$command" | grep -oE '^  (-.,)? *--[a-z-]+' | grep -oE -e '--[a-z-]+' | grep -v -e --help)
    done
}
try "the manual page tells of every command and option" man_tells
try "leaves no file elsewhere" test "$(ls "$root")" = opt
try "installs the command line" "$root$prefix/bin/plumb" --help
# What a tab offers after these words, with the installed command line.
complete()
{
    bash -c '. "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _plumb; echo "${COMPREPLY[@]}"' \
        complete "$root$prefix/share/bash-completion/completions/plumb" "$root$prefix/bin/plumb" "$@"
}
try "completes commands" test "$(complete re)" = "render replay"
try "completes precisions" test "$(complete run --precision '')" = "float double far"
try "completes solvers" test "$(complete run --solver '')" = "soft pgs exact"
try "completes options" test "$(complete run --prec)" = "--precision"

# ---- headers: each stands alone, in both languages
alone() # compiler standard language header
{
    echo "#include \"plumb/$4\"" >"$work/alone.$3"
    "$1" -std="$2" $warnings -I"$root$prefix/include" -fsyntax-only "$work/alone.$3"
}
for header in "$root$prefix"/include/plumb/*.h; do
    name=${header##*/}
    try "$name stands alone in C17" alone "$cc" c17 c "$name"
    try "$name stands alone in C++17" alone "$cxx" c++17 cpp "$name"
done

# ---- a program prints 120 lines, and the ball rests on the ground at the end
says_hello() # program
{
    "$1" >"$work/out" && [ "$(wc -l <"$work/out")" -eq 120 ] &&
        tail -n 1 "$work/out" | awk '{ print; exit !($3 > 1.99 && $3 < 2.01) }'
}

# The same in C++, where a descriptor is filled member by member.
cat >"$work/hello.cpp" <<'END'
#include <plumb/plumb.h>
#include <cstdio>
int main()
{
    plumb_world *world = nullptr;
    if (plumb_world_create(nullptr, &world) != PLUMB_OK) {
        return 1;
    }
    plumb_body_desc still = {}, falling = {};
    still.type = PLUMB_STATIC;
    falling.position.y = 6;
    plumb_shape_desc floor = {}, disc = {};
    floor.kind = PLUMB_BOX;
    floor.half.x = 9;
    floor.half.y = 1;
    disc.kind = PLUMB_CIRCLE;
    disc.radius = 1;
    plumb_shape_create(world, plumb_body_create(world, &still), &floor);
    plumb_body ball = plumb_body_create(world, &falling);
    plumb_shape_create(world, ball, &disc);
    for (int i = 1; i <= 120; ++i) {
        plumb_world_step(world, plumb_real(1.0 / 60));
        std::printf("%.3f s  %.3f m\n", i / 60.0, double(plumb_body_position(world, ball).y));
    }
    plumb_world_destroy(world);
}
END
cp tools/examples/*.c "$work"

# ---- pkg-config
export PKG_CONFIG_PATH=$lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root
try "pkg-config knows the version of base.h" \
    grep -q "\"$(pkg-config --modversion plumb)\"" include/plumb/base.h

build() # compiler standard source package static|shared
{
    local mode=() more=()
    [ "$5" = static ] && mode=(-static) && more=(--static)
    rm -f "$work/program"
    # Unquoted: pkg-config answers a list.
    "$1" -std="$2" $warnings "${mode[@]}" "$3" -o "$work/program" \
        $(pkg-config "${more[@]}" --cflags --libs "$4") &&
        LD_LIBRARY_PATH=$lib says_hello "$work/program"
}
for package in plumb plumb_d plumb_far; do
    for kind in shared static; do
        try "pkg-config, $package, $kind, C" build "$cc" c17 "$work/hello.c" $package $kind
        try "pkg-config, $package, $kind, C++" build "$cxx" c++17 "$work/hello.cpp" $package $kind
    done
done

build_all_examples()
{
    local source
    for source in "$work"/*.c; do
        [ "${source##*/}" = alone.c ] && continue
        "$cc" -std=c17 $warnings "$source" -o "$work/program" \
            $(pkg-config --cflags --libs plumb) || return 1
        LD_LIBRARY_PATH=$lib "$work/program" >"$work/out" && [ -s "$work/out" ] || return 1
    done
}
try "every example builds and runs" build_all_examples

# A program for one precision and the library of another must not link, whatever it begins with, and the
# linker must say which it is.
declare -A begins=(
    [world]='plumb_world *w; return plumb_world_create(0, &w);'
    [batch]='plumb_batch *b; return plumb_batch_create(0, &b);'
    [replay]='plumb_replay *r; return plumb_replay_open(0, 0, 0, &r);'
    [geometry]='plumb_vec2 p[3] = { { 0, 0 } }; return plumb_outline_area(p, 3) > 0;'
    [convex]='plumb_convex c; return plumb_convex_circle(plumb_v2(0, 0), 1, &c);'
    [numbers]='plumb_random r = { 0 }; return plumb_random_range(&r, 0, 1) > 2;'
    [math]='return plumb_atan2(0, 1) > 1;'
)
declare -A defines=([float]= [double]=-DPLUMB_DOUBLE=1 [far]=-DPLUMB_FAR=1)
declare -A libraries=([float]=libplumb [double]=libplumb_d [far]=libplumb_far)
links() # beginning library precision
{
    printf '#include <plumb/plumb.h>\nint main(void)\n{\n    %s\n}\n' "${begins[$1]}" >"$work/mixed.c"
    "$cc" -std=c17 $warnings ${defines[$3]} -I"$root$prefix/include" "$work/mixed.c" \
        -o "$work/program" "$lib/$2" -lm -lpthread
}
refuses() # beginning library precision
{
    ! links "$1" "$2" "$3" 2>"$work/said" && grep -q "undefined reference to .plumb_[a-z0-9_]*_$3'" "$work/said"
}
guarded() # beginning a|so
{
    local of in
    for of in float double far; do
        for in in float double far; do
            if [ $of = $in ]; then
                links "$1" "${libraries[$in]}.$2" $of || return 1
            else
                refuses "$1" "${libraries[$in]}.$2" $of || return 1
            fi
        done
    done
}
for begin in world batch replay geometry convex numbers math; do
    for suffix in a so; do
        try "$begin of one precision does not link with lib*.$suffix of another" guarded $begin $suffix
    done
done

# ---- CMake: the package must also work where the folder has been moved to
cmake_build() # BUILD_SHARED_LIBS
{
    rm -rf "$work/build"
    cmake -S "$work/project" -B "$work/build" -DCMAKE_PREFIX_PATH="$root$prefix" \
        -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DBUILD_SHARED_LIBS="$1" &&
        cmake --build "$work/build"
}
mkdir "$work/project"
cp "$work/hello.c" "$work/hello.cpp" "$work/project"
cat >"$work/project/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.16)
project(hello C CXX)
set(CMAKE_C_STANDARD 17)
set(CMAKE_CXX_STANDARD 17)
find_package(plumb 0.1 REQUIRED)
foreach(target plumb static shared static_double shared_double static_far shared_far)
    add_executable(c_${target} hello.c)
    add_executable(cpp_${target} hello.cpp)
    target_link_libraries(c_${target} plumb::${target})
    target_link_libraries(cpp_${target} plumb::${target})
endforeach()
END
needs_shared() # program
{
    ldd "$1" | grep -q libplumb
}
for shared in OFF ON; do
    try "CMake builds, BUILD_SHARED_LIBS=$shared" cmake_build $shared
    for program in "$work"/build/c_* "$work"/build/cpp_*; do
        try "CMake, ${program##*/}, BUILD_SHARED_LIBS=$shared, runs" says_hello "$program"
    done
    case $shared in
    ON) try "plumb::plumb is the shared library" needs_shared "$work/build/c_plumb" ;;
    OFF) try "plumb::plumb is the static library" bash -c "! ldd '$work/build/c_plumb' | grep libplumb" ;;
    esac
done
sed -i 's/find_package(plumb 0.1/find_package(plumb 7.0/' "$work/project/CMakeLists.txt"
try "CMake refuses a version that is not there" bash -c "! cmake -S '$work/project' -B '$work/build7' \
    -DCMAKE_PREFIX_PATH='$root$prefix'"

try "uninstalls" make --no-print-directory uninstall DESTDIR="$root" PREFIX=$prefix
try "leaves nothing behind" test ! -e "$root"

# ---- one precision alone, and what others had there stays
one=$work/one
mkdir -p "$one/usr/share/doc/other"
for precision in float double far; do
    declare suffix=${libraries[$precision]#libplumb}
    try "install-lib of $precision alone" make --no-print-directory install-lib DESTDIR="$one" PREFIX=/usr \
        PRECISION=$precision
    try "brings libplumb$suffix and no other" \
        test "$(cd "$one/usr/lib" && ls ./*.a pkgconfig | tr '\n' ' ')" = "./libplumb$suffix.a  pkgconfig: plumb$suffix.pc "
    try "uninstalls it" make --no-print-directory uninstall DESTDIR="$one" PREFIX=/usr
    try "and nothing else" test "$(cd "$one" && find . -type d | sort | tr '\n' ' ')" = \
        ". ./usr ./usr/share ./usr/share/doc ./usr/share/doc/other "
done
lists() # precision, pattern that is there, pattern that is not
{
    make -n -B --no-print-directory lib PRECISION="$1" O="$work/none" >"$work/plan" 2>&1
    grep -q "$2" "$work/plan" && ! grep -q "$3" "$work/plan"
}
try "make lib builds float alone" lists float none/float/src none/double/src
try "make lib builds double alone" lists double none/double/src none/far/src
demo_plan()
{
    make -n -B --no-print-directory demo O="$work/none" >"$work/plan" 2>&1
    grep -q none/float/src "$work/plan" && ! grep -qE 'none/(double|far|tests)' "$work/plan"
}
try "make demo builds float alone" demo_plan
try "an unknown precision is refused" bash -c "! make -n lib PRECISION=half 2>'$work/said' &&
    grep -q 'must be some of: float double far' '$work/said'"
for goal in lib uninstall install windows; do
    try "make help knows $goal" bash -c "make -s help | grep -qE '^  $goal( |\$)'"
done
[ $failures -eq 0 ]
