"""Sphinx extension: links of the form tree:PATH lead to a page that shows that file, or lists that folder, of the tree.

SPDX-License-Identifier: MIT
"""
import html
import os
import posixpath

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCHEME = "tree:"


def page_of(path):
    """The name of the page of a file or a folder."""
    return posixpath.join("source", path, "index" if os.path.isdir(os.path.join(ROOT, path)) else "").rstrip("/")


def files_below(path):
    for folder, folders, names in os.walk(os.path.join(ROOT, path)):
        folders[:] = sorted(f for f in folders if f != "__pycache__")
        for name in sorted(names):
            yield os.path.relpath(os.path.join(folder, name), ROOT).replace(os.sep, "/")


def resolve(app, doctree, docname):
    for reference in doctree.findall(nodes.reference):
        uri = reference.get("refuri", "")
        if uri.startswith(SCHEME):
            path = uri[len(SCHEME):].rstrip("/")
            app.env.facet_sources.add(path)
            reference["refuri"] = app.builder.get_relative_uri(docname, page_of(path))


def file_body(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as stream:
        text = stream.read()
    try:
        lexer = get_lexer_for_filename(path)
    except ClassNotFound:
        lexer = TextLexer()
    return highlight(text, lexer, HtmlFormatter(wrapcode=True))


def folder_body(path, paths):
    rows = (f'<li><a href="{html.escape(posixpath.relpath(p, path))}.html">'
            f"<code>{html.escape(posixpath.relpath(p, path))}</code></a></li>" for p in paths)
    return f"<ul>{''.join(rows)}</ul>"


def pages(app):
    wanted = set(app.env.facet_sources)
    for path in sorted(wanted):
        if os.path.isdir(os.path.join(ROOT, path)):
            inside = [p for p in files_below(path) if p not in wanted]
            everything = list(files_below(path))
            wanted.update(inside)
            yield page_of(path), context(path, folder_body(path, everything)), "page.html"
    for path in sorted(wanted):
        if os.path.isfile(os.path.join(ROOT, path)):
            yield page_of(path), context(path, file_body(path)), "page.html"


def context(path, body):
    return {"title": path, "body": f"<h1><code>{html.escape(path)}</code></h1>{body}"}


def begin(app, env, docnames):
    env.facet_sources = set()


def setup(app):
    app.connect("env-before-read-docs", begin)
    app.connect("doctree-resolved", resolve)
    app.connect("html-collect-pages", pages)
    return {"parallel_read_safe": False, "parallel_write_safe": False}
