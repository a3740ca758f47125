#!/usr/bin/env python3
"""Everything that names facet's version names the same: what a release sets (CONTRIBUTING.md) is set everywhere.

CMakeLists.txt has it; the wheel, the site and pkg-config read it there.  The first heading of CHANGELOG.md is that version
with its date, or a later one that is not released yet.

SPDX-License-Identifier: MIT
"""
import os
import re

import tree

HEADING = re.compile(r"^## (\d+\.\d+\.\d+), (not released|\d{4}-\d\d-\d\d)$", re.M)
# Where it stands, and how.
PLACES = {
    "CMakeLists.txt": r"project\(facet VERSION ([0-9.]+)",
    "include/facet/facet.h": r"^/\* \"([0-9.]+)\"; static storage",
    "packaging/debian/changelog": r"^facet \(([0-9.]+)\)",
    "web/package.json": r'^  "version": "([0-9.]+)"',
    "web/package-lock.json": r'^  "version": "([0-9.]+)"',
    "docs/install.md": r"facet_([0-9.]+)_amd64\.deb",
}
MACROS = r"#define FACET_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)"


def numbers(version):
    return [int(x) for x in version.split(".")]


def check(root):
    problems, found = [], {}
    for name, pattern in PLACES.items():
        if not os.path.exists(os.path.join(root, name)):
            continue
        match = re.search(pattern, tree.read(root, name), re.M)
        if not match:
            problems.append(f"{name}: names no version; {pattern} is looked for")
            continue
        found[name] = match[1]
    version = found.get("CMakeLists.txt")
    if not version:
        return problems or ["CMakeLists.txt: is missing"]
    problems += [f"{name}: has version {other}; CMakeLists.txt has {version}"
                 for name, other in found.items() if other != version]
    header = ".".join(re.findall(MACROS, tree.read(root, "include/facet/facet.h")))
    if header != version:
        problems.append(f"include/facet/facet.h: its macros say {header}; CMakeLists.txt has {version}")
    headings = HEADING.findall(tree.read(root, "CHANGELOG.md"))
    if not headings:
        return problems + ["CHANGELOG.md: has no heading `## X.Y.Z, YYYY-MM-DD`, nor `## X.Y.Z, not released`"]
    newest, date = headings[0]
    if date == "not released" and numbers(newest) < numbers(version):
        problems.append(f"CHANGELOG.md: {newest} is not released, and CMakeLists.txt has {version} already")
    if date != "not released" and newest != version:
        problems.append(f"CHANGELOG.md: the newest release is {newest}; CMakeLists.txt has {version}")
    if [numbers(v) for v, _ in headings] != sorted((numbers(v) for v, _ in headings), reverse=True):
        problems.append("CHANGELOG.md: the newest version comes first")
    return problems


if __name__ == "__main__":
    tree.main(check)
