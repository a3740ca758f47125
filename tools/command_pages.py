"""The commands as a page of the site, in reStructuredText, from what `facet help --json` says.

SPDX-License-Identifier: MIT
"""
import re


def words(text):
    """Text that reStructuredText shows as it is, with `code` as code."""
    parts = re.split(r"`([^`]+)`", text)
    return "".join(f"\\ ``{part}``\\ " if k % 2 else re.sub(r"([*`|_\\<>\[\]])", r"\\\1", part)
                   for k, part in enumerate(parts))


def code(text):
    return "\n".join(["::", "", *("    " + line for line in text.rstrip("\n").split("\n"))])


def description(text):
    """Paragraphs; lines that are indented keep their form."""
    out, rows, is_table = [], [], False

    def end():
        if any(row.strip() for row in rows):
            out.append(code("\n".join(rows).strip("\n")) if is_table else words(" ".join(r.strip() for r in rows)))
        rows.clear()

    for line in text.rstrip("\n").split("\n"):
        if not line.strip() or line.startswith(" ") != is_table:
            end()
            is_table = line.startswith(" ")
        if line.strip():
            rows.append(line)
    end()
    return "\n\n".join(out)


def option(o):
    value = " " + o["value"] if "value" in o else ""
    letter = f"-{o['letter']}{value}, " if "letter" in o else ""
    return f".. option:: {letter}--{o['name']}{value}\n\n    {words(' '.join(o['help'].split()))}"


def section(command):
    name = f"facet {command['name']}"
    usage = f"{name} [OPTION]... {command['operands']}".strip()
    return "\n\n".join([
        f"{name}\n{'-'*len(name)}", f".. program:: {name}", words(command["summary"][:1].upper() + command["summary"][1:]) + ".",
        code(usage), description(command["description"]), *map(option, command["options"]), "Examples:",
        code(command["examples"].replace("\n  ", "\n").strip())])


def page(told):
    lead = ("Every command with all of its options, as ``facet COMMAND --help`` and the man pages tell them. What all commands\n"
            "share is told by :doc:`docs/cli`.")
    status = told["exit_status"].split("\n", 1)[1]
    return "\n\n".join(["Commands\n========", lead, *map(section, told["commands"]), "Exit status\n-----------",
                        code(re.sub(r"^  ", "", status, flags=re.M))]) + "\n"
