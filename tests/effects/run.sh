#!/bin/bash
# run.sh - `make effects`: what each effect costs, in instructions a step by callgrind (cost.c) and in bytes of the library. A pile
# without any is run by the whole library, then by one without each; a pile with each, by the whole one. $O/effects.csv; exit 1
# where an effect that is not used costs more than 0.1 % of a step. ONLY="laws fluids": those alone.
set -u

O=${O:-build}
command -v valgrind >/dev/null || { echo "effects: needs valgrind: make deps-dev"; exit 1; }
at=$O/effects
mkdir -p "$at"

# build NAME EFFECTS: the library, and cost.c with it
build()
{
    env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS make --no-print-directory O="$at/$1" PRECISION=float EFFECTS="$2" \
        "$at/$1/libplumb.a" "$at/$1/libplumb.so" >"$at/log" 2>&1 &&
        ${CC:-gcc} -std=c17 -O2 -Iinclude tests/effects/cost.c "$at/$1/libplumb.a" -lm -lpthread -o "$at/$1/cost" ||
        { cat "$at/log"; exit 1; }
}

# instructions NAME EFFECT: a step
instructions()
{
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --collect-atstart=no --toggle-collect=measured_steps \
        "$at/$1/cost" "$2" 2>&1 | awk '/Collected/ { print int($NF / 60 + 0.5) }'
}

bytes()
{
    size "$at/$1/libplumb.so" | awk 'NR == 2 { print $1 + $2 }'
}

# An effect and those that it needs, a line each.
needs=$(tr -d '\\\n' <src/schema/effects.h | sed 's/"  *"//g; s/ X(/\n/g' |
    sed -n 's/^[A-Z_]*, *"\([a-z_]*\)", *"\([^"]*\)".*/\1 \2/p')

# without EFFECT: all, but for it and for who needs it
without()
{
    local out=" $1 " before= name of n
    while [ "$out" != "$before" ]; do
        before=$out
        while read -r name of; do
            for n in $of; do
                [[ $out == *" $n "* && $out != *" $name "* ]] && out="$out$name "
            done
        done <<<"$needs"
    done
    for n in $out; do printf ' -%s' "$n"; done | sed 's/^/all/'
}

build all all
build none none
effects=${ONLY:-$(sed -n 's/^ *X([A-Z_]*, "\([a-z_]*\)".*/\1/p' src/schema/effects.h)}
base=$(instructions all none)
whole=$(bytes all)
failures=0
echo "effect,bytes_without,bytes_of_it,instructions_unused,instructions_without,percent,instructions_used" >"$O/effects.csv"
printf '%-12s %10s %10s %14s %14s %8s %14s\n' effect "B without" "B of it" "a step unused" "compiled out" "%" "a step used"
for effect in $effects; do
    build "$effect" "$(without "$effect")"
    # Gravity is what the pile has: the one without lies in none.
    pile=none
    [ "$effect" = gravity ] && pile=nothing
    unused=$base
    [ "$pile" = nothing ] && unused=$(instructions all nothing)
    out=$(instructions "$effect" "$pile")
    used=$(instructions all "$effect")
    percent=$(awk -v a="$unused" -v b="$out" 'BEGIN { printf "%.3f", 100 * (a - b) / b }')
    left=$(bytes "$effect")
    awk -v p="$percent" 'BEGIN { exit !(p > 0.1) }' && failures=$((failures + 1))
    printf '%-12s %10d %10d %14d %14d %8s %14d\n' "$effect" "$left" $((whole - left)) "$unused" "$out" "$percent" "$used"
    echo "$effect,$left,$((whole - left)),$unused,$out,$percent,$used" >>"$O/effects.csv"
done
echo "whole library $whole B, none of them $(bytes none) B; a step of the pile without any $(instructions none nothing)"
echo "effects: $O/effects.csv"
[ "$failures" -eq 0 ] || { echo "effects: $failures cost more than 0.1 % where they are not used"; exit 1; }
