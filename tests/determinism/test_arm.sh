#!/bin/bash
# test_arm.sh - 64-bit ARM gives the bits of x86-64: what was recorded here is replayed there, by QEMU. Where neither is at hand (`make
# deps-dev` brings both), nothing is asked.
set -u

. tests/harness/try.sh
. tests/harness/trials.sh
skip_sanitized "the library is built for another machine"

cross=${CROSS_CC:-aarch64-linux-gnu-gcc}
machine=${CROSS_RUN:-qemu-aarch64}
for tool in "$cross" "$machine"; do
    if ! command -v "$tool" >/dev/null; then
        echo "ok - # SKIP $tool is not here"
        exit 0
    fi
done

# Stacks, impacts, joints solved together, ropes and skins, water, air, fields, cracks, characters, formulas.
scenes=(stack billiards ragdolls rope_bridge jelly_stairs dam_break bonfire solar_system demolition platformer windmill clock tackle
    balloons cyclotron drops)

defines=(float:)
trials_at_least 3 && defines+=(double:-DPLUMB_DOUBLE=1 far:-DPLUMB_FAR=1)

built() # precision flag
{
    # With all that the compiler may do to it, fused multiply-add among it.
    "$cross" -std=gnu17 -O2 -ffp-contract=fast -Wall -Wextra -Werror -static $2 -I"$O" "$O/plumb.c" tests/determinism/arm/play.c \
        -o "$work/play_$1" -lm -lpthread
}
recorded() # precision scene
{
    "$PLUMB_BIN" run -q --precision "$1" "assets/scenes/$2.lua" -t 2 --record "$work/$2.$1" -o /dev/null
}
replays() # precision scene
{
    "$machine" "$work/play_$1" "$work/$2.$1"
}

try "plumb.c is written" make --no-print-directory amalgamation
for define in "${defines[@]}"; do
    precision=${define%%:*}
    try "is built for ARM in $precision without a warning" built "$precision" "${define#*:}"
    for scene in "${scenes[@]}"; do
        try "$scene is recorded in $precision" recorded "$precision" "$scene"
        try "$scene has the same bits on ARM in $precision" replays "$precision" "$scene"
    done
done
[ $failures -eq 0 ]
