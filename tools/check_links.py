#!/usr/bin/env python3
"""What a document links to within the tree exists, and so does the heading that a link names.

    tools/check_links.py [ROOT]            the documents
    tools/check_links.py --site FOLDER     the site that tools/make_site.py has built: pages, files and anchors; and
                                           nothing is loaded from elsewhere

SPDX-License-Identifier: MIT
"""
import html.parser
import os
import re
import sys
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


class Page(html.parser.HTMLParser):
    """The anchors of a page, what it links to, and what it loads, with their lines."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loaded = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors.update(v for v in (values.get("id"), values.get("name") if tag == "a" else None) if v)
        if tag == "a" and values.get("href"):
            self.links.append((self.getpos()[0], values["href"]))
        loads = values.get("href") if tag == "link" else values.get("src")
        if loads:
            self.loaded.append((self.getpos()[0], loads))


def check_site(folder):
    pages = {name: Page(tree.read(folder, name)) for name in tree.files(folder, [".html"])}
    problems = []
    for name, page in pages.items():
        for line, link in page.links + page.loaded:
            where = f"{name}:{line}"
            if re.match(r"(data|mailto):", link):
                continue
            if re.match(r"[a-z][a-z0-9+.-]*:|//", link):
                if (line, link) in page.loaded:
                    problems.append(f"{where}: {link} is loaded from elsewhere")
                continue
            path, _, anchor = link.partition("#")
            path = unquote(path.partition("?")[0])
            target = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
            if target.startswith("..") or not os.path.isfile(os.path.join(folder, target)):
                problems.append(f"{where}: {link} does not exist")
            elif anchor and target in pages and unquote(anchor) not in pages[target].anchors:
                problems.append(f"{where}: {target} has no anchor #{anchor}")
    return problems or ([] if pages else [f"{folder}: no pages"])


if __name__ == "__main__":
    if sys.argv[1:2] == ["--site"] and len(sys.argv) == 3:
        sys.exit(tree.report(check_site(sys.argv[2])))
    tree.main(check)
