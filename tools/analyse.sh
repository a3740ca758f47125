#!/bin/sh
# Static analysis of the product: cppcheck, and clang-tidy with the checks of .clang-tidy.
#
# SPDX-License-Identifier: MIT
set -eu
cd "$(dirname "$0")/.."

cppcheck --quiet --std=c11 --language=c --enable=warning,portability --inline-suppr --error-exitcode=1 -j 2 \
    --suppressions-list=tools/cppcheck.txt -D__x86_64__ -D__GNUC__=12 -Iinclude -I. core render io cli
echo "cppcheck: ok"

# clang's own compile commands: gcc's have options that clang-tidy does not know.
cmake --preset sanitize >/dev/null
run-clang-tidy-14 -quiet -j 2 -p build/sanitize "$PWD/(core|render|io|cli)/" >build/clang-tidy.log 2>&1 || {
    grep -E -A 4 '(warning|error):' build/clang-tidy.log || cat build/clang-tidy.log
    exit 1
}
echo "clang-tidy: ok"
