#!/bin/bash
# test_cost_suite.sh - what `make cost` brings over to other engines is the same scene: each gets near its truth when its steps
# become short; what cannot be brought over is told by a letter with the reason; hostile arguments are refused.

suite=${O:-build}/cost-suite
frozen=${O:-build}/cost-frozen
work=$(mktemp -d "${TMPDIR:-/tmp}/plumb-suite-XXXXXX")
trap 'rm -rf "$work"' EXIT
failed=0
tell() # status, what
{
    if [ "$1" -eq 0 ]; then echo "ok - $2"; else echo "not ok - $2"; failed=1; fi
}

# Each a quantity that goes wrong if one thing is brought over wrongly: velocity, masses, inertia, centre of mass, friction,
# restitution, springs, rods, slides, handlers, groups.
cat > "$work/throw.lua" <<'LUA'
scene { duration = 1 }
body { name = "b", circle { 0.5 }, velocity = {3, 4} }
exact { "b", body = "b", x = function(t) return 3 * t end, y = function(t) return 4 * t - 4.905 * t * t end }
LUA
cat > "$work/slide.lua" <<'LUA'
scene { duration = 1 }
local rough, smooth = material { friction = 0.9 }, material { friction = 0.1 }
body { name = "ground", type = "static", box { 40, 1 }, at = {0, -0.5}, material = rough }
body { name = "b", box { 1, 0.2 }, at = {0, 0.1}, velocity = {6, 0}, material = smooth, fixed_rotation = true, sleep = false }
exact { "b", body = "b", vx = function(t) return 6 - 0.3 * 9.81 * t end }
LUA
cat > "$work/hit.lua" <<'LUA'
scene { duration = 1, gravity = {0, 0} }
local hard, soft = material { restitution = 0.5, friction = 0 }, material { restitution = 0.2, friction = 0 }
body { name = "a", circle { 0.5 }, at = {-2, 0}, velocity = {4, 0}, mass = 3, material = hard }
body { name = "b", circle { 0.5 }, at = {0, 0}, mass = 1, material = soft, sleep = false }
exact { "b", body = "b", vx = function() return 4.5 end, at = 1 }
LUA
cat > "$work/spring.lua" <<'LUA'
scene { duration = 1, gravity = {0, 0} }
body { name = "b", box { 1, 1 }, mass = 3, at = {0.5, 0}, sleep = false }
prismatic { "b", at = {0.5, 0}, axis = {1, 0}, spring = { frequency = 1, damping = 0.1, rest = -0.5 } }
local w, z = 2 * math.pi, 0.1
local d = w * math.sqrt(1 - z * z)
exact { "b", body = "b", y = function() return 0 end, x = function(t)
    return 0.5 * math.exp(-z * w * t) * (math.cos(d * t) + z * w / d * math.sin(d * t))
end }
LUA
cat > "$work/pendulum.lua" <<'LUA'
scene { duration = 2 }
body { name = "rod", box { 2, 0.1, at = {1, 0} }, apart = "all", sleep = false }
body { name = "other", type = "static", box { 1, 1 }, at = {1, -1}, apart = "all" }
local hinge = revolute { "rod", at = {0, 0} }
local m = find("rod"):mass()
local function due() -- by the angle: 5/2 m g sin along, 1/4 m g cos across
    local a = find("rod"):angle()
    local along, across = 2.5 * math.sin(a), math.cos(a) / 4
    return m * 9.81 * math.sqrt(along * along + across * across)
end
exact { "bears", scale = 3 * m * 9.81, from = 0.1, value = function() return 0 end,
        measure = function() return hinge:reaction() - due() end }
exact { "energy", scale = m * 9.81, value = function() return 0 end, measure = function()
    local kinetic, potential = energy() return kinetic + potential
end }
LUA
cat > "$work/push.lua" <<'LUA'
scene { duration = 1, gravity = {0, 0} }
local b = body { name = "b", circle { 0.5 }, mass = 2, sleep = false }
every_step(function() b:apply_force(6, 0) b:apply_torque(0.5) end)
at(0.5, function() b:set_velocity(0, 1) end)
exact { "b", body = "b", from = 0.6, vx = function(t) return 3 * (t - 0.5) end, vy = function() return 1 end }
LUA
cat > "$work/orbit.lua" <<'LUA'
scene { duration = 0.5, gravity = {0, 0} }
body { name = "b", circle { 0.5 }, at = {1, 0} }
field { body = "b", function(x, y) return -x, -y end }
exact { "b", body = "b", x = function(t) return math.cos(t) end, y = function() return 0 end }
LUA
cat > "$work/geared.lua" <<'LUA'
scene { duration = 0.1 }
body { name = "a", circle { 1 } }
body { name = "b", circle { 1 }, at = {3, 0} }
gear { revolute { "a", at = {0, 0} }, revolute { "b", at = {3, 0} }, ratio = 2 }
exact { "a", body = "a", angle = function() return 0 end }
LUA

