#!/bin/bash
# orders.sh - by what power of the step errors of smooth motion fall, in each solver, in double: a row is a scene and its line of
# expect{}, then the error at 60 Hz and log2 of what each halving divides it by. Run from the top of the tree.

bin=${PLUMB_BIN:-build/plumb}
here=assets/scenes/accuracy
rows=("kepler: the ellipse" "crossed_fields: the cycloid" "driven: the swing" "pendulum_rod: six periods"
    "pendulum_point: five periods" "bead_on_rod: the spiral" "motor_arm: the angle" "atwood: the way" "gears: the driving wheel"
    "spring_1hz: ten periods" "bowl: the amplitude" "cycloid: from high")

echo "| scene | soft | classic | exact |"
echo "|---|---|---|---|"
for row in "${rows[@]}"; do
    printf '| `%s`' "${row%%:*}"
    for solver in soft pgs exact; do
        for hz in 60 120 240 480; do
            "$bin" check -q --precision double --solver $solver --dt 1/$hz "$here/${row%%:*}.lua" |
                grep -F ".lua:${row#*:}" | sed -nE 's/.*\.error ([^ ]+) .*/\1/p' | head -1
        done | awk 'NR == 1 { printf " | %.1e:", $1 }
            NR > 1 && $1 >= 1e-9 { printf " %.2f", log(last / $1) / log(2) } { last = $1 }
            END { if (last < 1e-9) printf " rounding" }'
    done
    echo " |"
done
