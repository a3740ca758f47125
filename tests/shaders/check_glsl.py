#!/usr/bin/env python3
"""Every file of a folder of GLSL is a valid part of a fragment shader of GLSL ES 3.00, GLSL 3.30 and GLSL 4.50, and the
SPIR-V of the last is valid too; and text that is no kernel is refused with its place.

    tests/shaders/check_glsl.py FOLDER

Exit status 77, "skipped", without glslangValidator and spirv-val (Debian packages glslang-tools, spirv-tools).

SPDX-License-Identifier: MIT
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TOOLS = os.path.join(os.path.dirname(os.path.dirname(HERE)), "tools")
FUNCTIONS = ("params", "load", "eval", "pdf", "sample")


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    return None if done.returncode == 0 else (done.stdout + done.stderr).strip()


def fragment(version, text, model):
    with open(os.path.join(HERE, "any_model.glsl"), encoding="utf-8") as stream:
        rest = stream.read()
    macros = "".join(f"#define MODEL_{name} {model}_{name}\n" for name in FUNCTIONS)
    return f"#version {version}\n{text}{macros}#define MODEL_WORDS {model.upper()}_WORDS\n{rest}"


def validate(folder, name, scratch):
    problems = []
    with open(os.path.join(folder, name), encoding="utf-8") as stream:
        text = stream.read()
    models = re.findall(r"^(\w+)_params \1_load\(", text, re.M)
    if not models:
        problems.append(f"{name}: there is no MODEL_load")
    for model in models:
        for version, flags in (("300 es", []), ("330", []), ("450", ["-V"])):
            shader, binary = os.path.join(scratch, "shader.frag"), os.path.join(scratch, "shader.spv")
            with open(shader, "w", encoding="utf-8") as stream:
                stream.write(fragment(version, text, model))
            found = run("glslangValidator", *flags, *(["-o", binary] if flags else []), shader)
            if not found and flags:
                found = run("spirv-val", binary)
            if found:
                problems.append(f"{name}, {model}, #version {version}:\n{found}")
    return problems


# What is no kernel, and a word of the message that must refuse it.
FAULTS = {
    "KERNEL real broken_pdf(broken_params p, real3 wi, real3 wo) { if (wi.z > 0) return 1; return p.a; }": "select with ?:",
    "KERNEL real broken_pdf(broken_params p, real3 wi, real3 wo) { return sinf(wi.z); }": "kmath.h",
    "KERNEL real broken_pdf(const broken_params *p, real3 wi, real3 wo) { return 0; }": "kernels take values",
    "KERNEL real broken_pdf(broken_params p, real3 wi, real3 wo) { const real a = p.a; return a; }": "without const",
    "KERNEL real broken_pdf(broken_params p, real3 wi, real3 wo) { return p.b; }": "no field b",
    "KERNEL real broken_pdf(broken_params p, real3 wi, real3 wo) { return wi*p.a; }": "real.h",
    "KERNEL real broken_pdf(broken_params p, real3 wi, real3 wo) "
    "{ bsdf_sample s = p.a > 0 ? broken_sample(p, wi, wo) : broken_sample(p, wo, wi); return s.pdf; }": "WebGL",
}
HEAD = """#pragma once
#include "bsdf.h"
typedef struct broken_params { real a; } broken_params;
KERNEL real3 broken_eval(broken_params p, real3 wi, real3 wo) { return splat3(p.a*wi.z*wo.z); }
KERNEL bsdf_sample broken_sample(broken_params p, real3 wo, real3 u) { return complete_sample(wo, u, p.a, 1, 0); }
"""


def refuses_faults():
    sys.path.insert(0, TOOLS)
    import make_glsl
    problems = []
    for fault, wanted in FAULTS.items():
        with tempfile.TemporaryDirectory() as root:
            shutil.copytree(os.path.join(make_glsl.ROOT, "core", "kernel"), os.path.join(root, "core", "kernel"))
            with open(os.path.join(root, "core", "kernel", "broken.h"), "w", encoding="utf-8") as stream:
                stream.write(HEAD + fault + "\n")
            message = "nothing"
            try:
                kernels = make_glsl.Kernels(root, ["core/kernel/broken.h"])
                make_glsl.Translation(kernels, make_glsl.roots_of("broken", kernels), ["broken_params"], {"bsdf_sample"},
                                      {}, {}, make_glsl.primitives()).text()
            except make_glsl.KernelError as error:
                message = str(error)
            if wanted not in message or not message.startswith("core/kernel/broken.h:6:"):
                problems.append(f"`{fault}` gives: {message}")
    return problems


def main(folder):
    problems = refuses_faults()
    for program, package in (("glslangValidator", "glslang-tools"), ("spirv-val", "spirv-tools")):
        if not shutil.which(program):
            print(f"skipped: {program} is missing; install it with `apt-get install {package}`")
            return 77
    names = sorted(name for name in os.listdir(folder) if name.endswith(".glsl"))
    if not names:
        problems.append(f"{folder} holds no .glsl")
    with tempfile.TemporaryDirectory() as scratch:
        for name in names:
            problems += validate(folder, name, scratch)
    print("\n".join(problems) if problems else f"{len(names)} files are valid")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
