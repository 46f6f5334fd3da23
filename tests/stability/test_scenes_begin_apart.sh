#!/bin/bash
# test_scenes_begin_apart.sh - no scene of ours begins with bodies inside one another: `plumb` says nothing of any.

bin=${PLUMB_BIN:-${O:-build}/plumb}
for scene in assets/scenes/*.lua assets/scenes/accuracy/*.lua; do
    said=$("$bin" run "$scene" --time 0 -o /dev/null 2>&1)
    if [ -z "$said" ]; then
        echo "ok - $scene"
    else
        echo "not ok - $scene: $said"
    fi
done
