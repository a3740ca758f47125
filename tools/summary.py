#!/usr/bin/env python3
"""The last line of a CI run:  tools/summary.py JUNIT.xml ... [FAILED STEP ...]

Sums what ctest and pytest recorded; a step that failed without a failed test counts as one failure, since a broken
build must not look like few tests.  Status 1 unless something passed and nothing failed.

SPDX-License-Identifier: MIT
"""
import sys
import xml.etree.ElementTree as xml


def main():
    passed = failed = skipped = 0
    for path in (a for a in sys.argv[1:] if a.endswith(".xml")):
        for suite in xml.parse(path).getroot().iter("testsuite"):
            bad = int(suite.get("failures", 0)) + int(suite.get("errors", 0))
            out = int(suite.get("skipped", 0)) + int(suite.get("disabled", 0))
            passed += int(suite.get("tests")) - bad - out
            failed += bad
            skipped += out
        for case in xml.parse(path).getroot().iter("testcase"):
            if case.get("status") == "fail" or case.find("failure") is not None or case.find("error") is not None:
                print(f"failed: {path}: {case.get('name')}")
    steps = [a for a in sys.argv[1:] if not a.endswith(".xml")]
    for step in steps:
        print(f"failed step: {step}")
    failed = max(failed, len(steps))
    if skipped:
        print(f"skipped: {skipped}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
