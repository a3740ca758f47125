#!/usr/bin/env python3
"""Writes a notebook from a readable source: `# %% [markdown]` and `# %%` begin cells.  Each is run, and what it prints and
shows goes into the notebook.

    python/tools/make_notebook.py NOTEBOOK.py       writes NOTEBOOK.ipynb beside it; needs facet installed

SPDX-License-Identifier: MIT
"""
import ast
import contextlib
import io
import json
import os
import re
import sys


def cells_of(text):
    """(kind, source) of each cell."""
    parts = re.split(r"^# %%(.*)\n", text, flags=re.M)[1:]
    for head, body in zip(parts[::2], parts[1::2]):
        if "[markdown]" in head:
            yield "markdown", "\n".join(re.sub(r"^# ?", "", line) for line in body.strip().split("\n"))
        else:
            yield "code", body.strip()


def run(source, names, where):
    """Runs a cell as a notebook does: gives what it printed, and the value of its last expression."""
    tree = ast.parse(source, where)
    last = ast.Expression(tree.body.pop().value) if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, where, "exec"), names)
        value = eval(compile(last, where, "eval"), names) if last else None
    return printed.getvalue(), value


def outputs_of(printed, value, count):
    outputs = []
    if printed:
        outputs.append({"name": "stdout", "output_type": "stream", "text": printed.splitlines(True)})
    if value is not None:
        data = {"text/plain": [repr(value) if "object at" not in repr(value) else type(value).__name__]}
        for kind, method in (("image/svg+xml", "_repr_svg_"), ("text/html", "_repr_html_")):
            if hasattr(value, method):
                data[kind] = [getattr(value, method)()]
        outputs.append({"data": data, "execution_count": count, "metadata": {}, "output_type": "execute_result"})
    return outputs


def notebook(text, where):
    names, cells, count = {"__name__": "__main__"}, [], 0
    for number, (kind, source) in enumerate(cells_of(text)):
        cell = {"cell_type": kind, "id": f"cell-{number:02}", "metadata": {}, "source": source.splitlines(True)}
        if kind == "code":
            count += 1
            cell.update(execution_count=count, outputs=outputs_of(*run(source, names, f"{where}, cell {number}"), count))
        cells.append(cell)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": cells, "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}}, "nbformat": 4,
            "nbformat_minor": 5}


def main():
    path = sys.argv[1]
    with open(path, encoding="utf-8") as stream:
        made = notebook(stream.read(), os.path.basename(path))
    with open(os.path.splitext(path)[0] + ".ipynb", "w", encoding="utf-8") as stream:
        json.dump(made, stream, indent=1, ensure_ascii=False)
        stream.write("\n")


if __name__ == "__main__":
    main()
