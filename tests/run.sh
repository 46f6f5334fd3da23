#!/bin/bash
# run.sh - runs test programs and sums up.
#
#   tests/run.sh [-j jobs] [-t cpu-seconds] [-i idle-seconds] [-l log-folder] program-or-script ...
#
# Understands what cmocka prints and, from scripts (*.sh), TAP lines "ok ..." and "not ok ...".
# replay_fuzz_X gets the files of tests/fuzz/seeds/X. A program that is not there, crashes, never
# ends, fails without saying which test, or holds no test at all counts as one failed test. What
# fails is printed in full. No clock stops a test, for a machine may be slow: a process has -t seconds of
# processor time, and what takes none for -i seconds, with all its children, hangs. The last line is "N passed, N failed"; exit status 1 if any failed.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/.."

jobs=2
seconds=3600
idle=300
logs=${O:-build}/test-logs
while getopts j:t:i:l: option; do
    case $option in
    j) jobs=$OPTARG ;;
    t) seconds=$OPTARG ;;
    i) idle=$OPTARG ;;
    l) logs=$OPTARG ;;
    *) exit 2 ;;
    esac
done
shift $((OPTIND - 1))

O=$(realpath -m "${O:-build}")
export O PLUMB_BIN="$O/plumb" SAN=${SAN:-}
export LC_ALL=C
# Of the make that called: its job server is not ours.
unset MAKEFLAGS MFLAGS MAKELEVEL
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1:strict_string_checks=1}
export LSAN_OPTIONS=${LSAN_OPTIONS:-suppressions=$PWD/tests/lsan.supp:print_suppressions=0}
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
export TSAN_OPTIONS=${TSAN_OPTIONS:-suppressions=$PWD/tests/tsan.supp}
ulimit -c 0

rm -rf "$logs"
mkdir -p "$logs"

# Adds up what one log says: "passed failed".
count() # log program
{
    awk -v script="${2##*.}" '
        { gsub(/\033\[[0-9;]*m/, "") }
        script == "sh" && /^ok( |$)/     { passed++ }
        script == "sh" && /^not ok( |$)/ { failed++ }
        # cmocka 1.1.7 puts the name of the group in front of the number.
        script != "sh" && /^\[  (PASSED|FAILED)  \] ([a-z]+: )?[0-9]+ test\(s\)/ {
            number = $4 ~ /:$/ ? $5 : $4
            if ($2 == "PASSED") passed += number; else failed += number
        }
        END { print passed + 0, failed + 0 }' "$1"
}

# Processor time of a process and all that it began, in ticks: "time pid pid ...".
family() # pid
{
    cat /proc/[0-9]*/stat 2>/dev/null | awk -v first="$1" '
        { pid = $1; sub(/^.*\) /, ""); parent[pid] = $2; time[pid] = $12 + $13 + $14 + $15 }
        END {
            for (p in parent) {
                for (a = p; a != first && a in parent; a = parent[a]) { }
                if (a == first) { sum += time[p]; all = all " " p }
            }
            print sum + 0 all
        }'
}

# Ends a process that takes no processor time any more. Asked ten times while it may be idle.
watch_over() # pid file-that-says-so
{
    local before=-1 still=0 now pids rest=
    trap 'kill $rest 2>/dev/null; exit' TERM
    while true; do
        sleep "$(awk "BEGIN { print $idle / 10 }")" &
        rest=$!
        wait $rest
        rest= # its number may be that of another by now
        read -r now pids < <(family "$1")
        if [ "$now" = "$before" ]; then still=$((still + 1)); else still=0; fi
        before=$now
        if [ $still -ge 10 ]; then
            : >"$2"
            kill -KILL $pids 2>/dev/null
            exit
        fi
    done
}

# Runs one, writes "passed failed" to <log>.sum and prints its line, all at once.
run_one() # program
{
    local program=$1 name log status=0 passed failed note= start=$SECONDS
    name=${program#"$O"/}
    name=${name#"${O#"$PWD"/}"/}
    log=$logs/${name//\//.}.log
    local command=("./$program") seeds
    [[ $program == /* ]] && command=("$program")
    case $program in
    *.sh) command=(bash "$program") ;;
    */replay_fuzz_*)
        seeds=tests/fuzz/seeds/${program##*/replay_fuzz_}
        mapfile -t seeds < <(find "$seeds" -type f ! -name README.md 2>/dev/null | sort)
        command+=("${seeds[@]}")
        ;;
    esac

    if [ ! -e "$program" ]; then
        echo "$program was not built" >"$log"
        passed=0 failed=1 note="not built"
    else
        # The shell's own remark about a crash is of no use.
        {
            (ulimit -St "$seconds" && exec "${command[@]}") >"$log" 2>&1 </dev/null &
            local pid=$!
            watch_over $pid "$log.hangs" >/dev/null 2>&1 </dev/null &
            local watcher=$!
            wait $pid || status=$?
            kill $watcher && wait $watcher
        } 2>/dev/null
        read -r passed failed < <(count "$log" "$program")
        case $program in
        */replay_fuzz_*) [ $((passed + failed)) -eq 0 ] && [ $status -eq 0 ] && passed=1 ;;
        esac
        if [ -e "$log.hangs" ]; then
            failed=$((failed + 1)) note="hung: no processor time for $idle s"
        elif [ $status -eq 152 ]; then
            failed=$((failed + 1)) note="took more than $seconds s of processor time"
        elif [ $status -gt 128 ]; then
            failed=$((failed + 1)) note="killed by signal $((status - 128))"
        elif [ $status -ne 0 ] && [ "$failed" -eq 0 ]; then
            failed=1 note="exit status $status"
        elif [ $((passed + failed)) -eq 0 ]; then
            failed=1 note="no test ran"
        fi
    fi
    echo "$passed $failed" >"$log.sum"

    {
        flock 9
        if [ "$failed" -eq 0 ]; then
            printf 'ok    %-44s %4d passed %17d s\n' "$name" "$passed" $((SECONDS - start))
        else
            printf -- '---- %s\n' "$name"
            cat "$log"
            printf 'FAIL  %-44s %4d passed %4d failed %4d s  %s\n' "$name" "$passed" "$failed" \
                $((SECONDS - start)) "$note"
        fi
    } 9>"$logs/.lock"
}

running=0
for program in "$@"; do
    if [ $running -ge "$jobs" ]; then
        wait -n
        running=$((running - 1))
    fi
    run_one "$program" &
    running=$((running + 1))
done
wait

passed=0
failed=0
count=0
shopt -s dotglob # a program of another folder
for sum in "$logs"/*.sum; do
    [ -e "$sum" ] || continue
    read -r p f <"$sum"
    passed=$((passed + p)) failed=$((failed + f)) count=$((count + 1))
done
# A runner that lost a program, or was given none, has not shown anything.
if [ $count -ne $# ] || [ $count -eq 0 ]; then
    echo "run.sh: $count of $# test programs left a result" >&2
    failed=$((failed + 1))
fi
echo "$passed passed, $failed failed" | tee "$logs/summary"
[ $failed -eq 0 ]
