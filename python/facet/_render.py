"""facet.render: the path tracer, run as a program, and its pictures as arrays.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Callable, Literal, NoReturn, Union, overload

import numpy as np

from ._arrays import Array, Colour
from ._material import Material

Scene = Union[str, "os.PathLike[str]", Mapping[str, Any], None]
Path = Union[str, "os.PathLike[str]"]


def find_program() -> str:
    """The path of the program `facet`: $FACET, beside this Python's own programs, or on PATH."""
    named = os.environ.get("FACET")
    if named:
        if not os.access(named, os.X_OK):
            raise FileNotFoundError(f"$FACET is {named}, which is no program")
        return named
    beside = os.path.join(sysconfig.get_path("scripts"), "facet")
    found = beside if os.access(beside, os.X_OK) else shutil.which("facet")
    if not found:
        raise FileNotFoundError("the program `facet` was not found: build it with `make build`, and put it on PATH or "
                                "name it in $FACET")
    return found


def read_exr(path: Path) -> dict[str, Array]:
    """The pictures in an OpenEXR file by layer: float32 of shape (height, width, 3), or (height, width) of one channel.

    The layer without a name is "".  Needs `pip install facet-brdf[render]`.
    """
    OpenEXR = _open_exr()
    path = os.fspath(path)
    if not os.path.exists(path):
        raise FileNotFoundError(f"{path}: cannot open: No such file or directory")
    layers: dict[str, dict[str, Array]] = {}
    with OpenEXR.File(path, separate_channels=True) as file:
        for part in file.parts:
            for name, channel in part.channels.items():
                layer, _, last = name.rpartition(".")
                layers.setdefault(layer, {})[last] = np.asarray(channel.pixels)
    return {layer: _joined(channels) for layer, channels in layers.items()}


def _open_exr() -> Any:
    """The package OpenEXR."""
    try:
        import OpenEXR  # type: ignore[import-not-found, unused-ignore]
    except ImportError:
        raise ImportError("reading pictures needs the package OpenEXR: pip install 'facet-brdf[render]'") from None
    return OpenEXR


def _joined(channels: dict[str, Array]) -> Array:
    for names in ("RGB", "XYZ", "xyz", "UV", "uv"):
        if set(channels) - {"A"} == set(names):
            return np.stack([channels[c] for c in names], axis=-1)
    return np.stack([channels[c] for c in sorted(channels)], axis=-1) if len(channels) > 1 else next(iter(channels.values()))


@overload
def render(scene: Scene = ..., *, aov: None = ..., size: tuple[int, int] | None = ..., spp: int | None = ...,
           camera: str | None = ..., env: Path | Colour | None = ..., env_scale: float | None = ...,
           materials: Mapping[str, str | Material] | None = ..., depth: int | None = ..., seed: int | None = ...,
           threads: int | None = ..., crop: tuple[int, int, int, int] | None = ..., time: float | None = ...,
           noise: float | None = ..., strategy: Literal["explicit", "implicit", "mis"] | None = ...,
           gradients: bool | None = ..., progress: bool | Callable[[float], object] = ...,
           options: Sequence[str] = ...) -> Array: ...


@overload
def render(scene: Scene = ..., *, aov: Sequence[str], size: tuple[int, int] | None = ..., spp: int | None = ...,
           camera: str | None = ..., env: Path | Colour | None = ..., env_scale: float | None = ...,
           materials: Mapping[str, str | Material] | None = ..., depth: int | None = ..., seed: int | None = ...,
           threads: int | None = ..., crop: tuple[int, int, int, int] | None = ..., time: float | None = ...,
           noise: float | None = ..., strategy: Literal["explicit", "implicit", "mis"] | None = ...,
           gradients: bool | None = ..., progress: bool | Callable[[float], object] = ...,
           options: Sequence[str] = ...) -> dict[str, Array]: ...


