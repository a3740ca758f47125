#!/usr/bin/env python3
"""Uses libfacet as its users do: tests/packaging/check_consumers.py HOW BUILD_FOLDER

HOW is `installed` (find_package and pkg-config, in C and C++, from a copy installed into a temporary folder), `folder`
(add_subdirectory) or `amalgamation` (one file).  Each program is built, run, and prints the numbers of README.md.

SPDX-License-Identifier: MIT
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
CONSUMER = os.path.join(HERE, "consumer")
EXPECTED = "0.9705 0.7549 0.3237, facet "


def run(*command, **more):
    done = subprocess.run(command, capture_output=True, text=True, **more)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\nstatus {done.returncode}\n{done.stdout[-2000:]}{done.stderr[:2000]}")
    return done.stdout


def expect(program, **more):
    said = run(program, **more)
    if not said.startswith(EXPECTED):
        sys.exit(f"{program} prints `{said}` where `{EXPECTED}...` was expected")
    print(f"{os.path.basename(program)}: {said}", end="")


def build_with_cmake(build, *options):
    run("cmake", "-S", CONSUMER, "-B", build, "-DCMAKE_BUILD_TYPE=Debug", *options)
    run("cmake", "--build", build, "-j", "2")


def find_one(folder, name):
    """The file of that name somewhere below."""
    for path, _, names in os.walk(folder):
        if name in names:
            return os.path.join(path, name)
    sys.exit(f"nothing called {name} was installed below {folder}")


def check_names(prefix, has_program):
    """Every file of the installation is where GNU systems look for it."""
    library = os.path.dirname(find_one(prefix, "libfacet.a"))
    wanted = [os.path.join(library, name) for name in ("libfacet.so", "libfacet.so.0", "pkgconfig/facet.pc",
                                                       "cmake/facet/facet-config-version.cmake")]
    wanted += [os.path.join(prefix, name) for name in ("include/facet/facet.h", "include/facet/plugin.h")]
    if has_program:
        wanted += [os.path.join(prefix, name) for name in ("bin/facet", "share/man/man1/facet.1", "share/man/man1/facet-render.1",
                                                           "share/bash-completion/completions/facet",
                                                           "share/zsh/site-functions/_facet")]
    for path in wanted:
        if not os.path.exists(path):
            sys.exit(f"{path} was not installed")
    header = run("readelf", "-d", os.path.join(library, "libfacet.so"))
    if "[libfacet.so.0]" not in header:
        sys.exit(f"the SONAME is not libfacet.so.0:\n{header}")
    return library


def check_document(prefix, folder):
    """The lines of docs/install.md make a project."""
    with open(os.path.join(ROOT, "docs", "install.md"), encoding="utf-8") as stream:
        lines = re.search(r"^```cmake\n(.*?)^```", stream.read(), re.M | re.S).group(1)
    source = os.path.join(folder, "document")
    os.mkdir(source)
    program = os.path.join(CONSUMER, "consumer.c")
    with open(os.path.join(source, "CMakeLists.txt"), "w", encoding="utf-8") as stream:
        stream.write("cmake_minimum_required(VERSION 3.16)\nproject(document LANGUAGES C)\n"
                     f"add_executable(renderer {program})\n{lines}")
    build = os.path.join(source, "build")
    run("cmake", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", build)
    expect(os.path.join(build, "renderer"))


def check_installed(build, folder):
    prefix = os.path.join(folder, "prefix")
    run("cmake", "--install", build, "--prefix", prefix)
    has_program = os.path.exists(os.path.join(build, "facet"))
    library = check_names(prefix, has_program)
    image = os.path.join(folder, "image")
    run("cmake", "--install", build, "--prefix", "/usr", env=dict(os.environ, DESTDIR=image))
    check_names(os.path.join(image, "usr"), has_program)
    build_with_cmake(os.path.join(folder, "build"), f"-DCMAKE_PREFIX_PATH={prefix}")
    for kind in ("facet", "static"):
        expect(os.path.join(folder, "build", "with_" + kind))
    check_document(prefix, folder)
    config = [shutil.which("pkg-config") or "pkg-config", f"--define-variable=prefix={prefix}"]
    environment = dict(os.environ, PKG_CONFIG_PATH=os.path.join(library, "pkgconfig"))
    version = run(*config, "--modversion", "facet", env=environment).strip()
    source = os.path.join(CONSUMER, "consumer.c")
    loader = dict(os.environ, LD_LIBRARY_PATH=library)
    for compiler, language in (("cc", "c"), ("c++", "c++")):
        if not shutil.which(compiler):
            print(f"{compiler} is not installed: not tried")
            continue
        flags = run(*config, "--cflags", "--libs", "facet", env=environment).split()
        program = os.path.join(folder, "from_" + language)
        run(compiler, "-x", language, "-Wall", "-Wextra", "-Wpedantic", "-Werror", source, "-x", "none", *flags, "-o", program)
        expect(program, env=loader)
    program = os.path.join(folder, "from_c_static")
    flags = run(*config, "--cflags", "--static", "--libs", "facet", env=environment).split()
    run("cc", source, "-static", *flags, "-o", program)
    expect(program)
    said = run(program)
    if not said.strip().endswith(" " + version):
        sys.exit(f"pkg-config tells of version {version}, the library of {said}")


def check_folder(_, folder):
    build_with_cmake(os.path.join(folder, "build"), f"-DFACET_SOURCE={ROOT}")
    for kind in ("facet", "static"):
        expect(os.path.join(folder, "build", "with_" + kind))


def symbols(file):
    """The global names that a library or an object defines."""
    lines = run("nm", "--defined-only", "--extern-only", file).splitlines()
    return {line.split()[2] for line in lines if len(line.split()) == 3}


def check_amalgamation(build, folder):
    run(sys.executable, "-B", os.path.join(ROOT, "tools", "make_amalgamation.py"), folder)
    names = sorted(os.listdir(folder))
    if names != ["facet.c", "facet.h"]:
        sys.exit(f"two files were expected, not {names}")
    os.mkdir(os.path.join(folder, "facet"))
    shutil.copy(os.path.join(folder, "facet.h"), os.path.join(folder, "facet", "facet.h"))
    library, include = os.path.join(build, "libfacet.a"), os.path.join(ROOT, "include")
    hashes = os.path.join(folder, "hashes_of_library")
    run("cc", "-I", include, os.path.join(CONSUMER, "all_models.c"), library, "-lm", "-o", hashes)
    wanted = run(hashes)
    compilers = [name for name in ("cc", "clang-14") if shutil.which(name)]
    for compiler in compilers:
        made = os.path.join(folder, "facet.o")
        run(compiler, "-std=c11", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", "-c", os.path.join(folder, "facet.c"), "-o",
            made)
        if symbols(made) != symbols(library):
            sys.exit(f"{compiler}: other names than the library's: {sorted(symbols(made) ^ symbols(library))}")
        for name in ("consumer", "all_models"):
            run(compiler, "-I", folder, os.path.join(CONSUMER, name + ".c"), made, "-lm", "-o", os.path.join(folder, name))
        expect(os.path.join(folder, "consumer"))
        found = run(os.path.join(folder, "all_models"))
        if found != wanted:
            sys.exit(f"{compiler}: other bits than the library's:\n{found}{wanted}")
        print(found, end="")


def main():
    ways = {"installed": check_installed, "folder": check_folder, "amalgamation": check_amalgamation}
    if len(sys.argv) != 3 or sys.argv[1] not in ways:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory(prefix="facet-test-") as folder:
        ways[sys.argv[1]](os.path.abspath(sys.argv[2]), folder)


if __name__ == "__main__":
    main()
