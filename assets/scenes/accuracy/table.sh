#!/bin/bash
# table.sh - measures the errors of README.md's table anew and writes them into it; run from the top of the tree.
# A row is the scene, its formula, the name of the expect{} line that is told, and four errors. With a name of a file, into that.

bin=${PLUMB_BIN:-build/plumb}
here=assets/scenes/accuracy
into=${1:-$here/README.md}
columns=("" "--substeps 16" "--solver pgs" "--solver exact")

for k in 0 1 2 3; do
    # shellcheck disable=SC2086 # options are words
    "$bin" check -q ${columns[k]} "$here"/*.lua | sed -nE \
        's/^(ok  |FAIL)  (.*)\.lua: (.*): [^:]*\.error ([^ ]+) ?([^(]*) ?\(.*/'"$k"'\t\2\t\3\t\4\t\5/p'
done | awk -F'\t' '
    NR == FNR { unit = $5; sub(/ +$/, "", unit); error[$1, $2, $3] = ($4 > 0 && $4 < 1e-12 ? "< 1e-12" : sprintf("%.2g", $4)) (unit == "" ? "" : " " unit); next }
    /^\| `/ && split($0, cell, / \| /) == 7 {
        scene = cell[1]; gsub(/[|` ]/, "", scene)
        printf "%s | %s | %s", cell[1], cell[2], cell[3]
        for (k = 0; k < 4; k++) printf " | %s", ((k, scene, cell[3]) in error) ? error[k, scene, cell[3]] : "not told"
        print " |"
        next
    }
    { print }' - "$here/README.md" > "$into.new" && mv "$into.new" "$into"
