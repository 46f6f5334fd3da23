#!/bin/bash
# test_cli_watchdog.sh - plumb check --watchdog: each alarm is told of the scene made for it, with who, when, where and the last
# call; a scene without the fault, or that allows it, is silent; so are scenes of ours, here a cross-section of short ones.
# WATCHDOG_ALL=1: all of them that hold what they expect.
set -u

bin=${PLUMB_BIN:-${O:-build}/plumb}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

ok()
{
    if [ "$1" = 0 ]; then echo "ok - $2"; else echo "not ok - $2"; sed 's/^/# /' "$work/said"; fi
}

# watches scene [options]: the alarms that were told, in $found; the exit code in $code.
watches()
{
    "$bin" check --quiet --watchdog "$@" >"$work/said" 2>&1
    code=$?
    found=$(sed -n 's/^alarm [^:]*: \([a-z-]*\): .*/\1/p' "$work/said" | sort -u | tr '\n' ' ')
}

# alarm "kinds" "who, and what was called last" "what is wrong" "the same, mended" <<scene, in which @ is one of them
alarm()
{
    local scene kind=${1%% *} rest list
    scene=$(cat)
    list=$(echo "$1" | sed 's/ *$//; s/ /, /g')
    rest=${2#*; }
    printf '%s\n' "${scene//@/$3}" >"$work/wrong.lua"
    printf '%s\n' "${scene//@/$4}" >"$work/right.lua"
    { echo "-- watchdog: allow $list: it is meant"; cat "$work/wrong.lua"; } >"$work/meant.lua"
    for precision in float double far; do
        watches "$work/wrong.lua" --precision $precision
        [ "$code" = 4 ] && [ "$found" = "$1" ] && grep "^alarm wrong.lua: $kind: ${2%%; *}: " "$work/said" | grep -q "; $rest$" &&
            grep -q "^      to do: ." "$work/said"
        ok $? "$kind is told in $precision: $3"
        watches "$work/right.lua" --precision $precision
        [ "$code" = 0 ] && [ -z "$found" ]
        ok $? "silent in $precision: $4"
    done
    watches "$work/meant.lua"
    [ "$code" = 0 ] && [ -z "$found" ]
    ok $? "$kind is not told where the scene allows it"
    watches "$work/wrong.lua" --allow "${list// /}"
    [ "$code" = 0 ]
    ok $? "$kind is not told where --allow says so"
    "$bin" help check | tr -s ' \n' ' ' | grep -q " $kind: [a-z]"
    ok $? "$kind is in the help"
    { cat "$work/wrong.lua"; echo "expect { 'told', alarm = '$kind', alarms = {1, 1000} }"; } >"$work/expects.lua"
    "$bin" check --quiet "$work/expects.lua" >"$work/said" 2>&1
    ok $? "a scene may expect $kind, and watches itself then"
    { cat "$work/right.lua"; echo "expect { 'silent', alarms = 0 }"; } >"$work/expects.lua"
    "$bin" check --quiet "$work/expects.lua" >"$work/said" 2>&1
    ok $? "or expect silence: $4"
}

alarm "energy-jump runaway-speed " "'b'; last call plumb_body_teleport at step 30" 30 1.5 <<'END_OF_SCENE'
scene { duration = 0.6 }
local a = body { name = "a", box { 1, 0.2 }, at = {0.5, 0} }
local b = body { name = "b", box { 1, 0.2 }, at = {1.5, 0} }
revolute { b, at = {2, 0} }
revolute { a, b, at = {1, 0} }
at(0.5, function() if @ > 2 then b:teleport(@, 0) end end)
END_OF_SCENE
alarm "tunnelling " "'ball' and 'wall'; last call plumb_body_apply_force_center at step 6" false true <<'END_OF_SCENE'
scene { duration = 0.3, continuous = @, gravity = {0, 0} }
body { name = "wall", type = "static", box { 0.05, 4 }, at = {1, 0} }
local ball = body { name = "ball", circle { 0.05 }, mass = 1 }
at(0.1, function() ball:apply_force(20000, 0) end)
END_OF_SCENE
alarm "sinking " "'egg' and 'press'; last call plumb_body_set_mass at step 30" 1e5 2 <<'END_OF_SCENE'
scene { duration = 2, sleep = false, exact_islands = false }
body { name = "ground", type = "static", box { 40, 1 }, at = {0, -0.5} }
local egg = body { name = "egg", box { 1, 1 }, mass = 1, at = {0, 0.5} }
local press = body { name = "press", box { 4, 1 }, mass = 1, at = {0, 1.5} }
at(0.5, function() egg:set_mass(1.01) press:set_mass(@) end)
END_OF_SCENE
alarm "contact-without-touch " "'rod16' and 'pole16'; last call plumb_body_set_angular_velocity at step 0" 1 8 <<'END_OF_SCENE'
scene { duration = 1, dt = 1 / 20, substeps = @, gravity = {0, 0}, continuous = false }
body { name = "pole16", type = "static", box { 0.2, 0.2 } }
body { name = "rod16", box { 2, 0.1 }, at = {0, 1.04}, spin = 30 / @ }
END_OF_SCENE
alarm "pair-explosion " "'disc1'; last call plumb_body_teleport at step 6" 0.02 1.1 <<'END_OF_SCENE'
scene { duration = 0.11, gravity = {0, 0}, push_speed = 0.5 }
local discs = {}
for i = 1, 12 do discs[i] = body { name = "disc" .. i, circle { 0.5 }, at = {i * 1.1, 0} } end
at(0.1, function() for i = 1, 12 do discs[i]:teleport(i * @, 0) end end)
END_OF_SCENE
alarm "torn-joint " "'joint3' of 'link3'; last call plumb_joint_create at step 0" 5 0 <<'END_OF_SCENE'
scene { duration = 1.4 }
local last = body { name = "puller", type = "kinematic", box { 0.5, 0.1 }, at = {-0.25, 0}, velocity = {-@, 0} }
for i = 1, 20 do
    local link = body { name = "link" .. i, box { 0.5, 0.1 }, at = {0.5 * i - 0.25, 0}, mass = 1 }
    revolute { last, link, at = {0.5 * (i - 1), 0} }
    last = link
end
revolute { last, at = {10, 0} }
END_OF_SCENE

# Where places are rounded is a matter of precision.
cat >"$work/far.lua" <<'END_OF_SCENE'
scene { duration = 0.2, gravity = {0, 0} }
local crate = body { name = "crate", box { 1, 1 } }
at(0.1, function() crate:teleport(3e6, 0) end)
END_OF_SCENE
watches "$work/far.lua"
[ "$code" = 4 ] && grep -q "^alarm far.lua: out-of-scale: 'crate': .* in step 7, .*; last call plumb_body_teleport at step 6$" "$work/said"
ok $? "out-of-scale: a crate at 3000 km, in float"
watches "$work/far.lua" --precision double
[ "$code" = 0 ]
ok $? "and is not in double"
watches "$work/far.lua" --allow out-of-space
[ "$code" = 2 ] && grep -q "there is no alarm 'out-of-space'" "$work/said"
ok $? "an alarm that is none cannot be allowed"

# Other commands tell it as messages; a scene may ask for it itself.
"$bin" run --quiet --watchdog "$work/far.lua" -o "$work/out.csv" 2>"$work/said"
[ $? = 0 ] && grep -q "^plumb: alarm: far.lua: out-of-scale: 'crate': .*; to do: " "$work/said" && ! grep -q alarm "$work/out.csv"
ok $? "run tells alarms on stderr"
sed 's/scene {/scene { watchdog = true,/' "$work/far.lua" >"$work/own.lua"
"$bin" check --quiet "$work/own.lua" >"$work/said" 2>&1
[ $? = 0 ] && grep -q "^alarm own.lua: out-of-scale" "$work/said"
ok $? "check tells alarms of a scene that has a watchdog, and does not fail for them"
echo "expect { 'x', alarm = 'sinking' }" >"$work/wrong.lua"
"$bin" check "$work/wrong.lua" >"$work/said" 2>&1
[ $? = 3 ] && grep -q "needs 'alarms'" "$work/said"
ok $? "expect{} wants to know how many alarms"
echo "expect { 'x', alarm = 'drowning', alarms = 0 }" >"$work/wrong.lua"
"$bin" check "$work/wrong.lua" >"$work/said" 2>&1
[ $? = 3 ] && grep -q "there is no alarm 'drowning'" "$work/said"
ok $? "and of which kind"

# Scenes of ours, and what some allow.
scenes=(assets/scenes/{bath,billiards,blast,bounce_box,brick_breaker,clock,conveyor,crane,dominoes,elevator,joints,newtons_cradle}.lua
        assets/scenes/{pinball,platformer,projectile,ragdolls,slow_motion,stack,tiles,wind}.lua
        assets/scenes/hard/{books,capstan,confined,degenerate_needles,wedge_trap}.lua
        assets/scenes/accuracy/{atwood,bowl,chain_1e3,cycloid,gears,heavy_on_light,rod}.lua)
if [ -n "${WATCHDOG_ALL:-}" ]; then
    scenes=(assets/scenes/*.lua assets/scenes/*/*.lua)
fi
for scene in "${scenes[@]}"; do
    if [ ! -f "$scene" ] || grep -q "| *$(basename "$scene") *|" assets/scenes/*/open.txt; then
        continue
    fi
    watches "$scene"
    [ -z "$found" ]
    ok $? "$scene: nothing is told but what it allows"
    if wanted=$(sed -n 's/^-- watchdog: allow \([a-z, -]*\):.*/\1/p' "$scene" | tr -d ' ' | tr ',' '\n' | sort -u | tr '\n' ' ') && [ -n "$wanted" ]; then
        grep -v '^-- watchdog: allow' "$scene" >"$work/bare.lua"
        watches "$work/bare.lua"
        [ "$found" = "$wanted" ]
        ok $? "$scene allows what is told: $wanted"
    fi
done
