#!/bin/bash
# lint.sh - rules of this project that no compiler knows. Run through `make lint`, which builds the
# libraries first ($O is the build folder). One line for each breach; exit status 1 if there is any.
# README.md says why each rule is there. Notes (long files) are told and do not fail.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
export LC_ALL=C
O=${O:-build}
here=tools/lint
breaches=0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Reads lines from stdin; each is a breach of the rule named in $1.
breach()
{
    local line
    while IFS= read -r line; do
        echo "$1: $line"
        breaches=$((breaches + 1))
    done
}

sources() # folders...: C and C++ files below them
{
    find "$@" -type f \( -name '*.c' -o -name '*.h' -o -name '*.cpp' \) 2>/dev/null | sort
}

# ---- the tree

find . -mindepth 1 -maxdepth 1 ! -name '.*' ! -name build ! -path "./$O" -printf '%f\n' |
    grep -vxE 'Makefile|README.md|LICENSE|src|include|tests|tools|assets' |
    sed 's/$/ does not belong at the top level/' >"$work/out"
breach "top level" <"$work/out"

# Folders that hold files of their own. Seeds are found input, not text; include/ holds one folder.
find src include tools tests assets -type f ! -path 'tests/fuzz/seeds/*' -printf '%h\n' | sort -u |
    while IFS= read -r folder; do
        [ -e "$folder/README.md" ] || echo "$folder has no README.md"
    done >"$work/out"
breach "readme" <"$work/out"

# Each README names the files beside it. Tests of one unit or header are found by their names.
find src include tools tests -type f ! -path 'tests/fuzz/seeds/*' ! -path 'tests/unit/*' ! -path 'tests/api/*' \
    ! -name README.md | sort | while IFS= read -r file; do
        stem=${file##*/}
        grep -qE "(^|[^A-Za-z0-9_])${stem%%.*}\b" "${file%/*}/README.md" 2>/dev/null ||
            echo "${file%/*}/README.md does not name ${file##*/}"
    done >"$work/out"
for folder in src/*/ tests/*/; do
    grep -qE "\b$(basename "$folder")\b" "${folder%%/*}/README.md" || echo "${folder%%/*}/README.md does not name $folder"
done >>"$work/out"
breach "readme" <"$work/out"

sources src include tools tests | xargs wc -l | awk '
    $2 != "total" && $1 > 600 { print "note: " $2 " has " $1 " lines; 150 to 500 read best" }'

# ---- the text

sources src include tools tests >"$work/files"
xargs grep -nE '\b(TODO|FIXME|XXX)\b' <"$work/files" >"$work/out"
breach "unfinished" <"$work/out"
# Each .c file begins with what it is for, by name: "// grid.c - ..." or "/// grid.c - ...".
while IFS= read -r file; do
    head -n 1 "$file" | grep -qF "// ${file##*/} - " || echo "$file"
done < <(grep -E '\.(c|cpp|h)$' "$work/files") >"$work/out"
breach "header comment" <"$work/out"
# Each .c file includes its own header first: so that has all that it needs.
for file in src/*/*.c; do
    own=${file#src/}
    own=${own%.c}.h
    [ ! -e "src/$own" ] || grep -m 1 '^#include' "$file" | grep -qF "\"$own\"" || echo "$file: $own comes first"
done >"$work/out"
breach "own header" <"$work/out"
grep -rnIE '(^|[^A-Za-z])(/home/|/root/|/tmp/[a-z]+-build)' Makefile .ci src include \
    tools tests assets --exclude=lint.sh >"$work/out"
breach "machine path" <"$work/out"
grep -nE '^[^/"]*\b(gets|strcpy|strcat|sprintf|vsprintf|strtok|atoi|atol|atof|alloca|tmpnam)[ ]*\(' \
    $(sources src include tools tests) /dev/null >"$work/out"
breach "banned function" <"$work/out"
grep -nE '^\s*#\s*(pragma\s+(STDC\s+FP_CONTRACT\s+ON|GCC\s+optimize)|include\s*<(complex|tgmath|fenv)\.h>)' \
    $(sources src include) /dev/null >"$work/out"
breach "determinism" <"$work/out"

# What comments and READMEs name is there.
find . -name '.?*' -prune -o -path "./$O" -prune -o -path ./build -prune -o -type f -printf '%f\n' | sort -u >"$work/names"
xargs sed 's|//.*||' <"$work/files" | cat - Makefile tools/make/* | grep -oE '[A-Za-z_][A-Za-z0-9_]*' | sort -u >"$work/words"
{
    find src include tools tests assets -name README.md
    echo README.md
    cat "$work/files"
} | xargs awk -f $here/words.awk "$work/names" "$work/words" >"$work/out"
breach "named but nowhere" <"$work/out"

# Private words (private_words.txt), as a part of an identifier of the library or as the name of a file.
sources src | xargs awk '
    NR == FNR { if (!/^#/ && NF > 1) { word = $1; sub(/^[^ ]+ +/, ""); instead[word] = $0 } next }
    FNR == 1 {
        name = FILENAME
        sub(/.*\//, "", name)
        sub(/[.].*/, "", name)
        check(name)
    }
    {
        sub(/\/\/.*/, "")
        while (match($0, /[A-Za-z_][A-Za-z0-9_]*/)) {
            check(substr($0, RSTART, RLENGTH))
            $0 = substr($0, RSTART + RLENGTH)
        }
    }
    function check(identifier,    i, n, part) {
        if (identifier ~ /^plumb_/ || identifier in seen) {
            return
        }
        seen[identifier]
        n = split(tolower(identifier), part, "_")
        for (i = 1; i <= n; ++i) {
            if (part[i] in instead) {
                print FILENAME ":" FNR ": " identifier ": say " instead[part[i]]
            }
        }
    }' $here/private_words.txt >"$work/out"
