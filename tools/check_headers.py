#!/usr/bin/env python3
"""Every header compiles alone: the public one as C11 and strict C++17, the others as C11 and as C++17 with the
compiler's extensions (designated initialisers, compound literals), and the kernels, which are C only, as C11 for
float and double.

Two kinds of file are no headers: *_text.h and *_cases.h, which others include several times under other macros,
and core/kernel/kmath_*.h, the parts of kmath.h.  The compilers are $CC (cc) and $CXX (c++); without a C++ compiler
that half is left out, and said so.

SPDX-License-Identifier: MIT
"""
import fnmatch
import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import tree

COMMON = ["-fsyntax-only", "-Wall", "-Wextra", "-Wshadow", "-Werror", "-fopenmp-simd", "-D_POSIX_C_SOURCE=200809L",
          "-D_DEFAULT_SOURCE", "-ffp-contract=off"]
KERNELS = "core/kernel/"
PARTS = ("core/*_text.h", "render/*_text.h", "python/*_text.h", "core/kernel/kmath_*.h", "tests/*_text.h", "tests/*_cases.h")
# A kernel's static functions are there for whoever includes it.
KERNEL_FLAGS = ["-Wno-unused-function"]


def variants(name, cxx):
    """(what, compiler and flags) for each way in which the header is used."""
    c = [os.environ.get("CC", "cc"), "-x", "c", "-std=c11", "-Wpedantic", "-Wstrict-prototypes"]
    if name.startswith(KERNELS):
        yield "C11, float", c + KERNEL_FLAGS
        yield "C11, double", c + KERNEL_FLAGS + ["-DFACET_REAL_IS_DOUBLE=1"]
        return
    yield "C11", c
    if cxx:
        if name.startswith("include/"):
            yield "C++17", [cxx, "-x", "c++", "-std=c++17", "-Wpedantic"]
        else:
            yield "C++17", [cxx, "-x", "c++", "-std=gnu++17"]


def compile_alone(root, name, what, command):
    # Through standard input, since `#pragma once` in a main file is a warning.
    done = subprocess.run(command + COMMON + ["-I", os.path.join(root, "include"), "-I", root, "-"], text=True,
                          capture_output=True,
                          input=f'#include "{os.path.join(root, name)}"\ntypedef int not_empty;\n')
    if done.returncode == 0:
        return None
    lines = [line for line in done.stderr.splitlines() if "error" in line] or done.stderr.splitlines()
    return f"{name}: does not compile alone as {what}: {lines[0] if lines else 'no message'}"


def check(root):
    cxx = os.environ.get("CXX", "c++")
    if not shutil.which(cxx):
        print("note: no C++ compiler was found: headers are not checked as C++ (Debian package g++)")
        cxx = None
    names = [n for n in tree.files(root, [".h"]) if tree.top(n) in tree.PRODUCT_FOLDERS + ["python", "tests", "bench"]]
    names = [n for n in names if not any(fnmatch.fnmatchcase(n, part) for part in PARTS)]
    jobs = [(name, what, command) for name in names for what, command in variants(name, cxx)]
    with ThreadPoolExecutor(2) as pool:
        problems = list(pool.map(lambda job: compile_alone(root, *job), jobs))
    problems += [None if "#pragma once" in tree.read(root, name) else f"{name}: has no `#pragma once`"
                 for name in names]
    return [problem for problem in problems if problem]


if __name__ == "__main__":
    tree.main(check)
