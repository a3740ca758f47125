#!/usr/bin/env python3
"""libfacet's symbols: every global name begins with facet_, and all that the public headers declare is there.

    tools/check_symbols.py libfacet.so libfacet.a [ROOT]

SPDX-License-Identifier: MIT
"""
import re
import subprocess
import sys

import tree

DECLARED = re.compile(r"\bFACET_API\b[^;(]*?\b(facet_\w+)\s*\(")


def symbols(command):
    """Names of defined global symbols; versions of a shared library are absolute symbols and left out."""
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    rows = [line.split() for line in done.stdout.splitlines()]
    return {row[-1].split("@")[0] for row in rows if len(row) >= 2 and row[-2] != "A"}


def declared(root):
    names = set()
    for name in tree.files(root, [".h"]):
        if tree.top(name) == "include":
            text = tree.read(root, name)
            mask = tree.code_mask(text)
            names |= {m.group(1) for m in DECLARED.finditer(text) if mask[m.start()]}
    return names


def check(root, shared, static):
    exported = symbols(["nm", "-D", "--defined-only", shared])
    inside = symbols(["nm", "-g", "--defined-only", static])
    problems = [f"{shared}: exports {name}, which does not begin with facet_"
                for name in sorted(exported) if not name.startswith("facet_")]
    problems += [f"{static}: {name} is global and does not begin with facet_: make it static, or rename it"
                 for name in sorted(inside) if not name.startswith("facet_")]
    problems += [f"{shared}: {name} is declared in include/ and not exported"
                 for name in sorted(declared(root) - exported)]
    return problems


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(tree.report(check(sys.argv[3] if len(sys.argv) > 3 else tree.default_root(), sys.argv[1], sys.argv[2])))
