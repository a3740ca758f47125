#!/usr/bin/env python3
"""Text files are portable and finished: no tabs, trailing blanks, carriage returns or machine paths; sources carry
one SPDX line and neither disabled code nor unfinished work.

SPDX-License-Identifier: MIT
"""
import os
import re

import tree

TEXT = (".c", ".h", ".py", ".sh", ".md", ".txt", ".cmake", ".json", ".map", ".supp", ".svg", ".yml", ".js", ".mjs",
        ".ts", ".tsx", ".css", ".html", ".glsl", ".gltf", ".clang-format", ".clang-tidy", ".gitignore", "Makefile", ".ci/run")
SOURCES = (".c", ".h", ".py", ".sh", ".js", ".mjs", ".ts", ".tsx", ".css", ".glsl")
GENERATED = ("tests/data/", "tests/fuzz/corpus/", "bench/results/")
TABS_ALLOWED = ("Makefile",)
C_COLUMNS = 120

MACHINE_PATH = re.compile(r"(?<![\w./<>{}$-])/(?:%s)/\w" % "|".join(("home", "Users", "work", "root", "mnt", "media")))
UNFINISHED = re.compile(r"\b(?:%s)\b" % "|".join(("TO" "DO", "FIX" "ME", "XX" "X", "HA" "CK")))
DISABLED = re.compile(r"^\s*#\s*if\s+0\b")


def check_line(name, line):
    if line.rstrip("\r") != line:
        yield "carriage return"
    if "\t" in line and not os.path.basename(name).startswith(TABS_ALLOWED):
        yield "tab"
    if line != line.rstrip():
        yield "trailing blank"
    if MACHINE_PATH.search(line):
        yield "absolute path of one machine"
    if name.endswith(SOURCES):
        if UNFINISHED.search(line):
            yield "unfinished work is not committed"
        if DISABLED.match(line):
            yield "disabled code is removed"
    if name.endswith((".c", ".h")) and len(line) > C_COLUMNS:
        yield f"longer than {C_COLUMNS} columns"


def check(root):
    problems = []
    for name in tree.files(root, TEXT):
        if name.startswith(GENERATED):
            continue
        text = tree.read(root, name)
        if text and not text.endswith("\n"):
            problems.append(f"{name}: the last line has no end")
        for number, line in enumerate(text.split("\n"), 1):
            problems += [f"{name}:{number}: {what}" for what in check_line(name, line)]
        # A line of its own, however the language marks a comment.
        n_licences = len(re.findall(r"^\W*SPDX-License-Identifier: MIT\W*$", text, re.M))
        if name.endswith(SOURCES) and n_licences != 1:
            problems.append(f"{name}: {n_licences} lines `SPDX-License-Identifier: MIT`; there must be one")
    return problems


if __name__ == "__main__":
    tree.main(check)
