#!/bin/bash
# test_runner.sh - tests/run.sh: what it counts, and what it stops: what hangs and what never ends, not what is slow.
set -u

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# What cmocka prints, before 1.1.7 and since.
for group in "" "tests: "; do
    printf '#!/bin/bash\nprintf "[  PASSED  ] %s3 test(s).\\n[  FAILED  ] %s2 test(s), listed below:\\n"; exit 2\n' \
        "$group" "$group" >"$work/program"
    chmod +x "$work/program"
    if bash tests/run.sh -l "$work/logs" "$work/program" | grep -q "^3 passed, 2 failed"; then
        echo "ok - counts what cmocka prints with '$group'"
    else
        echo "not ok - counts what cmocka prints with '$group'"
    fi
done

# says "what it shows" "words of the runner" script [options]: runs the script as a test.
says()
{
    local what=$1 words=$2 script=$3
    shift 3
    printf '%s\n' "$script" >"$work/one.sh"
    bash tests/run.sh "$@" -l "$work/logs" "$work/one.sh" >"$work/said" 2>&1
    if grep -q "$words" "$work/said"; then
        echo "ok - $what"
    else
        echo "not ok - $what"
        sed 's/^/# /' "$work/said"
    fi
}

says "counts what passes" "^2 passed, 0 failed" 'echo "ok - a"; echo "ok - b"'
says "counts what fails" "^1 passed, 1 failed" 'echo "ok - a"; echo "not ok - b"'
says "no test is a failure" "no test ran" 'true'
says "a status without a failure is one" "exit status 3" 'echo "ok - a"; exit 3'
says "a crash is a failure" "killed by signal 11" 'echo "ok - a"; kill -SEGV $$'
says "what waits for ever is stopped" "hung: no processor time for 1 s" 'echo "ok - a"; sleep 1000' -i 1
says "so is a child that does" "hung" 'echo "ok - a"; (sleep 1000; true) & wait' -i 1
says "what runs for ever is stopped" "more than 1 s of processor time" 'echo "ok - a"; while :; do :; done' -t 1
# Longer than it may be idle, in naps: a slow machine gives a test no more than this.
says "what is slow is not" "^1 passed, 0 failed" \
    'for i in 1 2 3 4 5 6; do sleep 1; for k in {1..30000}; do :; done; done; echo "ok - a"' -i 4
# A number of this run alone: another run of this test on the machine has its own.
nap=987$$
says "the rest of a test ends with it" "^1 passed, 1 failed" "echo 'ok - a'; sleep $nap & wait" -i 1
if grep -al "[s]leep.$nap" /proc/[0-9]*/cmdline 2>/dev/null | grep -q .; then
    echo "not ok - no child is left"
else
    echo "ok - no child is left"
fi

# A program that holds several tests: each has its own name and process, and what crashes is one of them.
for name in test_good test_bad; do
    printf '#include <stdio.h>\n#include <stdlib.h>\nint %s(void);\nint %s(void)\n{\n    %s\n    return 0;\n}\n' $name $name \
        "$([ $name = test_bad ] && echo 'abort();') puts(\"[  PASSED  ] 3 test(s).\");" >"$work/$name.c"
done
if ${CC:-gcc} -std=c17 -Itests "-DTESTS=TEST(test_good) TEST(test_bad)" tests/harness/main.c "$work"/test_*.c -o "$work/all" &&
    ln -s all "$work/test_good" && ln -s all "$work/test_bad" && ln -s all "$work/test_none"; then
    echo "ok - several tests are one program"
else
    echo "not ok - several tests are one program"
fi
bash tests/run.sh -l "$work/logs" "$work/test_bad" "$work/test_good" "$work/test_none" >"$work/said" 2>&1
for words in "^FAIL .*test_bad .*killed by signal 6" "^ok .*test_good .*3 passed" "^FAIL .*test_none .*exit status 2" \
    "^3 passed, 2 failed"; do
    if grep -q "$words" "$work/said"; then
        echo "ok - the runner says $words"
    else
        echo "not ok - the runner says $words"
        sed 's/^/# /' "$work/said"
    fi
done