breach "private word" <"$work/out"

# ---- the public interface: each function is documented and called by a test of tests/api, each result code is
# the outcome that one of them asks for

awk '/^PLUMB_API/ && before !~ /^\/\/\// && before !~ /^(PLUMB_API.*|  .*);$/ {
        sub(/^PLUMB_API /, ""); print FILENAME ": no comment with ///: " $0 }
    { before = $0 }' include/plumb/*.h >"$work/out"
breach "undocumented" <"$work/out"
cat include/plumb/*.h | tr '\n' ' ' | grep -oE 'PLUMB_API [^;(]*\(' | grep -oE 'plumb_[a-z0-9_]+ *\(' |
    tr -d ' (' | sort -u >"$work/public"
cat tests/api/*.[ch] >"$work/calls"
grep -oE 'plumb_[a-z0-9_]+ *\(' "$work/calls" | tr -d ' (' | sort -u | comm -23 "$work/public" - |
    sed 's/$/ is called by no test of tests\/api/' >"$work/out"
breach "untested" <"$work/out"
sed -n 's/^    X(\([A-Z_]*\),.*/\1/p' include/plumb/base.h | while IFS= read -r code; do
    grep -qE "PLUMB_$code\b|\b$code," "$work/calls" || echo "PLUMB_$code is asked for by no test of tests/api"
done >"$work/out"
breach "untested" <"$work/out"

# ---- layers: a folder knows those below it (layers.txt), by include and by call

sources src | while IFS= read -r file; do
    sed -n 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*"\([^"]*\)".*/\1/p' "$file" | while IFS= read -r name; do
        case $name in
        plumb/*) ;;
        */*) echo "include $file src/$name" ;;
        *) echo "$file includes $name without its folder" >>"$work/bare" ;;
        esac
    done
