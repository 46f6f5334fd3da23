#!/bin/bash
# test_format.sh - the tree is as clang-format lays it out, where the version is here by which that is judged.
set -u

words=$(make --no-print-directory format-check 2>&1)
if [ $? -ne 0 ]; then
    echo "not ok - the tree is formatted"
    sed 's/^/# /' <<<"$words"
elif [ -n "$words" ]; then
    echo "ok - # SKIP $words"
else
    echo "ok - the tree is formatted"
fi
