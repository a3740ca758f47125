#!/bin/sh
# Runs each fuzzing program for some seconds from its corpus:  tools/fuzz.sh FOLDER SECONDS
# New inputs are kept in FOLDER/found; a crash is written there too and ends the run with status 1.
#
# SPDX-License-Identifier: MIT
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
programs=0
for program in "$1"/fuzz_*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    name=$(basename "$program" | sed 's/^fuzz_//')
    found="$1/found/$name"
    mkdir -p "$found"
    corpus="$root/tests/fuzz/corpus/$name"
    [ -d "$corpus" ] || corpus=
    echo "== $name, $2 s"
    # shellcheck disable=SC2086 # no corpus, no word
    "$program" -max_total_time="$2" -timeout=10 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1 \
        -artifact_prefix="$found/" "$found" $corpus 2>&1 | tee "$found.log" | grep -E 'ERROR|SUMMARY|stat::number|DONE' || true
    if grep -q -E '^==[0-9]+==.*ERROR|SUMMARY: ' "$found.log"; then
        echo "fuzz: $name failed: see $found.log"
        exit 1
    fi
    programs=$((programs + 1))
done
echo "$programs fuzzing programs, no failure"
