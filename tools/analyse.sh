#!/bin/sh
# Static analysis of the product: cppcheck, and clang-tidy with the checks of .clang-tidy.
#
# SPDX-License-Identifier: MIT
set -eu
cd "$(dirname "$0")/.."

cppcheck --quiet --std=c11 --language=c --enable=warning,portability --inline-suppr --error-exitcode=1 -j 2 \
    --suppressions-list=tools/cppcheck.txt -D__x86_64__ -D__GNUC__=12 -Iinclude -I. core verify render io plot cli python/native
echo "cppcheck: ok"

# clang's own compile commands: gcc's have options that clang-tidy does not know.
cmake --preset sanitize >/dev/null

tidy()
{
    xargs -P 2 -n 1 clang-tidy-14 --quiet -p build/sanitize "$@" 2>build/clang-tidy.log
}
status=0
find core verify render io plot cli -name '*.c' ! -path core/error.c ! -path io/json.c | sort |
    tidy --extra-arg=-include --extra-arg=tools/analyser.h --extra-arg=-Wno-unused-value || status=1
# These define what analyser.h makes macros of.
echo core/error.c io/json.c | tidy || status=1
if [ $status != 0 ]; then
    echo "clang-tidy: failed"
    exit 1
fi
echo "clang-tidy: ok"
