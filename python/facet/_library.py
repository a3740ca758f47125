"""libfacet, loaded, and its errors as exceptions.

The shared library lies beside this file, and _abi.py, which is made from the C headers when the package is built, tells
cffi what is in it.  Calls give up the interpreter's lock: threads evaluate side by side.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import os
from typing import Any, NoReturn

from ._abi import ffi as _ffi

ffi: Any = _ffi

lib: Any = ffi.dlopen(os.path.join(os.path.dirname(os.path.abspath(__file__)), "_libfacet.so"))


def text(chars: Any) -> str:
    """A C string, or "" for NULL."""
    return str(ffi.string(chars).decode()) if chars else ""


_KINDS: dict[int, type[Exception]] = {
    lib.FACET_BAD_ARGUMENT: TypeError,
    lib.FACET_BAD_SYNTAX: ValueError,
    lib.FACET_UNKNOWN_NAME: ValueError,
    lib.FACET_BAD_VALUE: ValueError,
    lib.FACET_BAD_FILE: ValueError,
    lib.FACET_UNSUPPORTED: NotImplementedError,
    lib.FACET_NO_MEMORY: MemoryError,
    lib.FACET_IO: OSError,
}


def fail(status: int, place: str, what: str) -> NoReturn:
    """Raises what a status of the library stands for."""
    raise _KINDS.get(status, RuntimeError)(f"{place}: {what}" if place else what)


def check(status: int, why: Any = None) -> None:
    """Raises unless the library says that all went well.  `why` is the facet_error that it filled, if there is one."""
    if status != lib.FACET_OK:
        if why is None:
            fail(status, "", text(lib.facet_status_string(status)))
        fail(status, text(why.place), text(why.text))


def version() -> str:
    """The version of libfacet, such as "0.1.0"."""
    return text(lib.facet_version())


def instruction_sets() -> tuple[str, ...]:
    """What this processor can run, best first: batches use the first.  Results do not depend on it."""
    names: list[str] = []
    while lib.facet_isa_name(len(names)):
        names.append(text(lib.facet_isa_name(len(names))))
    return tuple(names)
