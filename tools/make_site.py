#!/usr/bin/env python3
"""Builds the documentation site from the Markdown documents as they are, the public headers, and the program's help.

    tools/make_site.py FACET FOLDER      FACET is the program `facet`; any warning is an error

docs/README.md is the start page: its headings and links are the navigation, so that it lists every document.  Documents
are laid out in build/site-source, where their links to other files of the tree become links to pages that show these;
Sphinx with MyST-Parser and Furo does the rest (docs/site).  Needs the group `site` of tools/packages.txt.

SPDX-License-Identifier: MIT
"""
import json
import os
import posixpath
import re
import shutil
import subprocess
import sys
from urllib.parse import unquote

import check_links
import command_pages
import header_pages
import tree

START = "docs/README.md"
PICTURES = (".svg", ".png", ".jpg", ".gif")
COMMANDS = "commands.rst"           # behind docs/cli.md
GENERATED = {"include/facet/facet.h": "api/facet.rst", "include/facet/plugin.h": "api/plugin.rst"}


def documents(root):
    return [name for name in tree.files(root, [".md"]) if not name.startswith((".github/", "build/"))]


def staged_name(name, documents_):
    """Where a file of the tree is on the site; None: on a page of its own that shows it."""
    if name == START:
        return "index.md"
    if name in GENERATED:
        return GENERATED[name]
    return name if name in documents_ or name.endswith(PICTURES) else None


def rewritten(text, name, documents_):
    """The document with links that hold where it is laid out, and the pictures that it shows."""
    pictures = set()
    home = posixpath.dirname(staged_name(name, documents_))

    def link_of(match):
        link = unquote(match.group(1) or match.group(2))
        if re.match(r"[a-z][a-z0-9+.-]*:", link) or link.startswith("#"):
            return match.group()
        path, _, anchor = link.partition("#")
        target = posixpath.normpath(posixpath.join(posixpath.dirname(name), path))
        staged = staged_name(target, documents_)
        if staged is None:
            new = "tree:" + target
        else:
            new = posixpath.relpath(staged, home or ".") + (anchor and "#" + anchor)
            if target.endswith(PICTURES):
                pictures.add(target)
        group = 1 if match.group(1) else 2
        begin, end = match.start(group) - match.start(), match.end(group) - match.start()
        return match.group()[:begin] + new + match.group()[end:]

    # Code is left alone: what looks like a link there is none.
    parts, at = [], 0
    for code in check_links.FENCE.finditer(text):
        parts += [(text[at:code.start()], True), (code.group(), False)]
        at = code.end()
    parts.append((text[at:], True))
    blank = "\0"
    code = [part for part, is_prose in parts if not is_prose]
    prose = blank.join(part for part, is_prose in parts if is_prose)
    pieces = check_links.LINK.sub(link_of, prose).split(blank)
    return "".join(p for pair in zip(pieces, code + [""]) for p in pair), pictures


def navigation(text):
    """Tables of contents, a hidden one for each heading of the start page, with its links in their order."""
    entries = []
    for section in re.split(r"^## ", text, flags=re.M)[1:]:
        heading, _, body = section.partition("\n")
        links = re.findall(r"(?<!!)\[([^\]]+)\]\(([^):#]+\.(?:md|rst))\)", body)
        paths = [path for _, path in links]
        if "docs/cli.md" in paths:
            links.insert(paths.index("docs/cli.md") + 1, ("Commands", COMMANDS))
        rows = "".join(f"{' '.join(label.split())} <{os.path.splitext(path)[0]}>\n" for label, path in links)
        entries.append(f"```{{toctree}}\n:hidden:\n:caption: {heading}\n\n{rows}```\n")
    return "\n" + "\n".join(entries)


