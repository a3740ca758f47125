#!/usr/bin/env python3
"""File names are snake_case and unique, so that a name alone says which file is meant; examples may begin with a number.

A .c and its .h share a name and a folder.  Folders of tests/data, corpora and documents are not looked at.

SPDX-License-Identifier: MIT
"""
import os
import re

import tree

SNAKE_CASE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")


def check(root):
    problems, owners = [], {}
    for name in tree.files(root, [".c", ".h", ".py"]):
        if name.startswith(("tests/data/", "tests/fuzz/corpus/")):
            continue
        folder, base = os.path.split(name)
        stem, suffix = os.path.splitext(base)
        if tree.top(name) == "examples":  # numbered in the order of reading
            stem = re.sub(r"^\d\d_", "", stem)
        if not SNAKE_CASE.fullmatch(stem.strip("_") if suffix == ".py" else stem):
            problems.append(f"{name}: file names are snake_case")
        if suffix == ".py":
            continue
        here = "include/facet" if folder.startswith("include") else folder
        owner = owners.setdefault(stem, (here, name))
        if owner[0] != here:
            problems.append(f"{name}: {owner[1]} has this name already")
    return problems


if __name__ == "__main__":
    tree.main(check)