done >"$work/arrows"
[ ! -e "$work/bare" ] || breach "include direction" <"$work/bare"
# Of each symbol the object that defines it; then who calls it from elsewhere.
find "$O/float/src" -name '*.o' | sort | while IFS= read -r object; do
    source=${object#"$O/float/"}
    source=$(sed -E 's/(\.w[0-9]+)?\.o$/.c/' <<<"$source")
    [ ! -e "$source" ] || nm "$object" | awk -v source="$source" '{ print source, $(NF - 1), $NF }'
done >"$work/symbols"
awk 'NR == FNR { if ($2 ~ /^[TDBRC]$/) defined[$3] = $1; next }
    $2 == "U" && ($3 in defined) && defined[$3] != $1 { print "call", $1, defined[$3], $3 }' \
    "$work/symbols" "$work/symbols" >>"$work/arrows"
awk -f $here/layers.awk $here/layers.txt "$work/arrows" | sort -u >"$work/out"
breach "layers" <"$work/out"

# No header may include itself by a detour.
for file in $(sources src include | grep '\.h$'); do
    sed -n 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*"\([^"]*\)".*/\1/p' "$file" |
        sed "s|^|${file#*/} |"
done | tsort 2>&1 >/dev/null | grep -v 'contains a loop' | sed 's/^tsort: /in a cycle: /' >"$work/out"
breach "include cycle" <"$work/out"

# Public headers know nothing of src/; tools know the public headers, and of src/ the rows of the schema.
grep -nE '#\s*include\s*"' include/plumb/*.h | grep -v '"plumb/' >"$work/out"
grep -nE "#\s*include\s*\"($(find src -mindepth 1 -maxdepth 1 -type d ! -name schema -printf '%f|' | sed 's/|$//'))/" \
    $(sources tools) /dev/null >>"$work/out"
breach "include direction" <"$work/out"

# ---- the libraries

for lib in libplumb libplumb_d libplumb_far; do
    a=$O/$lib.a
    so=$O/$lib.so
    if [ ! -e "$a" ] || [ ! -e "$so" ]; then
        echo "$a or $so is not built" | breach "libraries"
        breaches=$((breaches + 1))
        continue
    fi

    nm -A --defined-only --extern-only "$a" | awk '$NF !~ /^(plumb|pl)_/ && NF >= 3' >"$work/out"
    breach "symbol without prefix" <"$work/out"
    nm -D --defined-only "$so" | awk '$NF !~ /^plumb_/ && $NF !~ /^(_init|_fini)$/' |
        sed "s|^|$so: |" >"$work/out"
    breach "symbol exported" <"$work/out"

    # Sections that can be written to; .data.rel.ro is constant once the addresses are filled in.
    objdump -t "$a" 2>/dev/null | awk '
        /file format/ { object = $1 }
        / [.](data|bss|tdata|tbss)| [*]COM[*]/ && !/[.]data[.]rel[.]ro/ && !/ d +[.]/ {
            print object " " $NF }' >"$work/out"
    breach "mutable global in $lib" <"$work/out"

    objdump -d --no-show-raw-insn "$a" 2>/dev/null | awk '
        /file format/ { object = $1 }
        /^[0-9a-f]+ </ { name = $2 }
        /\t(vfn?m(add|sub)|fn?m(add|sub)|fml[as])/ { print object " " name " " $2; }' |
        sort | uniq -c >"$work/out"
    breach "fused multiply-add in $lib" <"$work/out"

    # What the library takes from outside: allowed.txt, and nothing else.
    nm -A --undefined-only "$a" | awk '{ print $NF }' | sort -u | grep -vE '^(plumb|pl)_' |
        grep -vxF -f <(sed 's/#.*//; s/ *$//; /^$/d' $here/allowed.txt) >"$work/out"
    breach "function not in $here/allowed.txt, $lib" <"$work/out"
done

if [ $breaches -eq 0 ]; then
    echo "lint: clean"
else
    echo "lint: $breaches breaches"
    exit 1
fi
