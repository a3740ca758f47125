#!/usr/bin/env python3
"""Writes the kernels of core/kernel as GLSL, for fragment and compute shaders of GLSL ES 3.00 and desktop GLSL 3.30 on.

    tools/make_glsl.py FOLDER [NAME ...]    FOLDER/NAME.glsl for the names given, or all that there are

There is a file for each model of core/model_table.h, for each kernel that serves a part of a model only, and
facet.glsl.  A file is self-contained, without a #version line, and holds what the model needs and no more:
    struct MODEL_params { ... };                                prepared parameters
    MODEL_params MODEL_load(uvec4 words[MODEL_WORDS]);          from what facet_bsdf_words() gives
    vec3 MODEL_eval(MODEL_params p, vec3 wi, vec3 wo);          f cos(theta_i)
    float MODEL_pdf(MODEL_params p, vec3 wi, vec3 wo);
    bsdf_sample MODEL_sample(MODEL_params p, vec3 wo, vec3 u);
and every kernel function that returns MODEL_params.  facet.glsl holds all kernels at once, under the kernels' names,
with the distribution of normals chosen by a field: for shaders with several models.

The text is the C text, translated: the rules of a kernel (STYLE) are what makes that possible, and text that breaks one
is refused with its file, line and what to write instead.  Beyond them this tool relies on:
  - kernel NAME is in core/kernel/NAME.h, its record is NAME_params, and the record's parts are real, int, records and
    arrays of real, without padding;
  - a truth value is an int that is given a comparison, or & | ! of truth values; parameters and results follow;
  - a model that always has one distribution calls NAME_prepare(m, NDF_...) in core/model/model_NAME.h, once;
  - rounding to an integer by adding a large number is round_to_integer() of kmath_basic.h and nothing else, because a
    shader compiler may reassociate; bits are taken by bits_of() and real_of().
Functions that GLSL must write in its own way are in tools/glsl/primitives.glsl.

SPDX-License-Identifier: MIT
"""
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "glsl"))

from kernel_c import COMMENT, Kernels, KernelError  # noqa: E402
from kernel_glsl import Translation  # noqa: E402

LICENCE = "SPDX-License-Identifier" + ": MIT"
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def read(name):
    with open(os.path.join(ROOT, name), encoding="utf-8") as stream:
        return stream.read()


def rows(name, pattern, example):
    """The rows of a list of core/model_table.h."""
    text = COMMENT.sub("", read("core/model_table.h"))
    found = re.search(rf"#define {name}\(X\)((?:[^\n]*\\\n)*[^\n]*)", text)
    listed = re.findall(pattern, found[1]) if found else []
    if not listed:
        raise KernelError(f"core/model_table.h: {name} has no rows {example}")
    return listed


def table():
    """The kernels, and the models, each with its kernel, in order."""
    kernels = rows("FACET_KERNELS", r"\bX\((\w+)\)", "X(name)")
    models = dict(rows("FACET_MODELS", r"\bX\((\w+), (\w+),[\s\\]*\"", 'X(name, kernel, "summary", ...)'))
    for name, kernel in models.items():
        if kernel not in kernels:
            raise KernelError(f"core/model_table.h: the kernel {kernel} of {name} has no row in FACET_KERNELS")
    return kernels, models


def primitives():
    """Name -> text of each function of primitives.glsl."""
    functions = re.findall(r"^(\w+ (\w+)\([^\n]*(?:\}|\n\{.*?^\}))$", read("tools/glsl/primitives.glsl"), re.S | re.M)
    return {name: text for text, name in functions}


def distribution_of(model):
    """The one distribution of normals that the model's prepare function asks for, or None."""
    name = f"core/model/model_{model}.h"
    if not os.path.isfile(os.path.join(ROOT, name)):
        raise KernelError(f"core/model_table.h: model {model} has no file {name}")
    code = COMMENT.sub("", read(name))
    named = re.findall(r"\bNDF_[A-Z]\w*", code)
    passed = re.findall(r"\b\w+_prepare\(m, (NDF_[A-Z]\w*)\)", code)
    return passed[0] if len(named) == 1 and passed == named else None


