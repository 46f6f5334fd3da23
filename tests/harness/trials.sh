# trials.sh - what trials.h is to tests in C; sourced by shell tests.

# trials_at_least N: whether the run was asked for so many times as much as usual (TRIALS=3).
trials_at_least()
{
    awk -v asked="${TRIALS:-1}" -v least="$1" 'BEGIN { exit !(asked >= least) }'
}
