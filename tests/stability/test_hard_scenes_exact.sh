#!/bin/bash
# test_hard_scenes_exact.sh - with the exact solver all hard cases hold: in float some that are quick, or were crowds; TRIALS=3: all of
# them (six minutes), in float and double.

. tests/harness/trials.sh

bin=${PLUMB_BIN:-${O:-build}/plumb}
folder=assets/scenes/hard

# Those that take more than three seconds.
slow=' ball_pit_shaken capstan card_house mass_densities pyramid_100 ragdoll_pile rush substeps_confined '

# The scenes to be taken, as paths.
chosen() {
    local i=0 scene name
    for scene in "$folder"/*.lua; do
        name=$(basename "$scene" .lua)
        if trials_at_least 3; then
            echo "$scene"
        elif [[ $slow != *" $name "* ]]; then
            [[ $((i++ % 5)) = 0 || $name = confined || $name = degenerate_needles ]] && echo "$scene"
        fi
    done
}

mapfile -t scenes < <(chosen)
precisions=float
if trials_at_least 3; then
    precisions='float double'
fi
for precision in $precisions; do
    "$bin" check --quiet --precision "$precision" --set solver=exact "${scenes[@]}" 2>/dev/null |
        awk -v precision="$precision" -v least=$((${#scenes[@]} * 3 / 2)) '
            /^ok / { print "ok - " precision " " substr($0, 7); ++lines }
            /^(FAIL|none) / { print "not ok - " precision " " substr($0, 7); ++lines }
            END { if (lines < least) print "not ok - " precision ": only " lines + 0 " expectations were judged" }'
done
