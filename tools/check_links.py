#!/usr/bin/env python3
"""What a document links to within the tree exists, and so does the heading that a link names.

SPDX-License-Identifier: MIT
"""
import os
import re
from urllib.parse import unquote

import tree

LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)|^\s*\[[^\]]+\]:\s*(\S+)", re.M)
FENCE = re.compile(r"^(```|~~~).*?^\1[^\n]*$|`[^`\n]*`", re.M | re.S)


def anchors(text):
    """The anchors that headings get, as code forges make them."""
    found, seen = set(), {}
    for heading in re.findall(r"^#{1,6}\s+(.+?)\s*#*$", text, re.M):
        slug = re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        found.add(f"{slug}-{count}" if count else slug)
    return found | set(re.findall(r"<a\s+(?:id|name)=\"([^\"]+)\"", text))


def check(root):
    problems = []
    for name in tree.files(root, [".md"]):
        text = tree.read(root, name)
        for found in LINK.finditer(FENCE.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)):
            link = unquote(found.group(1) or found.group(2))
            if re.match(r"[a-z][a-z0-9+.-]*:", link):
                continue
            path, _, anchor = link.partition("#")
            target = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
            where = f"{name}:{text.count(chr(10), 0, found.start()) + 1}"
            if path.startswith("/") or target.startswith(".."):
                problems.append(f"{where}: {link} leaves the tree")
            elif not os.path.exists(os.path.join(root, target)):
                problems.append(f"{where}: {link} does not exist")
            elif anchor and target.endswith(".md") and anchor not in anchors(tree.read(root, target)):
                problems.append(f"{where}: {target} has no heading #{anchor}")
    return problems


if __name__ == "__main__":
    tree.main(check)
