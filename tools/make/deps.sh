#!/bin/bash
# deps.sh - installs those of the Debian packages named as arguments that are missing.
# Needs: dpkg and apt-get, root or sudo. Prints what it does in a few lines; apt's own words go to a
# log that is shown when something fails. Nothing missing: no network, no root, no output but a line.
set -euo pipefail

installed() # package
{
    dpkg-query -W -f '${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "deps: this is not Debian; please see to it that these are there: $*"
    exit 0
fi

missing=()
for package in "$@"; do
    installed "$package" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
    echo "deps: nothing is missing"
    exit 0
fi

root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "deps: missing: ${missing[*]}" >&2
        echo "deps: run as root, or install sudo: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    root=(sudo)
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT

apt() # arguments of apt-get
{
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q -o Acquire::Retries=3 \
        -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 "$@" 2>&1 </dev/null
}

echo "deps: installing ${missing[*]}"
# Lists from an earlier day may still serve when a mirror does not answer.
apt update >"$log" || { tail -n 5 "$log"; echo "deps: apt-get update failed, trying all the same"; }
if ! apt install --no-install-recommends "${missing[@]}" | tee -a "$log" | awk '
        /^Need to get|^After this operation/ { print "deps:   " $0; fflush() }
        /^Setting up/ { if (++n % 25 == 0) { print "deps:   " n " packages set up"; fflush() } }'; then
    tail -n 40 "$log" >&2
    echo "deps: apt-get install failed" >&2
    exit 1
fi
for package in "${missing[@]}"; do
    installed "$package" || { echo "deps: $package is still missing" >&2; exit 1; }
done
echo "deps: done in $SECONDS s"
