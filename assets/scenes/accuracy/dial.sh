#!/bin/bash
# dial.sh - what the dial costs at 1e-3: for each scene its error and the instructions of its steps, and those of the cheapest fixed
# setting of solver, direct joints and substeps that is within 1e-3, too. Of the settings within it the four of the least time are
# counted (callgrind). Run from the top of the tree; other names of scenes may be given. Prints markdown; the last line is the
# median of the ratios. Errors are over the size of the truth; steps are the scene's, reals floats.

bin=${PLUMB_BIN:-build/plumb}
here=assets/scenes/accuracy
rungs=1,2,4,8,16,32,64
[ $# -gt 0 ] || set -- "$here"/*.lua

# A setting a line: solver, substeps, worst error of all quantities, seconds a second.
errors_of() {
    "$bin" cost -q "$1" --relative --csv --repeat 1 --budget 0.2 --precisions float --divide 1 "${@:2}" 2>/dev/null |
        awk -F, '$1 == "plumb" { k = $2 "\t" $4; e = ($NF == 1 ? 1e9 : $(NF - 15) + 0) # columns from the end: names have commas
                 if (!(k in worst) || e > worst[k]) worst[k] = e
                 time[k] = $(NF - 5) }
                 END { for (k in worst) print k "\t" worst[k] "\t" time[k] }'
}

# Millions of instructions in all steps of a scene.
millions_of() {
    valgrind --tool=callgrind --toggle-collect='plumb_world_step' --callgrind-out-file=/dev/null \
        "$bin" run -q "$1" --every 1000s -o /dev/null "${@:2}" 2>&1 | sed -nE 's/.*Collected : ([0-9]+).*/\1/p' | awk '{ print $1 / 1e6 }'
}

row_of() {
    local scene=$1 error=1e9 cost least='' name='' of=''
    error=$(errors_of "$scene" --solvers soft --substeps 4 --set accuracy=1e-3 | grep ^soft | cut -f3)
    cost=$(millions_of "$scene" --accuracy 1e-3)
    while IFS=$'\t' read -r solver substeps e _; do
        local now args=(--solver "$solver")
        [ "$solver" = direct ] && args=(--solver soft --set direct_joints=true)
        now=$(millions_of "$scene" "${args[@]}" --substeps "$substeps")
        if [ -z "$least" ] || awk -v a="$now" -v b="$least" 'BEGIN { exit !(a < b) }'; then
            least=$now name="$solver x $substeps" of=$e
        fi
    done < <(errors_of "$scene" --substeps $rungs | awk -F'\t' '$3 <= 1e-3' | sort -t$'\t' -k4g | head -4)
    awk -v scene="$(basename "$scene" .lua)" -v error="$error" -v cost="$cost" -v least="$least" -v name="$name" -v of="$of" 'BEGIN {
        printf "| `%s` | %.1e | %.3g | ", scene, error, cost
        if (name == "") print "none | | | |"
        else printf "%s | %.1e | %.3g | %s |\n", name, of, least, error <= 1e-3 ? sprintf("%.2f", cost / least) : "" }'
}

echo "| scene | error | million instructions | cheapest fixed | its error | million instructions | ratio |"
echo "|---|---|---|---|---|---|---|"
rows=
for scene in "$@"; do
    row=$(row_of "$scene")
    echo "$row"
    rows+=$row$'\n'
done
echo "$rows" | awk -F'|' '$8 + 0 > 0 { print $8 + 0 }' | sort -g | awk '
    { r[NR] = $1; below += $1 < 2 }
    END { printf "\nMedian of %d ratios: %.2f; %d below 2.\n", NR, NR % 2 ? r[(NR + 1) / 2] : (r[NR / 2] + r[NR / 2 + 1]) / 2, below }'
