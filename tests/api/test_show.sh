#!/bin/bash
# test_show.sh - the example of SDL2 runs without a screen, and its picture shows what there is.
set -u
show=$O/examples/show
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
export SDL_VIDEODRIVER=dummy SDL_RENDER_DRIVER=software

check() # what, command...
{
    local what=$1
    shift
    if "$@"; then echo "ok - $what"; else echo "not ok - $what"; fi
}

# Pixels of one colour (RRGGBBAA of a BMP with 32 bits, bytes blue green red opacity).
pixels() # picture, bytes in hexadecimal
{
    od -An -v -tx1 -w4 -j122 "$1" | tr -d ' ' | grep -c "^$2"
}

between() # low, value, high
{
    [ "$2" -ge "$1" ] && [ "$2" -le "$3" ]
}

check "60 frames are drawn" "$show" --frames 60 "$out/show.bmp"
check "60 frames of all that can be drawn" "$show" --frames 60 "$out/all.bmp" all
check "a second run draws the same picture" "$show" --frames 60 "$out/again.bmp"
check "the same bytes" cmp -s "$out/show.bmp" "$out/again.bmp"
# 24 bricks of 0.6 m^2, 6 planks, a ball of 0.785 m^2 at 2844 pixels a square metre, less their outlines.
check "bricks, planks and ball are blue" between 35000 "$(pixels "$out/show.bmp" cd8c5c)" 49000
check "the ground is grey" between 35000 "$(pixels "$out/show.bmp" 8a8078)" 52000
check "the rest is night" between 250000 "$(pixels "$out/show.bmp" 211b18)" 330000
check "forces are red, where asked for" between 100 "$(pixels "$out/all.bmp" 5c6aec)" 5000
check "and else are not" between 0 "$(pixels "$out/show.bmp" 5c6aec)" 0
