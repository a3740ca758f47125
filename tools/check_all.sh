#!/bin/sh
# The structure checks that look at sources only, and the proof that each of them can fail.
#
# SPDX-License-Identifier: MIT
set -eu
tools=$(dirname "$0")
status=0
for check in includes names text spelling links version headers core_alone; do
    if python3 -B "$tools/check_$check.py"; then echo "check_$check: ok"; else status=1; fi
done
python3 -B "$tools/test_checks.py" || status=1
exit $status
