"""What the checks share: which files belong to the tree, and how a check reports.

SPDX-License-Identifier: MIT
"""
import os
import subprocess
import sys

# From left to right: a file includes from its own folder or from one to the left.
PRODUCT_FOLDERS = ["include", "core", "verify", "render", "io", "plot", "cli"]


def default_root():
    return os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def files(root, suffixes=None):
    """Paths relative to root, sorted: what git tracks or would track; without git, all but build/."""
    listing = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard", "-z", "--", "."],
                             capture_output=True)
    inside = subprocess.run(["git", "-C", root, "rev-parse", "--show-toplevel"], capture_output=True, text=True)
    if inside.returncode == 0 and os.path.realpath(inside.stdout.strip()) == os.path.realpath(root):
        names = [os.fsdecode(name) for name in listing.stdout.split(b"\0") if name]
    else:
        names = []
        for folder, folders, entries in os.walk(root):
            folders[:] = [f for f in folders if f not in (".git", "build", "__pycache__", "node_modules")]
            names += [os.path.relpath(os.path.join(folder, entry), root) for entry in entries]
    names = [name for name in names if os.path.isfile(os.path.join(root, name))]
    if suffixes:
        names = [name for name in names if name.endswith(tuple(suffixes))]
    return sorted(set(names))


def read(root, name):
    with open(os.path.join(root, name), encoding="utf-8", errors="replace", newline="") as stream:
        return stream.read()


def top(name):
    return name.split("/", 1)[0]


def code_mask(text):
    """One bool per character: False inside comments, string and character literals."""
    mask = [True] * len(text)
    i, n = 0, len(text)
    while i < n:
        start = i
        if text.startswith("/*", i):
            end = text.find("*/", i + 2)
            i = n if end < 0 else end + 2
        elif text.startswith("//", i):
            end = text.find("\n", i)
            i = n if end < 0 else end
        elif text[i] in "\"'":
            quote = text[i]
            i += 1
            while i < n and text[i] not in (quote, "\n"):
                i += 2 if text[i] == "\\" else 1
            i = min(i + 1, n)
        else:
            i += 1
            continue
        mask[start:i] = [False] * (i - start)
    return mask


def report(problems):
    """Prints one line a problem and gives the exit status."""
    for problem in problems:
        print(problem)
    if problems:
        print(f"{os.path.basename(sys.argv[0])}: {len(problems)} problem{'s' if len(problems) > 1 else ''}")
    return 1 if problems else 0


def main(check):
    """The command line of a check that looks at sources only: [ROOT]."""
    sys.exit(report(check(sys.argv[1] if len(sys.argv) > 1 else default_root())))
