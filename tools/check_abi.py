#!/usr/bin/env python3
"""Programs built with the last release still run with this library: tools/check_abi.py

Builds libfacet of the last tag vX.Y.Z and of this tree, and compares them by abidiff (Debian package abigail-tools).  What
programs may rely on is what include/facet/facet.h declares.  A library with another SOVERSION may differ.  Exit status 77,
with the reason, where there is no such tag, as in a clone without tags, no git or no abidiff.  First it is shown that a member added to a public struct is found.

SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CHANGED = 4  # of abidiff's exit status; what was added does not count
ADDED_MEMBER = ("typedef struct facet_sample {", "typedef struct facet_sample {\n    double added;")


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def last_tag():
    done = subprocess.run(["git", "-C", ROOT, "tag", "--list", "v*", "--merged", "HEAD", "--sort=-version:refname"],
                          capture_output=True, text=True)
    tags = [tag for tag in done.stdout.split() if re.fullmatch(r"v\d+\.\d+\.\d+", tag)]
    return tags[0] if tags else None


def soversion(text):
    """What CMakeLists.txt has as the number in libfacet.so.N."""
    return re.search(r"\bSOVERSION (\d+)", text)[1]


def build(root, folder, names):
    """The shared library of the tree's files of such names, with all that a debugger knows of its types."""
    made = os.path.join(folder, "libfacet.so.0")
    subprocess.run(["cc", "-g", "-O0", "-w", "-shared", "-fPIC", "-fvisibility=hidden", "-I" + os.path.join(root, "include"), "-I" + root,
                    "-Wl,-soname,libfacet.so.0", "-Wl,--version-script=" + os.path.join(root, "core", "facet.map"),
                    *sorted(glob.glob(os.path.join(root, "core", names))), "-lm", "-o", made], check=True)
    return made


def copy(root, folder, change=None):
    for name in ("core", "include"):
        shutil.copytree(os.path.join(root, name), os.path.join(folder, name))
    if change:
        path = os.path.join(folder, "include", "facet", "facet.h")
        with open(path, encoding="utf-8") as stream:
            text = stream.read()
        if change[0] not in text:
            sys.exit(f"abi: facet.h has no `{change[0]}`")
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text.replace(*change))
    return folder


def compare(old, new, names="*.c"):
    """abidiff's status and report for two trees."""
    with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
        done = subprocess.run(["abidiff", "--no-added-syms", "--headers-dir1", os.path.join(old, "include"), "--headers-dir2",
                               os.path.join(new, "include"), build(old, first, names), build(new, second, names)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def main():
    if not shutil.which("abidiff"):
        skip("abidiff was not found: apt-get install abigail-tools")
    if not shutil.which("git") or not os.path.exists(os.path.join(ROOT, ".git")):
        skip("this is no checkout by git")
    tag = last_tag()
    with tempfile.TemporaryDirectory() as folder:
        status, report = compare(ROOT, copy(ROOT, os.path.join(folder, "changed"), ADDED_MEMBER), "bsdf_f32.c")
        if not status & CHANGED:
            sys.exit(f"abi: a changed struct was not noticed: status {status}\n{report}")
        if not tag:
            skip("this clone has no tag vX.Y.Z to compare with; a changed struct would be noticed")
        before = subprocess.run(["git", "-C", ROOT, "show", f"{tag}:CMakeLists.txt"], check=True, capture_output=True, text=True)
        with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as stream:
            numbers = soversion(before.stdout), soversion(stream.read())
        if numbers[0] != numbers[1]:
            print(f"libfacet.so.{numbers[1]} may differ from libfacet.so.{numbers[0]} of {tag}")
            return
        old = os.path.join(folder, "old")
        os.mkdir(old)
        archive = subprocess.run(["git", "-C", ROOT, "archive", tag, "core", "include"], check=True, capture_output=True)
        subprocess.run(["tar", "-C", old, "-xf", "-"], input=archive.stdout, check=True)
        status, report = compare(old, ROOT)
    if status:
        sys.exit(f"abi: programs built with {tag} may break; undo the change, or raise SOVERSION in CMakeLists.txt\n{report}")
    print(f"the same for programs as {tag}")


if __name__ == "__main__":
    main()