def render(scene: Scene = None, *, aov: Sequence[str] | None = None, size: tuple[int, int] | None = None,
           spp: int | None = None, camera: str | None = None, env: Path | Colour | None = None,
           env_scale: float | None = None, materials: Mapping[str, str | Material] | None = None,
           depth: int | None = None, seed: int | None = None, threads: int | None = None,
           crop: tuple[int, int, int, int] | None = None, time: float | None = None, noise: float | None = None,
           strategy: Literal["explicit", "implicit", "mis"] | None = None, gradients: bool | None = None,
           progress: bool | Callable[[float], object] = False, options: Sequence[str] = ()) -> Array | dict[str, Array]:
    """Renders a scene by the program `facet`: linear Rec.709 radiance, float32 of shape (height, width, 3).

    scene: a .gltf or .glb file, a glTF document as a dict, or None for the built-in one.
    size: width and height [pixel].  spp: samples per pixel.  time [s] or noise (relative) end the render sooner.
    env: light from all around: an .hdr or .exr file, or a radiance, one number or three.
    materials: another reflection for materials of the scene, by name: {"body": facet.ggx(alpha=.2)}.
    aov: further pictures, of "albedo", "normal", "distance", "samples" and "noisy"; the result then is a dict of arrays by
        name, the picture itself as "".
    gradients: True shares light between neighbouring pixels, which then err together a little; False renders each on its
        own; None shares where it pays.
    progress: True prints a bar; a function is called with the share that is done.
    options: further arguments as on the command line; `facet render --help` lists them.

    What the program warns of is a RuntimeWarning, and its error an exception with its own message: ValueError for a wrong
    argument or a damaged file, FileNotFoundError, OSError if the system refuses.
    """
    _open_exr()  # a picture that cannot be read is not worth its time
    with tempfile.TemporaryDirectory(prefix="facet-") as folder:
        path = _scene_path(scene, folder)
        picture = os.path.join(folder, "picture.exr")
        command = [find_program(), "render", *([path] if path else []), "-o", picture]
        given: dict[str, Any] = {"spp": spp, "camera": camera, "env-scale": env_scale, "depth": depth, "seed": seed,
                                 "threads": threads, "time": time, "noise": noise, "strategy": strategy,
                                 "gradients": None if gradients is None else "on" if gradients else "off"}
        command += [f"--{name}={value}" for name, value in given.items() if value is not None]
        if size is not None:
            command.append(f"--size={size[0]}x{size[1]}")
        if crop is not None:
            command.append("--crop=" + ",".join(str(x) for x in crop))
        if env is not None:
            command.append(f"--env={_environment(env)}")
        if aov is not None:
            command.append("--aov=" + ",".join(aov))
        for name, material in (materials or {}).items():
            command.append(f"--material={name}={material.spec if isinstance(material, Material) else material}")
        files = [f for f in (path, env) if isinstance(f, (str, os.PathLike))]
        _run([*command, *options], progress, files)
        layers = read_exr(picture)
    if aov is not None:
        return layers
    return layers[""]


def _scene_path(scene: Scene, folder: str) -> str | None:
    if not isinstance(scene, Mapping):
        return None if scene is None else os.fspath(scene)
    path = os.path.join(folder, "scene.gltf")
    with open(path, "w", encoding="utf-8") as stream:
        json.dump(scene, stream)
    return path


def _environment(env: Path | Colour) -> str:
    if isinstance(env, (str, os.PathLike)):
        return os.fspath(env)
    return ",".join(f"{x:.9g}" for x in np.broadcast_to(np.asarray(env, dtype=np.float64), 3))


def _show(share: float) -> None:
    """A bar on stderr."""
    full = int(40 * share)
    print(f"\r[{'#' * full}{' ' * (40 - full)}] {100 * share:3.0f} %", end="\n" if share >= 1 else "", file=sys.stderr,
          flush=True)


def _run(command: list[str], progress: bool | Callable[[float], object], files: Sequence[Path]) -> None:
    """Runs the program, whose stderr is events, one JSON object a line, and messages."""
    show = progress if callable(progress) else _show if progress else None
    messages: list[str] = []
    with subprocess.Popen([*command, "--quiet", "--events", "-"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, encoding="utf-8", errors="replace") as running:
        assert running.stderr is not None
        try:
            for line in running.stderr:
                event = _event(line)
                if event is None:
                    messages.append(line.strip())
                elif show and event.get("event") == "progress":
                    show(min(event["samples"] / event["samples_total"], 1.0) if event["samples_total"] else 0.0)
        except BaseException:
            running.kill()
            raise
    for message in messages:
        if message.startswith("facet: warning: "):
            warnings.warn(message[len("facet: warning: "):], RuntimeWarning, stacklevel=3)
    if running.returncode:
        _fail(running.returncode, [m for m in messages if not m.startswith("facet: warning: ")], files)


def _event(line: str) -> dict[str, Any] | None:
    if not line.startswith("{"):
        return None
    try:
        event = json.loads(line)
    except ValueError:
        return None
    return event if isinstance(event, dict) else None


def _fail(status: int, messages: list[str], files: Sequence[Path]) -> NoReturn:
    said = [m for m in messages if m.startswith("facet: error: ")]
    text = said[-1][len("facet: error: "):] if said else "\n".join(messages) or f"facet render ended with status {status}"
    if status == 130:
        raise KeyboardInterrupt(text)
    if status == 3 and any(not os.path.exists(f) for f in files):
        raise FileNotFoundError(text)
    if status in (2, 3):
        raise ValueError(text)
    if status == 4:
        raise MemoryError(text) if "memory" in text else OSError(text)
    raise RuntimeError(text)