"$suite" --folder "$work/out" --budget 0.02 --repeat 1 "$work"/*.lua > "$work/told" 2> "$work/messages"
tell $? "all scenes are measured: $(tail -n 1 "$work/messages")"
for scene in throw slide hit spring pendulum push; do
    # Columns: scene, then Plumb and the others for 1 %.
    row=$(grep "^| \`$scene\` |" "$work/out/table.md" | cut -d'|' -f3-5)
    echo "$row" | grep -q -- ' - ' && reached=1 || reached=0
    [ -n "$row" ] || reached=1
    tell $reached "$scene: every engine is within 1 %: $row"
done
grep -q '^| `orbit` |.* - [a-z] |' "$work/out/table.md"
tell $? "what cannot be brought over has a letter"
grep -q 'not brought over: field{}' "$work/out/table.md" && grep -q 'not brought over: gear' "$work/out/table.md"
tell $? "and the letter its reason"
[ "$(grep -c . "$work/out/throw.csv")" -gt 20 ] && head -n 1 "$work/out/throw.csv" | grep -q '^engine,solver,dt'
tell $? "settings are in a CSV file"
if command -v gnuplot > /dev/null; then
    grep -q '</svg>' "$work/out/cost.svg" && [ -s "$work/out/cost.png" ] && grep -q '</svg>' "$work/out/hit.svg"
    tell $? "charts are drawn"
fi
for arguments in "" "--budget" "--budget x a.lua" "--budget -1 a.lua" "--repeat 0 a.lua" "--what 1 a.lua"; do
    # shellcheck disable=SC2086 # words
    "$suite" $arguments > "$work/told" 2> "$work/messages"
    [ $? -eq 2 ] && grep -q '^usage: cost' "$work/messages"
    tell $? "refused: '$arguments'"
done
"$suite" --folder "$work/out" "$work/none.lua" > "$work/told" 2> "$work/messages"
[ $? -ne 0 ] && grep -q 'none.lua' "$work/messages"
tell $? "a scene that is not there"

# Contact problems against their exact answer: sweeps of the soft step get there on a pile, where nothing touches is no problem.
cat > "$work/pile.scene" <<'LUA'
scene { duration = 1 }
body { name = "ground", type = "static", box { 20, 1 }, at = {0, -0.5} }
for i = 1, 3 do body { box { 1, 1 }, at = {0, i - 0.5} } end
LUA
"$frozen" --folder "$work/out" "$work/pile.scene" > "$work/told" 2> "$work/messages"
tell $? "frozen problems are studied: $(tail -n 1 "$work/messages")"
errors=$(grep 'soft, k sweeps' "$work/out/frozen.csv" | head -n 7 | cut -d, -f7)
echo "$errors" | awk '{ if (NR == 1) first = $1; last = $1 } END { exit !(NR == 7 && first > 0.1 && last < 1e-3 * first) }'
tell $? "each sweep brings the soft step nearer: $(echo $errors)"
"$frozen" --folder "$work/out" "$work/throw.lua" > "$work/told" 2> "$work/messages"
[ $? -ne 0 ] && grep -q 'contact problem' "$work/messages"
tell $? "where nothing touches there is no problem"
"$frozen" --folder "$work/out" "$work/none.lua" > "$work/told" 2> "$work/messages"
[ $? -ne 0 ] && grep -q 'none.lua' "$work/messages"
tell $? "nor in a scene that is not there"
"$frozen" > "$work/told" 2> "$work/messages"
[ $? -eq 2 ] && grep -q '^usage: cost-frozen' "$work/messages"
tell $? "frozen: no scene at all"
"${O:-build}/cost-sizes" 40 > "$work/told" 2> "$work/messages"
awk -F'|' '/^\| (chain|pyramid|net)/ { n++; bad += !($5 > 0 && $6 > 0 && $10 <= 1e-9) || $11 != 0 } END { exit !(n == 5 && bad == 0) }' "$work/told"
tell $? "sizes: five islands of up to 40 bodies, each solved to its tolerance: $(tail -n 1 "$work/told")"
"${O:-build}/cost-sizes" some > "$work/told" 2> "$work/messages"
[ $? -eq 2 ] && grep -q '^usage: cost-sizes' "$work/messages"
tell $? "sizes: not a number of bodies"
exit $failed
