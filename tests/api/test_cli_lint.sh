#!/bin/bash
# test_cli_lint.sh - plumb check --lint: each rule finds the scene made for it, alone, tells what to do and is silent where the scene
# is mended or allows it; all rules are silent on the scenes of ours, which allow no more than is found.
set -u

bin=${PLUMB_BIN:-${O:-build}/plumb}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

ok()
{
    if [ "$1" = 0 ]; then echo "ok - $2"; else echo "not ok - $2"; sed 's/^/# /' "$work/said"; fi
}

# lints scene [options]: the rules that found something, in $found; the exit code in $code.
lints()
{
    "$bin" check --lint "$@" >"$work/said" 2>&1
    code=$?
    found=$(sed -n 's/^lint  [^:]*: \([a-z-]*\): .*/\1/p' "$work/said" | sort -u | tr '\n' ' ')
}

# rule "name" "what is wrong" "the same, mended" <<scene, in which @ is one of them
rule()
{
    local scene
    scene=$(cat)
    printf '%s\n' "${scene//@/$2}" >"$work/wrong.lua"
    printf '%s\n' "${scene//@/$3}" >"$work/right.lua"
    { echo "-- lint: allow $1: it is meant"; cat "$work/wrong.lua"; } >"$work/meant.lua"
    for precision in float double far; do
        lints "$work/wrong.lua" --precision $precision
        [ "$code" = 4 ] && [ "$found" = "$1 " ] && grep -q "^      to do: ." "$work/said"
        ok $? "$1 is found, alone, in $precision: $2"
        lints "$work/right.lua" --precision $precision
        [ "$code" = 0 ] && [ -z "$found" ]
        ok $? "$1 is silent in $precision: $3"
    done
    lints "$work/meant.lua"
    [ "$code" = 0 ] && [ -z "$found" ]
    ok $? "$1 is silent where the scene allows it"
    lints "$work/wrong.lua" --allow "$1"
    [ "$code" = 0 ]
    ok $? "$1 is silent where --allow says so"
    "$bin" help check | tr -s ' \n' ' ' | grep -q " $1: [a-z]"
    ok $? "$1 is in the help"
}

rule mass-ratio 100 10 <<'END'
body { type = "static", box { 10, 1 }, at = {0, -0.5} }
body { name = "light", box { 1, 1 }, mass = 1, at = {0, 0.5} }
body { name = "heavy", box { 1, 1 }, mass = @, at = {0, 1.5} }
END
rule mass-ratio 1000 20 <<'END'
local light = body { name = "light", circle { 0.2 }, mass = 1, at = {0, 0} }
local heavy = body { name = "heavy", circle { 0.2 }, mass = @, at = {0, -1} }
revolute { light, at = {0, 0} }
revolute { light, heavy, at = {0, -0.5} }
END
for how in "weld { hub, arm" "revolute { motor = { speed = 0, torque = 99 }, hub, arm"; do
    rule mass-ratio 1 16 <<END
scene { gravity = {0, 0} }
local hub = body { name = "hub", circle { 0.4 }, mass = @, apart = "rotor" }
revolute { hub, at = {0, 0}, motor = { speed = 3, torque = 1000 } }
for i = 0, 2 do
    local x, y = math.cos(2 * i), math.sin(2 * i)
    local arm = body { name = "arm" .. i, box { 2.6, 0.3 }, at = {1.7 * x, 1.7 * y}, angle = 2 * i, mass = 1, apart = "rotor" }
    $how, at = {0.4 * x, 0.4 * y} }
