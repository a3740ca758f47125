#!/usr/bin/env python3
"""Includes point one way: include < core < verify < render < io < plot < cli, and one library's headers are seen by one .c.

Examples see include/ only; tests and benchmarks may see everything; the core needs nothing but C11.

SPDX-License-Identifier: MIT
"""
import os
import re

import tree

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^">]+)[">]', re.M)

C11 = """assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg
    stdatomic stdbool stddef stdint stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype"""
POSIX = """dirent dlfcn fcntl getopt glob poll pthread pty pwd sched strings termios unistd arpa/inet net/if netdb netinet/in
    netinet/tcp sys/file sys/ioctl sys/mman sys/resource sys/select sys/socket sys/stat sys/statvfs sys/time sys/types
    sys/uio sys/un sys/utsname sys/wait"""
TESTS_LIBC = "malloc"  # glibc's mallinfo2
INTRINSICS = "cpuid immintrin xmmintrin pmmintrin emmintrin"

# Header prefix -> library.
THIRD_PARTY = {"embree3/": "Embree", "OpenEXR/": "OpenEXR", "openexr": "OpenEXR", "png.h": "libpng",
               "jpeglib.h": "libjpeg", "jerror.h": "libjpeg", "jansson": "jansson", "civetweb": "civetweb",
               "mpi.h": "MPI", "zlib.h": "zlib", "cairo": "Cairo", "sanitizer/": "sanitizers"}
TESTS_ONLY = {"cmocka": "cmocka", "flint/": "FLINT", "arb": "Arb", "gsl/": "GSL", "mpfr": "MPFR", "EGL/": "EGL",
              "GLES3/": "OpenGL ES"}


def headers(words):
    return {word + ".h" for word in words.split()}


def library(header, table):
    return next((name for prefix, name in table.items() if header.startswith(prefix)), None)


def resolve(root, name, header):
    """The file of the tree that `#include "header"` in `name` means, or None."""
    for folder in (os.path.dirname(name), "", "include"):
        path = os.path.normpath(os.path.join(folder, header))
        if os.path.isfile(os.path.join(root, path)):
            return path
    return None


def check_own(root, name, header):
    folder, target = tree.top(name), resolve(root, name, header)
    if target is None:
        return f'"{header}" is not a file of the tree; third-party and system headers are written <{header}>'
    if folder == "examples":
        allowed = ["include", "examples"]
    elif folder in tree.PRODUCT_FOLDERS:
        allowed = tree.PRODUCT_FOLDERS[:tree.PRODUCT_FOLDERS.index(folder) + 1]
    elif folder in ("python", "web"):
        allowed = ["include", folder]
    else:
        return None
    if tree.top(target) not in allowed:
        return f'{folder}/ may not include "{header}": allowed are {", ".join(allowed)}'
    return None


def check_system(name, header, users):
    folder = tree.top(name)
    if header in headers(C11):
        return None
    if folder == "include":
        return f"<{header}>: the public headers need C11 only"
    if folder == "core":
        return None if header in headers(INTRINSICS) else f"<{header}>: the core needs C11 only"
    if header == "facet/facet.h" and name.startswith("tests/packaging/consumer/"):
        return None  # what a user writes
    if header in headers(POSIX) or header in headers(INTRINSICS):
        return None
    if header in headers(TESTS_LIBC) or library(header, TESTS_ONLY):
        return None if folder in ("tests", "bench") else f"<{header}> belongs to tests only"
    third = library(header, THIRD_PARTY)
    if not third:
        return f"<{header}> is not known: add it to a list of tools/check_includes.py"
    if folder in tree.PRODUCT_FOLDERS:
        users.setdefault(third, set()).add(name)
        if name.endswith(".h"):
            return f"<{header}>: a third-party header is included by a .c, never by a header"
    elif folder == "examples":
        return f"<{header}>: an example needs libfacet only"
    return None


def check(root):
    problems, users = [], {}
    for name in tree.files(root, [".c", ".h"]):
        if tree.top(name) == name or name.startswith(("tests/data/", "tools/")):
            continue
        text = tree.read(root, name)
        mask = tree.code_mask(text)
        for found in INCLUDE.finditer(text):
            if not mask[found.start(1) - 1]:
                continue
            header = found.group(2)
            wrong = check_own(root, name, header) if found.group(1) == '"' else check_system(name, header, users)
            if wrong:
                problems.append(f"{name}:{text.count(chr(10), 0, found.start(1)) + 1}: {wrong}")
    for third, names in sorted(users.items()):
        if len(names) > 1:
            problems.append(f"{third} is included by {', '.join(sorted(names))}: one .c file may")
    return problems


if __name__ == "__main__":
    tree.main(check)
