#!/bin/bash
# test_referee.sh - the judge of `make stability`: what handlers do is brought over to other engines; each expectation is judged
# for each engine; what cannot be brought over has its reason; hard scenes ask for poses alone; a cross-section of them.

referee=${O:-build}/referee
work=$(mktemp -d "${TMPDIR:-/tmp}/plumb-referee-XXXXXX")
trap 'rm -rf "$work"' EXIT
failed=0
tell() # status, what
{
    if [ "$1" -eq 0 ]; then echo "ok - $2"; else echo "not ok - $2"; failed=1; fi
}
# A row of the CSV by scene, expectation, engine, settings.
row() { grep "^$1,\"$2\"," "$work/out/table.csv" | grep ",$3,\"$4\"," ; }

# Each goes wrong if one thing is brought over wrongly.
cat > "$work/motor.lua" <<'LUA'
scene { duration = 2, gravity = {0, 0}, sleep = false }
local wheel = body { name = "wheel", circle { 1 }, mass = 1 }
local hinge = revolute { wheel, at = {0, 0} }
at(0.5, function() hinge:set_motor(1, 1e4) end)
at(1.5, function() hinge:set_motor(0, 1e4) end)
expect { "turned for a second", body = "wheel", angle = 1, tolerance = 0.05 }
LUA
cat > "$work/lift.lua" <<'LUA'
scene { duration = 2 }
local lift = body { name = "lift", type = "kinematic", box { 2, 0.2 } }
body { name = "load", box { 0.5, 0.5 }, at = {0, 0.35} }
at(0.5, function() lift:set_velocity(0, 1) end)
at(1.5, function() lift:set_velocity(0, 0) end)
expect { "the lift went up", body = "lift", y = 1, tolerance = 0.03 }
expect { "with its load", body = "load", y = 1.35, tolerance = 0.05 }
LUA
cat > "$work/drawn.lua" <<'LUA'
scene { duration = 2 }
body { type = "static", box { 9, 1 }, at = {0, -0.5} }
local below = body { name = "below", box { 1, 1 }, at = {0, 0.5} }
body { name = "above", box { 1, 1 }, at = {0, 1.5} }
at(0.5, function() below:destroy() end)
expect { "it fell", body = "above", y = 0.5, tolerance = 0.05 }
LUA
cat > "$work/pill.lua" <<'LUA'
scene { duration = 2 }
body { type = "static", box { 9, 1 }, at = {0, -0.5} }
body { name = "pill", capsule { 1, 0.2 }, at = {0, 0.5} }
expect { "a capsule lies on its side", body = "pill", y = 0.2, tolerance = 0.03 }
LUA
cat > "$work/open.lua" <<'LUA'
scene { duration = 3, gravity = {0, 0}, sleep = false }
local a = body { name = "a", box { 1, 0.2 }, at = {0.5, 0}, mass = 1 }
revolute { world, a, at = {0, 0} }
a:teleport(0.6, 0)
expect { "a joint that begins open closes", body = "a", x = 0.5, tolerance = 0.01 }
expect { "its gap is told", at = 0.016, max_joint_error = 0.001 }
LUA
cat > "$work/slide.lua" <<'LUA'
scene { duration = 3, sleep = false }
local a = body { name = "a", box { 1, 1 }, mass = 1 }
prismatic { world, a, axis = {0, 1}, limits = {-2, 1} }
expect { "it falls to its stop", body = "a", y = -2, tolerance = 0.05 }
LUA
cat > "$work/split.lua" <<'LUA'
scene { duration = 1, gravity = {0, -10} }
body { name = "a", circle { 0.5 } }
split_step(4)
expect { "shorter steps", body = "a", y = -5, tolerance = 0.03 }
LUA
cat > "$work/lost.lua" <<'LUA'
scene { duration = 1, gravity = {0, 0} }
local a = body { name = "a", circle { 0.5 } }
every_step(function(t) if t > 0.2 then a:set_velocity(1e30, 0) end end)
expect { "it stays", body = "a", x = {-1, 1} }
LUA
cat > "$work/endless.lua" <<'LUA'
scene { duration = 1e6, gravity = {0, 0} }
body { name = "a", circle { 0.5 } }
local n = 0
every_step(function() for i = 1, 1000 do n = n + i end end)
expect { "it ends", body = "a", x = 0, tolerance = 1 }
LUA
cat > "$work/orbit.lua" <<'LUA'
scene { duration = 0.5, gravity = {0, 0} }
body { name = "b", circle { 0.5 }, at = {1, 0} }
field { body = "b", function(x, y) return -x, -y end }
expect { "it comes nearer", body = "b", x = {0, 0.99} }
LUA
"$referee" --folder "$work/out" --limit 2 --jobs 2 "$work"/*.lua > "$work/told" 2> "$work/messages"
tell $? "all scenes are run: $(grep -c 'referee:' "$work/messages")"
engines=$(grep -c '^| [A-Z].* of .* of ' "$work/out/table.md") # rows of the summary
for scene in motor lift drawn pill slide split; do
    good=$(grep "^$scene," "$work/out/table.csv" | grep -c ',yes,judged,')
    all=$(grep -c "^$scene," "$work/out/table.csv")
    [ "$all" -ge "$engines" ] && [ "$good" -eq "$all" ]
    tell $? "$scene: holds for every engine: $good of $all"
done
[ "$(grep '^open,"a joint that begins open closes"' "$work/out/table.csv" | grep -c ',yes,judged,')" -eq "$engines" ]
tell $? "a joint that begins open is closed by every engine"
row open "its gap is told" "Chipmunk 7" "10 iterations" | grep -q ',no,judged,' # which takes its time
tell $? "and its gap is seen in the places that another engine moved: $(row open 'its gap is told' 'Chipmunk 7' '10 iterations')"
grep -q '  its gap is told .* x 0' "$work/told"
tell $? "what does not hold is marked in the table"
grep '^lost,' "$work/out/table.csv" | grep ',Chipmunk 7,"10 iterations",' | grep -q ',no,'
tell $? "a motion without end does not hold"
[ "$(grep '^endless,' "$work/out/table.csv" | grep -c ',no,slow,')" -eq "$engines" ]
tell $? "what takes too long does not hold, and says so"
grep '^orbit,' "$work/out/table.csv" | grep ',Chipmunk 7,"10 iterations",' | grep -q ',,,,lacks,"field{}"'
tell $? "what cannot be brought over has a dash and its reason"
grep -q '| Chipmunk 7 | 10 iterations | [0-9]* of 9 | .* | field{} (1) |' "$work/out/table.md"
tell $? "and does not count: $(grep '| Chipmunk 7 | 10 iter' "$work/out/table.md")"
! grep -q $'\033' "$work/told"
tell $? "no colours but on a terminal"

for arguments in "" "--jobs" "--jobs x a.lua" "--limit -1 a.lua" "--engines nobody a.lua" "--engines plumb,nobody a.lua" "--what 1 a.lua"; do
    # shellcheck disable=SC2086 # words
    "$referee" $arguments > "$work/told" 2> "$work/messages"
    [ $? -eq 2 ] && grep -q '^usage: referee' "$work/messages"
    tell $? "refused: '$arguments'"
done
"$referee" --folder "$work/out" --engines plumb "$work/none.lua" > "$work/told" 2> "$work/messages"
[ $? -eq 3 ] && grep -q 'none.lua' "$work/messages"
tell $? "a scene that is not there"

# Poses alone: no velocities, energies, forces, nothing that a solver says of itself.
! grep -nE 'max_speed|min_speed|max_spin|max_penetration|energy_drift|momentum_drift|reaction|alarms|:velocity\(|:spin\(|:speed\(|[^_]energy\(|momentum\(|:force\(|:torque\(|:rate\(' \
    assets/scenes/hard/*.lua tests/referee/*.lua
tell $? "no hard scene asks for more than poses"
! grep -nE 'expect *\{.*[ ,{](vx|vy|speed|spin) *=' assets/scenes/hard/*.lua tests/referee/*.lua
tell $? "nor does an expectation"

# A cross-section: what every engine has words for, what statics decides, what no iterative solver holds as it comes.
hard=assets/scenes/hard
"$referee" --folder "$work/out" --jobs 2 $hard/mass_press.lua $hard/books_overhang.lua $hard/cantilever_8.lua \
    $hard/dt_microsecond.lua $hard/truss.lua $hard/chain_swing_100.lua > "$work/told" 2> "$work/messages"
grep -q '^Plumb  *exact  *passes  *6 of  *6 scenes' "$work/told"
tell $? "the exact tier holds all of the cross-section: $(grep 'exact ' "$work/told" | tail -n 1)"
grep '^mass_press,"the ram rests' "$work/out/table.csv" | grep ',Box2D 2.4.1,"8 and 3 iterations",' | grep -q ',no,judged,'
tell $? "and Box2D as it comes lets the ram through"

"$referee" --folder "$work/out" --engines plumb --sweeps tests/referee --limit 10 --jobs 2 $hard/mass_press.lua > "$work/told" 2> "$work/messages"
tell $? "sweeps are run"
[ "$(grep -c '^"heavy on light",ratio,' "$work/out/sweeps.csv")" -ge 8 ]
tell $? "and are in a CSV file"
if command -v gnuplot > /dev/null; then
    grep -q '</svg>' "$work/out/sweeps.svg" && [ -s "$work/out/sweeps.png" ]
    tell $? "charts are drawn"
fi
exit $failed
