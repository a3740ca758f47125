#!/usr/bin/env python3
"""Writes facet/_models.pyi, the models' constructors for type checkers and editors, from the library's own table.

    python/tools/make_stubs.py FOLDER       with _libfacet.so and _abi.py

SPDX-License-Identifier: MIT
"""
import os
import sys


def load(folder):
    """What cffi and the library know, without the package, which is not whole yet."""
    sys.path.insert(0, folder)
    from _abi import ffi
    return ffi, ffi.dlopen(os.path.join(os.path.abspath(folder), "_libfacet.so"))


def hint(ffi, lib, parameter):
    if parameter.kind == lib.FACET_CHOICE:
        names = ffi.string(parameter.choices).decode().split("|")
        return "Literal[" + ", ".join(f'"{name}"' for name in names) + "]"
    return "Colour" if parameter.kind == lib.FACET_COLOUR else "float"


def stubs(ffi, lib):
    names, lines = [], []
    for i in range(lib.facet_model_count()):
        info = lib.facet_model_get(i)
        name = ffi.string(info.name).decode()
        names.append(name)
        lines += ["", f"class _{name}(Model):", f'    """{ffi.string(info.summary).decode()}."""', "",
                  "    def __call__(", "        self,", "        *,"]
        for k in range(info.n_parameters):
            p = info.parameters[k]
            lines.append(f"        {ffi.string(p.name).decode()}: {hint(ffi, lib, p)} = ...,")
        lines += ["    ) -> Material: ...", "", f"{name}: _{name}"]
    head = ["# Written by python/tools/make_stubs.py.", "from typing import Literal", "",
            "from ._arrays import Colour", "from ._material import Material", "from ._table import Model", "",
            "__all__ = [" + ", ".join(f'"{name}"' for name in names) + "]"]
    return "\n".join(head + lines) + "\n"


def main():
    folder = sys.argv[1]
    text = stubs(*load(folder))
    with open(os.path.join(folder, "_models.pyi"), "w", encoding="utf-8") as stream:
        stream.write(text)


if __name__ == "__main__":
    main()
