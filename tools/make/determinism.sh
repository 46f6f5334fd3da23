#!/bin/bash
# determinism.sh - `make determinism`: the shipped scenes end in the same bits whatever the compiler,
# optimisation level, sanitizer, SIMD width and number of threads. Builds tests/determinism once for each
# row of the matrix below $O/determinism, runs it, and prints a table: a cell is a checksum of the hashes
# of all scenes, and each column must hold one value, the same for all widths and threads. Exit status 1 on
# any difference.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
export LC_ALL=C
O=${O:-build}/determinism
jobs=${JOBS:-2}
unset MAKEFLAGS MFLAGS MAKELEVEL

# name, compiler, flags, sanitizers
matrix=(
    "gcc -O0|gcc|-O0|"
    "gcc -O2|gcc|-O2|"
    "gcc -O3|gcc|-O3|"
    "gcc -O3 native|gcc|-O3 -march=native|"
    "gcc -O1 ASan|gcc|-O1|address"
    "clang -O0|clang|-O0|"
    "clang -O2|clang|-O2|"
    "clang -O3|clang|-O3|"
    "clang -O3 native|clang|-O3 -march=native|"
    "clang -O1 ASan|clang|-O1|address"
)

mkdir -p "$O"
results=$O/results
: >"$results"
for row in "${matrix[@]}"; do
    IFS='|' read -r name cc flags san <<<"$row"
    if ! command -v "$cc" >/dev/null; then
        echo "determinism: $cc is missing: $name is left out" >&2
        continue
    fi
    folder=$O/${name// /}
    programs=("$folder/tests/determinism/test_scene_hashes"
        "$folder/tests-double/determinism/test_scene_hashes"
        "$folder/tests-far/determinism/test_scene_hashes")
    if ! make -j"$jobs" O="$folder" CC="$cc" CFLAGS="$flags" SAN="$san" "${programs[@]}" \
        >"$folder.log" 2>&1; then
        tail -n 20 "$folder.log" >&2
        echo "determinism: $name does not build" >&2
        exit 1
    fi
    for program in "${programs[@]}"; do
        # precision solver asked->used,threads scene steps hash
        if ! "$program" --table >"$folder.out"; then
            echo "determinism: $program failed" >&2
            exit 1
        fi
        sed "s|^|${name// /_} |" "$folder.out" >>"$results"
    done
    echo "determinism: $name has run" >&2
done

awk '
    {
        build = $1; column = $2 " " $3; width = $4; scene = $5
        if (!(build in seen_build)) { seen_build[build] = 1; builds[++build_count] = build }
        if (!(width in seen_width)) { seen_width[width] = 1; widths[++width_count] = width }
        if (!(column in seen_column)) { seen_column[column] = 1; columns[++column_count] = column }
        scenes[scene] = 1
        sum[build, column, width] = sum[build, column, width] $7
        key = column " " scene
        if (!(key in first)) { first[key] = $7; where[key] = build " width " width }
        ++runs
        if ($7 != first[key]) {
            differences[++bad] = key ": " $7 " with " build " width " width ", " first[key] \
                " with " where[key]
        }
    }
    # A short name for a long text of hexadecimal digits.
    function short(text,   i, value) {
        value = 7
        for (i = 1; i <= length(text); ++i)
            value = (value * 31 + index("0123456789abcdef", substr(text, i, 1))) % 4294967291
        return sprintf("%08x", value)
    }
    END {
        printf "%-16s %-8s", "build", "lanes,th"
        for (c = 1; c <= column_count; ++c) printf " %-12s", columns[c]
        print ""
        for (b = 1; b <= build_count; ++b)
            for (w = 1; w <= width_count; ++w) {
                printf "%-16s %-8s", builds[b], widths[w]
                for (c = 1; c <= column_count; ++c)
                    printf " %-12s", short(sum[builds[b], columns[c], widths[w]])
                print ""
            }
        for (s in scenes) ++scene_count
        printf "%d runs of %d scenes, %d differences\n", runs, scene_count, bad + 0
        for (i = 1; i <= bad; ++i) print differences[i]
        exit bad > 0 || runs == 0
    }' "$results"
