#!/usr/bin/env python3
"""Words are spelt as British dictionaries have them, in documents and in the comments of the public headers; and no file
has a slip of the pen that codespell knows.

    tools/check_spelling.py [ROOT]

tools/words.txt has the words of this project that no dictionary knows.  Code is left out: blocks, `inline`, links, names
with underscores, capitals or digits inside.  Needs hunspell, its British dictionary, and codespell (Debian packages
hunspell, hunspell-en-gb, codespell); where they are missing, the check says so and passes.

SPDX-License-Identifier: MIT
"""
import os
import re
import shutil
import subprocess
import sys

import tree

WORDS = "tools/words.txt"
BLOCK = re.compile(r"^(```|~~~).*?^\1[^\n]*$|^(?: {4}|\t)[^\n]*$|<!--.*?-->", re.M | re.S)
CODE = re.compile(r"`[^`]*`|(?<=\])\([^)\s]*\)|https?://\S+|<[^>\s]+>|\\u[0-9a-f]{4}|\S*[/\\@]\S*\.\S*")
WORD = re.compile(r"[^\W\d_]{3,}(?:['’][^\W\d_]+)*")          # shorter ones are letters of formulas
IN_CODE = re.compile(r"[\w.]*(?:_|\d|[a-z][A-Z])[\w.]*|\b[a-z]+\(|--?[a-z]+[\w-]*|\b\w+\.(?:c|h|py|md|sh|js|csv|exr|png|glb|so|info|org)\b")
# Where slips are looked for, other than in the documents.
SOURCES = (".c", ".h", ".py", ".sh", ".txt", ".cmake", ".md", ".html", ".ts", ".tsx", ".css", ".mjs")
LEFT_OUT = ("tests/data/", "tests/fuzz/corpus/", "tests/fuzz/words/", "bench/results/", "core/metals.h", "web/package-lock")


def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def prose_of(name, text):
    """The text with all but its prose blanked out, so that lines keep their numbers."""
    if name.endswith(".md"):
        # What is indented below an item of a list is its text.
        text = re.sub(r"^(\s*(?:[-*]|\d+\.) [^\n]*\n)((?: {2,}[^\n]*\n|\n(?= {2,}))*)",
                      lambda m: m.group(1) + re.sub(r"^ {4,}", "   ", m.group(2), flags=re.M), text, flags=re.M)
        text = BLOCK.sub(blank, text)
    else:
        mask = tree.code_mask(text)
        comments = "".join(c if not in_code or c == "\n" else " " for c, in_code in zip(text, mask))
        text = re.sub(r"\"[^\"\n]*\"", blank, comments)
        text = re.sub(r"^ \* {4,}[^\n]*$", blank, text, flags=re.M)
    return IN_CODE.sub(blank, CODE.sub(blank, text))


def words_of(prose):
    for number, line in enumerate(prose.split("\n"), 1):
        for match in WORD.finditer(line):
            yield number, re.sub(r"['’]s?$", "", match.group()).replace("’", "'")


def unknown(words):
    """Those that the dictionary does not have."""
    done = subprocess.run(["hunspell", "-d", "en_GB", "-i", "utf-8", "-l"], input="\n".join(sorted(words)) + "\n",
                          capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def own_words(root):
    if not os.path.exists(os.path.join(root, WORDS)):
        return []
    return [line.partition("#")[0].strip() for line in tree.read(root, WORDS).split("\n")]


def is_read(name):
    return name.endswith(".md") and not name.startswith(".github/") or name.startswith("include/")


def check_words(root):
    places = {}
    for name in tree.files(root, [".md", ".h"]):
        if is_read(name):
            for number, word in words_of(prose_of(name, tree.read(root, name))):
                places.setdefault(word, f"{name}:{number}")
    listed = [word for word in own_words(root) if word]
    known = set(listed)
    problems = [f"{places[word]}: {word}: misspelt, or a word for {WORDS}"
                for word in sorted(unknown(places)) if word not in known and word.lower() not in known]
    if listed != sorted(set(listed), key=sort_key):
        problems.append(f"{WORDS}: words are sorted, and none is there twice")
    return problems


def sort_key(word):
    return word.lower(), word


def check_slips(root):
    names = [os.path.join(root, name) for name in tree.files(root, SOURCES) if not name.startswith(LEFT_OUT)]
    ignored = ",".join(word.lower() for word in own_words(root) if word)
    done = subprocess.run(["codespell", "-L", ignored, *names], capture_output=True, text=True)
    return [line.replace(root + os.sep, "") for line in done.stdout.split("\n") if line]


def check(root):
    missing = [program for program in ("hunspell", "codespell") if not shutil.which(program)]
    if missing:
        print(f"check_spelling: skipped: {' and '.join(missing)} missing: tools/setup.sh check")
        return []
    return check_words(root) + check_slips(root)


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    tree.main(check)
