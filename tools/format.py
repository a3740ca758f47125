#!/usr/bin/env python3
"""Lays out the C files: clang-format 14 with .clang-format, then products, quotients and remainders tightened.

    tools/format.py [--check] [FILE ...]      default: every C file of the tree

clang-format writes `a * b + c`; STYLE asks for `a*b + c`.  After clang-format, a star between two spaces is
always a product (a pointer is written `char *p`), so ` * `, ` / ` and ` % ` lose their spaces outside comments and
literals.  What clang-format aligned behind them (continuation lines, trailing comments) moves along, so that
laying out twice changes nothing.  Regions between `clang-format off` and `on` stay as they are, and so do files that
say in their opening comment that a script wrote them (`Written by tools/...`).

SPDX-License-Identifier: MIT
"""
import bisect
import difflib
import os
import re
import subprocess
import sys

import tree

CLANG_FORMAT = os.environ.get("CLANG_FORMAT", "clang-format-14")
OPERATOR = re.compile(r" [*%] (?!\\)| / (?![*/\\])| [*/%]$")


class Line:
    """A line of clang-format's output and its tightened form."""

    def __init__(self, text, mask, frozen):
        self.indent = len(text) - len(text.lstrip())
        self.begins_in_comment = bool(text) and not mask[self.indent if self.indent < len(text) else 0] \
            and not text.lstrip().startswith(("/*", "//", '"', "'"))
        self.comment = None  # column of a comment that ends the line
        code_end = len(text)
        while code_end and (not mask[code_end - 1] or text[code_end - 1] == " "):
            code_end -= 1
        tail = re.match(r" *(/\*|//)", text[code_end:])
        if tail and not self.begins_in_comment:
            self.comment = code_end + tail.start(1)
        self.has_code = code_end > self.indent
        self.removed = []  # columns of the spaces that go
        if not frozen:
            for found in OPERATOR.finditer(text):
                if all(mask[found.start():found.end()]) and found.start() >= self.indent:
                    self.removed += [i for i in range(found.start(), found.end()) if text[i] == " "]
        self.old = text
        gone = set(self.removed)
        self.new = "".join(c for i, c in enumerate(text) if i not in gone)

    def column(self, old_column):
        """Where the character at a column of the old line is in the new one."""
        moved = len(self.new) - len(self.new.lstrip()) - self.indent
        return old_column - bisect.bisect_left(self.removed, old_column) + moved

    def shift(self, columns):
        if columns >= 0:
            self.new = " " * columns + self.new
        else:
            self.new = self.new[min(-columns, len(self.new) - len(self.new.lstrip())):]


def move_continuations(lines):
    """A line that was aligned with a token of a line above stays aligned with it."""
    for i, line in enumerate(lines):
        if not line.old.strip() or line.begins_in_comment or not line.has_code:
            continue
        for above in reversed(lines[max(0, i - 60):i]):
            if not above.old.strip() or above.begins_in_comment or above.indent > line.indent:
                continue
            if above.indent == line.indent:
                line.shift(above.column(above.indent) - line.indent)
            elif line.indent < len(above.old) and above.old[line.indent] != " " and \
                    above.old[line.indent - 1] in " ([{":
                line.shift(above.column(line.indent) - line.indent)
            else:
                line.shift(above.column(above.indent) - above.indent)
            break


def move_comments(lines):
    """Trailing comments that stood in one column stand in one column again."""
    i = 0
    while i < len(lines):
        if lines[i].comment is None or not lines[i].has_code:
            i += 1
            continue
        column, end = lines[i].comment, i
        while end < len(lines) and (lines[end].comment == column or lines[end].begins_in_comment):
            end += 1
        group = lines[i:end]
        code = [line for line in group if line.comment is not None and line.has_code]
        gap = min(column - len(line.old[:column].rstrip()) for line in code)
        cut = {id(line): len(line.new) - (len(line.old) - column) for line in code}
        target = max(len(line.new[:cut[id(line)]].rstrip()) for line in code) + gap
        for line in group:
            if line.comment is not None and line.has_code:
                line.new = line.new[:cut[id(line)]].rstrip().ljust(target) + line.new[cut[id(line)]:]
            elif line.old.strip():
                line.shift(target - column - (len(line.new) - len(line.new.lstrip()) - line.indent))
        i = end


def tighten(text):
    """clang-format's output with products and quotients as STYLE asks."""
    mask, position, frozen, lines = tree.code_mask(text), 0, False, []
    for raw in text.split("\n"):
        if "clang-format off" in raw:
            frozen = True
        lines.append(Line(raw, mask[position:position + len(raw)], frozen))
        if "clang-format on" in raw:
            frozen = False
        position += len(raw) + 1
    move_continuations(lines)
    move_comments(lines)
    for line in lines:
        if line.old.endswith(" \\"):  # a macro goes on: the backslashes stand in one column
            line.new = line.new[:-1].rstrip().ljust(len(line.old) - 1) + "\\"
    return "\n".join(line.new for line in lines)


def laid_out(path):
    done = subprocess.run([CLANG_FORMAT, "--style=file", path], capture_output=True, text=True, check=True)
    return tighten(done.stdout)


def main():
    arguments = sys.argv[1:]
    check = "--check" in arguments
    root = tree.default_root()
    paths = [a for a in arguments if a != "--check"] or [os.path.join(root, f) for f in tree.files(root, [".c", ".h"])]
    n_wrong = 0
    for path in paths:
        with open(path, encoding="utf-8", newline="") as stream:
            old = stream.read()
        if re.search(r"^\W*Written by tools/", old[:1000], re.M):
            continue
        try:
            new = laid_out(path)
        except FileNotFoundError:
            sys.exit(f"{CLANG_FORMAT} was not found: install it with `apt-get install clang-format-14`")
        if old == new:
            continue
        n_wrong += 1
        name = os.path.relpath(path, root)
        if check:
            sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), new.splitlines(True), name,
                                                       f"{name} as `make format` writes it"))
        else:
            with open(path, "w", encoding="utf-8", newline="") as stream:
                stream.write(new)
            print(f"laid out {name}")
    print(f"{len(paths)} files, {n_wrong} {'to lay out: run `make format`' if check else 'changed'}")
    return 1 if check and n_wrong else 0


if __name__ == "__main__":
    sys.exit(main())