def roots_of(kernel, kernels):
    roots = [f"{kernel}_{verb}" for verb in ("eval", "pdf", "sample")]
    for root in roots:
        if root not in kernels.items:
            raise KernelError(f"core/kernel/{kernel}.h: {root}() is missing")
    makers = [name for name, item in kernels.items.items()
              if item.kind == "function" and item.type == f"{kernel}_params" and name != f"{kernel}_fix"]
    return roots + makers


def loader(whole, kernel):
    name = whole.rename(kernel + "_params")[:-len("_params")]
    record = f"{kernel}_params"
    lines = "\n".join("    " + line for line in whole.loads(record, "p", 0))
    n = (whole.words(record) + 3)//4
    return f"""
/* The parameters from the words that facet_bsdf_words() gives, four to a vector. */
const int {name.upper()}_WORDS = {n};
{name}_params {name}_load(uvec4 words[{name.upper()}_WORDS])
{{
    {name}_params p;
{lines}
    return p;
}}
"""


def translate(kernels_wanted, title, pins, renames):
    kernels = Kernels(ROOT, [f"core/kernel/{kernel}.h" for kernel in kernels_wanted])
    roots = [root for kernel in kernels_wanted for root in roots_of(kernel, kernels)]
    filled = [f"{kernel}_params" for kernel in kernels_wanted]
    given = {kernels.items[f"{kernel}_sample"].type for kernel in kernels_wanted}
    whole = Translation(kernels, roots, filled, given, pins, renames, primitives())
    version = ".".join(re.findall(r"#define FACET_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", read("include/facet/facet.h")))
    head = f"""/* {title}, of facet {version}, for GLSL ES 3.00, GLSL 3.30 and later; docs/shaders.md says how to use it.
 *
 * Made from the C text by tools/make_glsl.py: change that, not this.  Directions are unit vectors in the shading frame,
 * n = (0,0,1), that point away from the surface; wi points to the light, wo to the viewer.
 * {LICENCE} */

#ifdef GL_ES
precision highp float;
precision highp int;
#endif
"""
    return head + whole.text() + "".join(loader(whole, kernel) for kernel in kernels_wanted)


def model_text(model, kernel):
    ndf = distribution_of(model)
    pins = {("distribution", "kind"): ndf} if ndf else {}
    return translate([kernel], f"{model}.glsl: the model `{model}`", pins, {kernel: model} if kernel != model else {})


def kernel_text(kernel):
    return translate([kernel], f"{kernel}.glsl: the kernel `{kernel}`", {}, {})


def all_text(kernels):
    return translate(kernels, "facet.glsl: the kernels of all models", {}, {})


def write(path, text):
    """Only where it differs, so that nothing is built again without need."""
    if os.path.isfile(path):
        with open(path, encoding="utf-8") as stream:
            if stream.read() == text:
                return
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(text)


def main(arguments):
    if not arguments or arguments[0].startswith("-"):
        print(__doc__.strip())
        return 0 if arguments and arguments[0] in ("-h", "--help") else 2
    try:
        kernels, models = table()
        files = {model: lambda model=model: model_text(model, models[model]) for model in models}
        files |= {kernel: lambda kernel=kernel: kernel_text(kernel) for kernel in kernels
                  if kernel not in models and kernel not in models.values()}
        files["facet"] = lambda: all_text(kernels)
        unknown = [name for name in arguments[1:] if name not in files]
        if unknown:
            raise KernelError(f"there is no {unknown[0]}.glsl; there are {', '.join(files)}")
        os.makedirs(arguments[0], exist_ok=True)
        for name in arguments[1:] or files:
            write(os.path.join(arguments[0], name + ".glsl"), files[name]())
    except KernelError as error:
        print(f"make_glsl: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
