#!/bin/bash
# headers.sh - how many objects of the float library a change of a header compiles anew, for the ten that most
# include: from the .d files of the last build. Run through `make headers`, which builds the library first.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
O=${O:-build}
find "$O/float/src" -name '*.o' | wc -l | sed 's/$/ objects of the float library; of them a change compiles anew:/'
find "$O/float/src" -name '*.d' -exec sed -sn '1,/[^\\]$/p' {} + | grep -oE '(src|include)/[a-z_/]+[.]h' |
    sort | uniq -c | sort -k1,1rn -k2 | head -n "${1:-10}"
