#!/usr/bin/env python3
"""The core needs no build system: `cc -Iinclude -c core/*.c` is enough, with any C compiler and none of our flags.

Tried with each of cc, gcc and clang that is installed, in an empty folder; then a program of ten lines is linked
with the objects and run.

SPDX-License-Identifier: MIT
"""
import glob
import os
import shutil
import subprocess
import tempfile

import tree

PROGRAM = r"""
#include <stdio.h>
#include "facet/facet.h"
int main(void)
{
    facet_material material;
    facet_bsdf bsdf;
    const float up[3] = {0, 0, 1};
    float f[3];
    if (facet_material_parse("ggx alpha=.5", &material, NULL) || facet_bsdf_prepare(&material, &bsdf, NULL)) return 1;
    facet_bsdf_eval(&bsdf, up, up, f);
    printf("%s %a\n", facet_version(), (double)f[0]);
    return !(f[0] > 0);
}
"""


def compilers():
    """One path for each compiler that is really another program."""
    found = {}
    for name in (os.environ.get("CC", "cc"), "gcc", "clang", "clang-14"):
        path = shutil.which(name)
        if path:
            found.setdefault(os.path.realpath(path), path)
    return list(found.values())


def run(command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode == 0:
        return None
    lines = [line for line in done.stderr.splitlines() if "error" in line or "undefined" in line]
    return f"{os.path.basename(command[0])}: {(lines or done.stderr.splitlines() or ['status %d' % done.returncode])[0]}"


def check(root, program=PROGRAM):
    problems, sources = [], sorted(glob.glob(os.path.join(os.path.abspath(root), "core", "*.c")))
    include = "-I" + os.path.join(os.path.abspath(root), "include")
    if not sources:
        return ["core/ has no sources"]
    if not compilers():
        return ["no C compiler was found"]
    for compiler in compilers():
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "program.c"), "w", encoding="ascii") as stream:
                stream.write(program)
            objects = [os.path.basename(source)[:-2] + ".o" for source in sources]
            wrong = run([compiler, include, "-c"] + sources, folder) or \
                run([compiler, include, "program.c"] + objects + ["-lm", "-o", "program"], folder) or \
                run([os.path.join(folder, "program")], folder)
            if wrong:
                problems.append(wrong)
    return problems


if __name__ == "__main__":
    tree.main(check)