end
END
done
rule mass-ratio 0.5 4 <<'END'
scene { gravity = {0, 0} }
local hub = body { name = "hub", circle { 0.4 }, mass = @, apart = "rotor" }
local arm = body { name = "arm", box { 2.6, 0.3 }, at = {1.7, 0}, mass = 1, apart = "rotor" }
weld { hub, arm, at = {0.4, 0} }
weld { hub, at = {-0.4, 0} }
END
rule mass-ratio '{ hub, at = {-0.4, 0} }' '{ arm, at = {3, 0} }' <<'END'
scene { gravity = {0, 0} }
local hub = body { name = "hub", circle { 0.4 }, mass = 0.5, apart = "rotor" }
local arm = body { name = "arm", box { 2.6, 0.3 }, at = {1.7, 0}, mass = 1, apart = "rotor" }
weld { hub, arm, at = {0.4, 0} }
weld @
END
rule fast-and-thin 'velocity = {90, 0}' 'velocity = {90, 0}, continuous = true' <<'END'
body { name = "bullet", circle { 0.05 }, @, at = {-3, 2} }
body { name = "sheet", box { 0.05, 2 }, at = {0, 2} }
END
rule fast-and-thin '{-90, 0}' '{90, 0}' <<'END'
body { name = "bullet", circle { 0.05 }, velocity = {90, 0}, at = {-3, 2} }
body { name = "sheet", box { 0.05, 2 }, velocity = @, at = {0, 2} }
END
rule fast-and-thin '{-8, 0}' '{0, 0}' <<'END'
body { name = "ball", circle { 0.1 }, velocity = {8, 0}, at = {-3, 2} }
body { name = "other", circle { 0.02 }, velocity = @, at = {0, 2} }
END
rule fast-and-thin 0 90 <<'END'
scene { continuous = false }
body { name = "bullet", circle { 0.05 }, velocity = {90, 0}, at = {-3, 2} }
body { name = "wall", type = "kinematic", box { 0.05, 2 }, velocity = {@, 0}, at = {0, 2} }
END
rule stiff-spring 'frequency = 60, damping = 0.5' 'frequency = 5, damping = 0.5' <<'END'
local ball = body { name = "ball", circle { 0.2 }, at = {1, 0} }
distance { ball, at_a = {0, 0}, spring = { @ } }
END
rule stiff-spring 'stiffness = 1e5' 'stiffness = 1e3' <<'END'
local ball = body { name = "ball", circle { 0.2 }, mass = 1, at = {1, 0} }
distance { ball, at_a = {0, 0}, spring = { @ } }
END
rule stiff-spring 4e5 4e4 <<'END'
zone { electric = {@, 0} }
body { name = "needle", box { 0.6, 0.1 }, mass = 10, dipole = 0.1 }
END
rule filter-meets-none 'collides = {"ghost"}' 'collides = {}' <<'END'
body { type = "static", box { 10, 1 }, at = {0, -0.5} }
body { name = "ghost", circle { 0.2, category = "ghost", @ }, at = {0, 2} }
END
rule effect-on-none 0 10 <<'END'
local arm = body { name = "arm", box { 1, 0.1 }, at = {0, 3} }
revolute { arm, at = {-0.5, 3}, motor = { speed = 1, torque = @ } }
END
rule effect-on-none static dynamic <<'END'
local door = body { name = "door", box { 1, 0.1 }, damping = 2, at = {0, 3} }
door:set_type("@")
END
rule effect-on-none 'friction = 0' 'friction = 0.5' <<'END'
body { type = "static", box { 10, 1, material = material { @, surface_speed = 2 } }, at = {0, -0.5} }
END
rule effect-on-none 'kinetic_friction = 0.7' 'kinetic_friction = 0.4' <<'END'
body { type = "static", box { 10, 1, material = material { friction = 0.5, @ } }, at = {0, -0.5} }
END
rule effect-on-none 0.2 0 <<'END'
magnetic { strength = 1 }
body { name = "bar", box { 1, 0.1 }, dipole = @ }
END
rule overlap 0.4 0.5 <<'END'
body { type = "static", box { 10, 1 }, at = {0, -0.5} }
body { name = "crate", box { 1, 1 }, at = {0, @} }
END
for joint in revolute prismatic weld wheel; do
    rule far-anchor '{0, 0}' '{40.5, 1}' <<END
scene { gravity = {0, 0} }
local left = body { name = "left", box { 1, 1 }, at = {40, 1} }
local right = body { name = "right", box { 1, 1 }, at = {41, 1} }
$joint { left, right, at = @ }
END
done
rule size 0.004 0.04 <<'END'
body { name = "needle", box { 1, @ }, at = {0, 2} }
END
rule size 400 40 <<'END'
scene { gravity = {0, 0} }
body { name = "mountain", circle { @ }, at = {0, 2} }
END
rule units 'angle = 45' 'angle_deg = 45' <<'END'
body { name = "plank", box { 1, 0.1 }, at = {0, 2}, @ }
END
rule units '{-45, 45}' '{-0.8, 0.8}' <<'END'
local arm = body { name = "arm", box { 1, 0.1 }, at = {0.5, 2} }
revolute { arm, at = {0, 2}, limits = @ }
END
rule units 64 0.64 <<'END'
for i = 1, 3 do body { name = "crate" .. i, box { @, @ }, at = {100 * i, 0} } end
END
rule units -981 -9.81 <<'END'
scene { gravity = {0, @} }
body { name = "crate", box { 1, 1 } }
END
rule units 9.81 -9.81 <<'END'
scene { gravity = {0, @} }
body { name = "crate", box { 1, 1 } }
END
rule units up down <<'END'
scene { y = "@", gravity = {0, 9.81} }
body { name = "crate", box { 1, 1 } }
END
rule units 1 300 <<'END'
water { box { 18, 4 }, at = {0, -2} }
for i = 1, 3 do body { name = "log" .. i, box { 1, 1 }, density = @, at = {2 * i, 3} } end
END

# Far from the origin, for its size: a matter of precision.
echo 'body { name = "coin", circle { 0.02 }, at = {1e5, 2} }' >"$work/far.lua"
lints "$work/far.lua"
[ "$found" = "size " ]
ok $? "a coin at 100 km is rounded in float"
lints "$work/far.lua" --precision double
[ "$code" = 0 ]
ok $? "and is not in double"

lints "$work/far.lua" --allow thickness
[ "$code" != 0 ] && grep -q "there is no rule 'thickness'" "$work/said"
ok $? "a rule that is none cannot be allowed"

for precision in float double far; do
    lints assets/scenes/*.lua assets/scenes/*/*.lua --precision $precision
    ok $code "nothing is found in our scenes, in $precision"
done
grep -l '^-- lint: allow' assets/scenes/*.lua assets/scenes/*/*.lua | while read -r scene; do
    wanted=$(sed -n 's/^-- lint: allow \([a-z, -]*\):.*/\1/p' "$scene" | tr -d ' ' | tr ',' '\n' | sort -u | tr '\n' ' ')
    grep -v '^-- lint: allow' "$scene" >"$work/bare.lua"
    lints "$work/bare.lua"
    [ "$found" = "$wanted" ]
    ok $? "$scene allows what is found: $wanted"
done
