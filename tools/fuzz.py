#!/usr/bin/env python3
"""Runs the fuzzing programs one after the other from their corpora, and says what they found.

    tools/fuzz.py FOLDER SECONDS [NAME ...]       SECONDS in all, divided over the programs

Inputs that reach something new are kept in FOLDER/found/NAME, one that fails as FOLDER/found/NAME.failure-*; then the
status is 1.  Every run adds a line to FOLDER/tally.csv: name, executions, processor seconds, edges, features, inputs.

SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FUZZ = os.path.join(ROOT, "tests", "fuzz")
# A failure of either kind is found by its file; these keep one input from holding the others up.
LIMITS = ["-timeout=20", "-report_slow_units=20", "-rss_limit_mb=3072", "-max_len=65536"]
STATUS = re.compile(r"^#(\d+)\s.*cov: (\d+) ft: (\d+) corp: (\d+)", re.M)


def find_programs(folder, names):
    """The programs of the folder, or those of the names."""
    paths = sorted(p for p in glob.glob(os.path.join(folder, "fuzz_*")) if os.access(p, os.X_OK) and "." not in p[-4:])
    found = {os.path.basename(p)[len("fuzz_"):]: p for p in paths}
    missing = [name for name in names if name not in found]
    if missing or not found:
        sys.exit(f"fuzz: {folder} has no program for {', '.join(missing) or 'anything'}; there are: {', '.join(found)}")
    return {name: found[name] for name in names} if names else found


def run(folder, name, program, seconds):
    """One program from its corpus; the figures of its run, and the failures it left."""
    kept = os.path.join(folder, "found", name)
    os.makedirs(kept, exist_ok=True)
    corpora = [kept] + [path for path in [os.path.join(FUZZ, "corpus", name)] if os.path.isdir(path)]
    words = os.path.join(FUZZ, "words", name + ".dict")
    command = [os.path.abspath(program), f"-max_total_time={seconds}", *LIMITS, "-close_fd_mask=3",
               f"-artifact_prefix={kept}.failure-", *corpora]
    if os.path.exists(words):
        command.append(f"-dict={words}")
    environment = dict(os.environ)
    environment.setdefault("ASAN_OPTIONS", "allocator_may_return_null=1:detect_leaks=1")
    environment.setdefault("LSAN_OPTIONS", f"suppressions={ROOT}/tools/lsan.supp:print_suppressions=0")
    log = kept + ".log"
    before = set(glob.glob(glob.escape(kept) + ".failure-*"))
    with open(log, "wb") as stream:
        child = subprocess.Popen(command, stdout=stream, stderr=subprocess.STDOUT, env=environment)
        _, status, usage = os.wait4(child.pid, 0)
    with open(log, encoding="utf-8", errors="replace") as stream:
        text = stream.read()
    states = STATUS.findall(text)
    executions, edges, features, inputs = map(int, states[-1]) if states else (0, 0, 0, 0)
    failures = sorted(set(glob.glob(glob.escape(kept) + ".failure-*")) - before)
    if status and not failures:
        failures = [f"status {os.waitstatus_to_exitcode(status)}"]
    return (executions, usage.ru_utime + usage.ru_stime, edges, features, inputs), failures, log


def main():
    if len(sys.argv) < 3 or not sys.argv[2].isdigit():
        sys.exit(__doc__)
    folder, total, names = sys.argv[1], int(sys.argv[2]), sys.argv[3:]
    programs = find_programs(folder, names)
    seconds = max(total//len(programs), 1)
    print(f"{len(programs)} programs, {seconds} s each")
    print(f"{'program':<16}{'executions':>12}{'CPU s':>8}{'edges':>8}{'features':>10}{'inputs':>8}  failures")
    has_failed = False
    for name, program in programs.items():
        figures, failures, log = run(folder, name, program, seconds)
        executions, cpu, edges, features, inputs = figures
        print(f"{name:<16}{executions:>12}{cpu:>8.0f}{edges:>8}{features:>10}{inputs:>8}  "
              f"{', '.join(failures) or 'none'}{f' (see {log})' if failures else ''}", flush=True)
        with open(os.path.join(folder, "tally.csv"), "a", encoding="utf-8") as tally:
            tally.write(f"{name},{executions},{cpu:.1f},{edges},{features},{inputs}\n")
        has_failed |= bool(failures)
    sys.exit(1 if has_failed else 0)


if __name__ == "__main__":
    main()