def lay_out(root, program, folder):
    shutil.rmtree(folder, ignore_errors=True)
    names = documents(root)
    known, pictures = set(names), set()

    def write(path, text):
        path = os.path.join(folder, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)

    for name in names:
        text, shown = rewritten(tree.read(root, name), name, known)
        pictures |= shown
        write(staged_name(name, known), text + navigation(text) if name == START else text)
    for header, page in GENERATED.items():
        write(page, header_pages.page(header, [tree.read(root, h) for h in GENERATED], list(GENERATED).index(header)))
    told = subprocess.run([program, "help", "--json"], capture_output=True, text=True, check=True).stdout
    write(COMMANDS, command_pages.page(json.loads(told)))
    for picture in pictures:
        os.makedirs(os.path.dirname(os.path.join(folder, picture)), exist_ok=True)
        shutil.copyfile(os.path.join(root, picture), os.path.join(folder, picture))


def version(root):
    return re.search(r"project\(facet VERSION ([0-9.]+)", tree.read(root, "CMakeLists.txt")).group(1)


def completed_style(style):
    """furo.css with what Debian's build of it lacks: the reset of browsers' margins and fonts, which it looks for at the root
    of a server, and dark colours where the browser, not the reader's click, asks for them."""
    reset = ("html { line-height: 1.15; -webkit-text-size-adjust: 100%; }\nbody { margin: 0; }\n"
             "pre, code, kbd, samp { font-size: 1em; }\nimg { border-style: none; }\n"
             "button, input { font: inherit; margin: 0; overflow: visible; }\n")
    style = re.sub(r"@import url\(/javascript/normalize\.css/normalize\.css\);\n?", reset, style)
    if "prefers-color-scheme" in style:
        return style
    colours = re.search(r'body\[data-theme="dark"\] \{([^{}]*--color-background-primary[^{}]*)\}', style)
    if not colours:
        raise ValueError("furo.css: has no colours for the dark")
    return (f"{style}\n@media not print {{\n@media (prefers-color-scheme: dark) {{\n"
            f'body:not([data-theme="light"]) {{{colours[1]}}}\n}}\n}}\n')


def completed_script(script, gumshoe):
    """furo.js, which Debian leaves in parts, with the part that it imports: a page's script cannot import, so that nothing of
    it would run, and no button would switch between light and dark."""
    alone = re.sub(r'^import Gumshoe from "\./gumshoe-patched\.js";\n', "", script)
    return script if alone == script else f"{gumshoe}\n{alone}"


def complete_theme(folder):
    """Makes the theme whole, where a distribution has taken it apart."""
    def path(*names):
        return os.path.join(folder, "_static", *names)

    def change(name, changed):
        with open(name, encoding="utf-8") as stream:
            text = stream.read()
        with open(name, "w", encoding="utf-8") as stream:
            stream.write(changed(text))

    change(path("styles", "furo.css"), completed_style)
    gumshoe = path("scripts", "gumshoe-patched.js")
    if os.path.exists(gumshoe):
        with open(gumshoe, encoding="utf-8") as stream:
            part = stream.read()
        change(path("scripts", "furo.js"), lambda script: completed_script(script, part))
        os.remove(gumshoe)


def build(root, program, folder):
    source = os.path.join(root, "build", "site-source")
    lay_out(root, program, source)
    shutil.rmtree(folder, ignore_errors=True)
    done = subprocess.run(
        ["sphinx-build", "-q", "-W", "--keep-going", "-n", "-b", "html", "-c", os.path.join(root, "docs", "site"),
         "-d", os.path.join(root, "build", "site-doctrees"), "-E", source, folder],
        env={**os.environ, "FACET_VERSION": version(root), "PYTHONDONTWRITEBYTECODE": "1"})
    if done.returncode:
        return ["the site was not built without a warning"]
    complete_theme(folder)
    return check_links.check_site(folder)


def main(arguments):
    root = tree.default_root()
    if any(a.startswith("-") for a in arguments) or len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    if not shutil.which("sphinx-build"):
        print("make_site.py: no sphinx-build: tools/setup.sh site", file=sys.stderr)
        return 1
    folder = os.path.abspath(arguments[1])
    status = tree.report(build(root, os.path.abspath(arguments[0]), folder))
    if not status:
        print(f"the site: {os.path.relpath(folder)}/index.html")
    return status


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.exit(main(sys.argv[1:]))
