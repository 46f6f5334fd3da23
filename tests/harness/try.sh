# try.sh - what tests that build things have in common; sourced from the top of the tree. Leaves: a folder $work that
# goes with the test, try, the number of $failures.

# skip_sanitized "why": a sanitized run has nothing to add.
skip_sanitized()
{
    if [ -n "${SAN:-}" ]; then
        echo "ok - # SKIP $1"
        exit 0
    fi
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

# try "what it shows" command...: one TAP line; what the command said, when it failed.
try()
{
    local what=$1
    shift
    if "$@" >"$work/log" 2>&1; then
        echo "ok - $what"
    else
        echo "not ok - $what"
        sed 's/^/# /' "$work/log"
        failures=$((failures + 1))
    fi
}
