#!/usr/bin/env python3
"""Writes facet/_abi.py, what cffi knows of the C headers, so that importing facet parses no C.

    python/tools/make_abi.py OUT.py HEADER.h ...

The declarations are those of the headers themselves: comments, directives and macros are taken out, nothing is typed
twice.  cffi lays the structs out by the platform's ABI; a test compares the sizes with the compiler's.

SPDX-License-Identifier: MIT
"""
import os
import re
import sys

import cffi


def declarations(text):
    """What cffi reads of a header of facet."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    constants = re.findall(r"^#define (FACET_MAX_\w+ \d+)$", text, re.M)
    text = text.replace("\\\n", " ")
    text = re.sub(r"^[ \t]*#.*$", "", text, flags=re.M)
    text = re.sub(r'extern "C" \{', "", text)
    text = re.sub(r"^\}\s*\Z", "", text.rstrip() + "\n", flags=re.M)
    text = text.replace("FACET_API", "")
    return "".join(f"#define {c}\n" for c in constants) + re.sub(r"\n\s*\n+", "\n", text)


def main():
    out, headers = sys.argv[1], sys.argv[2:]
    ffi = cffi.FFI()
    for header in headers:
        with open(header, encoding="utf-8") as stream:
            ffi.cdef(declarations(stream.read()))
    ffi.set_source("facet._abi", None)
    ffi.emit_python_code(out)
    with open(os.path.splitext(out)[0] + ".pyi", "w", encoding="utf-8") as stream:
        stream.write("from typing import Any\n\nffi: Any\n")


if __name__ == "__main__":
    main()
