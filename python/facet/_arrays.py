"""Arrays in and out: precision, broadcasting, and the layout in which the C loops read them.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from ._library import ffi, lib

Array = npt.NDArray[Any]
# Anything that NumPy makes an array of numbers from.
ArrayLike = npt.ArrayLike
# One number, or red, green and blue.
Colour = Union[float, Sequence[float], Array]

SINGLE = np.dtype(np.float32)
DOUBLE = np.dtype(np.float64)


def precision(*inputs: ArrayLike) -> np.dtype[Any]:
    """float64 if any of the arrays is, else float32.  Lists, tuples and Python's own numbers have no say."""
    for x in inputs:
        given = getattr(x, "dtype", None)
        if given is not None and np.dtype(given).kind == "f" and np.dtype(given).itemsize > SINGLE.itemsize:
            return DOUBLE
    return SINGLE


def as_reals(x: ArrayLike, dtype: np.dtype[Any], name: str) -> Array:
    """x as an array of dtype, without a copy where it is one."""
    array = np.asarray(x)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name}: an array of {array.dtype}; give real numbers")
    array = array.astype(dtype, order="K", copy=False)
    return array if array.flags.aligned else array.copy()


def as_triples(x: ArrayLike, dtype: np.dtype[Any], name: str) -> Array:
    """... whose last axis holds x, y and z."""
    array = as_reals(x, dtype, name)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name}: shape {array.shape}; the last axis must hold x, y, z")
    return array


def common_shape(*named: tuple[str, Array]) -> tuple[int, ...]:
    """The shape to which the leading axes of arrays of triples broadcast."""
    try:
        return np.broadcast_shapes(*(a.shape[:-1] for _, a in named))
    except ValueError:
        shapes = " and ".join(f"{name} {a.shape}" for name, a in named)
        raise ValueError(f"{shapes} do not broadcast: all axes but the last must be equal or 1") from None


def new_triples(shape: tuple[int, ...], dtype: np.dtype[Any], like: Sequence[Array]) -> Array:
    """An array of shape (*shape, 3), laid out as the inputs are: all x, then all y, then all z, if they are."""
    large = [a for a in like if a.ndim > 1 and a.size > 3]
    if large and all(abs(a.strides[-1]) > a.itemsize for a in large):
        return np.moveaxis(np.empty((3, *shape), dtype), 0, -1)
    return np.empty((*shape, 3), dtype)


def check_out(out: Array, shape: tuple[int, ...], dtype: np.dtype[Any], inputs: Sequence[Array]) -> Array:
    """`out` if results can be written to it."""
    if not isinstance(out, np.ndarray):
        raise TypeError(f"out: a {type(out).__name__}; give a NumPy array")
    if out.shape != shape or out.dtype != dtype:
        raise ValueError(f"out: {out.dtype} of shape {out.shape}; the result is {dtype} of shape {shape}")
    if not out.flags.writeable or not out.flags.aligned:
        raise ValueError("out: cannot be written to")
    if any(np.may_share_memory(out, a) for a in inputs):
        raise ValueError("out: shares memory with an input")
    return out


def view(array: Array | None, shape: tuple[int, ...], parts: int) -> Any:
    """A facet_python_array of the elements of `array`, broadcast to `shape`; None is an output that is not wanted.

    The memory is borrowed: the caller keeps `array` until the loop has run.
    """
    c = ffi.new("facet_python_array *")
    if array is not None:
        fill_view(c, array, shape, parts)
    return c


def fill_view(c: Any, array: Array, shape: tuple[int, ...], parts: int) -> None:
    """The same into a struct that is there already."""
    if parts == 3:
        c.component = array.strides[-1]
        wide = np.broadcast_to(array, (*shape, 3)) if array.shape[:-1] != shape else array
    else:
        wide = np.broadcast_to(array, shape) if array.shape != shape else array
    c.data = ffi.cast("char *", array.__array_interface__["data"][0])
    c.n_axes = len(shape)
    for i, length in enumerate(shape):
        c.shape[i] = length
        c.strides[i] = wide.strides[i]


def run(loop: Any, bsdf: Any, shape: tuple[int, ...], names: Sequence[str], arguments: Sequence[Any],
        is_checked: bool = True) -> None:
    """Runs a loop of array_loops.h over all elements; names are those of its inputs."""
    n = 1
    for length in shape:
        n *= length
    fault = ffi.new("facet_python_fault *") if is_checked else ffi.NULL
    if not loop(bsdf, n, *arguments, fault):
        where = [int(i) for i in np.unravel_index(fault.element, shape)] if shape else []
        value = tuple(float(f"{fault.value[k]:.9g}") for k in range(3))
        place = names[fault.argument - 1] + (f"{where}" if where else "")
        if names[fault.argument - 1] == "u":
            raise ValueError(f"{place} is {value}; give numbers in [0, 1)")
        norm = float(np.linalg.norm([fault.value[k] for k in range(3)]))
        raise ValueError(f"{place} is {value}, of length {norm:.6g}; give unit vectors")


def loop_of(name: str, dtype: np.dtype[Any]) -> Any:
    """The C loop of this name for a precision."""
    return getattr(lib, f"facet_python_{name}{'64' if dtype == DOUBLE else ''}")


def direction(theta: ArrayLike, phi: ArrayLike = 0.0) -> Array:
    """Unit vectors at angles theta from the normal and phi from the tangent [rad], of shape (..., 3).

    theta and phi broadcast.  float64 if either is an array of float64, else float32.

    >>> direction([0.0, np.pi / 2]).round(3) + 0
    array([[0., 0., 1.],
           [1., 0., 0.]], dtype=float32)
    """
    dtype = precision(theta, phi)
    t, p = np.broadcast_arrays(as_reals(theta, DOUBLE, "theta"), as_reals(phi, DOUBLE, "phi"))
    sine = np.sin(t)
    return np.stack([sine * np.cos(p), sine * np.sin(p), np.cos(t)], axis=-1).astype(dtype)
