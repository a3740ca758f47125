#!/usr/bin/env python3
"""Writes NAME-VERSION.dist-info/METADATA, by which pip knows the package where another tool than pip installs it.

    python/tools/make_metadata.py FOLDER

Name and needs are those of pyproject.toml, the version that of CMakeLists.txt.

SPDX-License-Identifier: MIT
"""
import pathlib
import re
import sys
import tomllib


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    build = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))
    project, rule = build["project"], build["tool"]["scikit-build"]["metadata"]["version"]
    version = re.search(rule["regex"], (root / rule["input"]).read_text(encoding="utf-8"))["value"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}",
             f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}",
             *(f"Requires-Dist: {need}" for need in project["dependencies"])]
    folder = pathlib.Path(sys.argv[1]) / f"{project['name'].replace('-', '_')}-{version}.dist-info"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "METADATA").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "INSTALLER").write_text("debian\n", encoding="utf-8")


if __name__ == "__main__":
    main()
