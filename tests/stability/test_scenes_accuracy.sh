#!/bin/bash
# test_scenes_accuracy.sh - the reference suite: every scene of assets/scenes/accuracy keeps to the errors that it had, in float
# and double; bounds bite: an orbit whose force acts once a step does not keep to them; and the table of its README is what is
# measured.

bin=${PLUMB_BIN:-${O:-build}/plumb}
scenes=(assets/scenes/accuracy/*.lua)

for precision in float double; do
    said=$("$bin" check -q --precision $precision "${scenes[@]}" 2>&1)
    for scene in "${scenes[@]}"; do
        name=$(basename "$scene")
        lines=$(grep -F "  $name: " <<<"$said")
        if [ -z "$lines" ]; then
            echo "not ok - $name in $precision: nothing was checked"
        elif bad=$(grep -v '^ok  ' <<<"$lines"); then
            echo "not ok - $name in $precision: $bad"
        else
            echo "ok - $name in $precision"
        fi
    done
done

if [ ${#scenes[@]} -ge 40 ]; then
    echo "ok - ${#scenes[@]} scenes"
else
    echo "not ok - only ${#scenes[@]} scenes"
fi
if "$bin" check -q assets/scenes/accuracy/kepler.lua --set once=1 | grep -q '^FAIL'; then
    echo "ok - an orbit by forces once a step is told"
else
    echo "not ok - an orbit by forces once a step passes"
fi

made=$(mktemp -d)
PLUMB_BIN=$bin bash assets/scenes/accuracy/table.sh "$made/README.md"
if diff "$made/README.md" assets/scenes/accuracy/README.md; then
    echo "ok - the table is what table.sh measures"
else
    echo "not ok - the table is not what table.sh measures"
fi
rm -r "$made"
