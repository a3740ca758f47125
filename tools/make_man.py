#!/usr/bin/env python3
"""Writes the man pages of `facet` from what its --help says: tools/make_man.py PROGRAM FOLDER

facet.1, and facet-COMMAND.1 for each command.

SPDX-License-Identifier: MIT
"""
import datetime
import json
import os
import re
import subprocess
import sys

OVERVIEW = """\
libfacet is a library of microfacet reflection; facet evaluates, samples, plots and verifies its models, and renders
glTF scenes with them.  Materials are written as MODEL key=value ..., such as `ggx alpha=.3 ks=.9,.7,.3`; `facet
materials` lists the models and their keys.  Directions are unit vectors in the local frame with the normal (0,0,1),
pointing away from the surface.  Results go to stdout, messages and progress to stderr."""


def escape(text):
    """Text for roff: nothing in it is a command, and every dash is a dash that can be typed."""
    text = text.replace("\\", r"\e").replace("-", r"\-").replace("^", r"\(ha").replace("~", r"\(ti")
    text = re.sub(r"`([^`\n]*)`", r"\\fB\1\\fR", text).replace("'", r"\(aq").replace("`", r"\(ga")
    return "\n".join(r"\&" + line if line[:1] in (".", "'") else line for line in text.split("\n"))


def paragraphs(text):
    """The help's description: lines that are indented keep their form, the others are filled."""
    out, is_table = [], False
    for line in text.rstrip("\n").split("\n"):
        if line.startswith(" ") != is_table:
            is_table = not is_table
            out.append(".PP\n.nf" if is_table else ".fi\n.PP")
        out.append(escape(line) if line.strip() else ".PP")
    return "\n".join(out + [".fi"]*is_table) + "\n"


def head(name, summary, version):
    # The date is that of the package (dpkg sets it), so that the pages are the same bytes whenever they are made.
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    date = datetime.datetime.fromtimestamp(int(epoch), datetime.timezone.utc).strftime("%Y-%m-%d") if epoch else ""
    return (f".\\\" Written by tools/make_man.py from the program's own help.\n"
            f".TH {name.upper().replace('-', chr(92) + '-')} 1 \"{date}\" \"facet {version}\" \"User Commands\"\n"
            f".SH NAME\n{escape(name)} \\- {escape(summary)}\n")


def option(o):
    spelled = f"\\fB\\-\\-{escape(o['name'])}\\fR"
    if "letter" in o:
        spelled = f"\\fB\\-{o['letter']}\\fR, " + spelled
    if "value" in o:
        spelled += " " + (escape(o["value"]) if o["is_choice"] else f"\\fI{escape(o['value'])}\\fR")
    return f".TP\n{spelled}\n{escape(o['help'])}\n"


def exit_status(text):
    rows = [line.split(None, 1) for line in text.strip().split("\n")[1:]]
    return ".SH EXIT STATUS\n" + "".join(f".TP\n.B {status}\n{escape(meaning)}\n" for status, meaning in rows)


def examples(text):
    return f".SH EXAMPLES\n.nf\n{escape(text.rstrip(chr(10)))}\n.fi\n"


def command_page(c, told):
    name = "facet-" + c["name"]
    operands = f" {escape(c['operands'])}" if c["operands"] else ""
    return (head(name, c["summary"], told["version"]) +
            f".SH SYNOPSIS\n\\fBfacet {escape(c['name'])}\\fR [\\fIOPTION\\fR]...{operands}\n"
            f".SH DESCRIPTION\n{paragraphs(c['description'])}"
            ".SH OPTIONS\n" + "".join(map(option, c["options"])) + exit_status(told["exit_status"]) +
            examples(c["examples"]) + ".SH SEE ALSO\n.BR facet (1)\n")


def overview_page(told):
    commands = "".join(f".TP\n.BR facet\\-{c['name']} (1)\n{escape(c['summary'])}\n" for c in told["commands"])
    return (head("facet", "microfacet reflection, exact, and a path tracer built on it", told["version"]) +
            ".SH SYNOPSIS\n\\fBfacet\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]... [\\fIARGUMENT\\fR]...\n"
            f".SH DESCRIPTION\n{escape(OVERVIEW)}\n.SH COMMANDS\n{commands}"
            ".TP\n\\fBfacet help\\fR [\\fICOMMAND\\fR]\nthe overview, or the help of a command\n"
            ".TP\n\\fBfacet \\-\\-version\\fR\nthe version\n" + exit_status(told["exit_status"]) +
            examples("  facet render\n  facet albedo 'ggx alpha=.3 ks=.9,.7,.3'\n"))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    told = json.loads(subprocess.run([sys.argv[1], "help", "--json"], check=True, capture_output=True).stdout)
    pages = {"facet": overview_page(told)}
    pages.update({"facet-" + c["name"]: command_page(c, told) for c in told["commands"]})
    os.makedirs(sys.argv[2], exist_ok=True)
    for name, text in pages.items():
        with open(os.path.join(sys.argv[2], name + ".1"), "w", encoding="utf-8") as stream:
            stream.write(text)


if __name__ == "__main__":
    main()
