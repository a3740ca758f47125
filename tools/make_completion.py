#!/usr/bin/env python3
"""Writes the completion of `facet` for bash and zsh from its option tables: tools/make_completion.py PROGRAM FOLDER

FOLDER/facet is for bash, FOLDER/_facet for zsh.

SPDX-License-Identifier: MIT
"""
import json
import os
import subprocess
import sys

BASH = """\
# Completion of facet for bash; written by tools/make_completion.py from the program's option tables.

_facet_values() # COMMAND --OPTION: what may follow; status 1 if the option takes no value
{{
    case "$1 $2" in
{values}
    *) return 1 ;;
    esac
}}

_facet()
{{
    local word=$2 before=$3 command=${{COMP_WORDS[1]}} options operands values
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        mapfile -t COMPREPLY < <(compgen -W '{commands} help --help --version' -- "$word")
        return
    fi
    case $command in
{commands_of}
    help) mapfile -t COMPREPLY < <(compgen -W '{commands} --json' -- "$word"); return ;;
    *) return ;;
    esac
    if [ "$word" = "=" ]; then
        word=
    elif [ "$before" = "=" ]; then
        before=${{COMP_WORDS[COMP_CWORD-2]}}
    fi
    if values=$(_facet_values "$command" "$before"); then
        case $values in
        FILES) mapfile -t COMPREPLY < <(compgen -f -- "$word"); compopt -o filenames 2>/dev/null ;;
        *) mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word") ;;
        esac
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
    else
        case $operands in
        FILES) mapfile -t COMPREPLY < <(compgen -f -- "$word"); compopt -o filenames 2>/dev/null ;;
        *) mapfile -t COMPREPLY < <(compgen -W "$operands" -- "$word") ;;
        esac
    fi
}}
complete -F _facet facet
"""

ZSH = """\
#compdef facet
# Completion of facet for zsh; written by tools/make_completion.py from the program's option tables.

_facet()
{{
    local -a commands
    commands=(
{commands}
    )
    if (( CURRENT == 2 )); then
        _describe command commands
        return
    fi
    local command=$words[2]
    shift words
    (( CURRENT-- ))
    case $command in
{cases}
    help) _describe command commands ;;
    esac
}}
_facet "$@"
"""


def is_file(o):
    return "value" in o and not o["is_choice"] and any(word in o["value"] for word in ("FILE", "FOLDER"))


def operand_words(c, models):
    """What an operand of the command may be: words, FILES, or nothing."""
    text = c["operands"]
    if "SPEC" in text or "MODEL" in text:
        return " ".join(models)
    return "FILES" if text else ""


def bash(told, models):
    values, commands_of = [], []
    for c in told["commands"]:
        for o in c["options"]:
            if "value" not in o:
                continue
            spellings = ["--" + o["name"]] + (["-" + o["letter"]] if "letter" in o else [])
            names = [f"'{c['name']} {spelling}'" for spelling in spellings]
            words = o["value"].replace("|", " ") if o["is_choice"] else "FILES" if is_file(o) else ""
            values.append(f"    {'|'.join(names)}) echo '{words}' ;;")
        options = " ".join("--" + o["name"] for o in c["options"])
        commands_of.append(f"    {c['name']}) options='{options}' operands='{operand_words(c, models)}' ;;")
    return BASH.format(values="\n".join(values), commands_of="\n".join(commands_of),
                       commands=" ".join(c["name"] for c in told["commands"]))


def zsh_text(text):
    """A description inside single quotes and brackets."""
    return text.replace("'", "").replace("[", "(").replace("]", ")").replace(":", r"\:")


def zsh_option(o):
    repeated = "*" if o["is_repeated"] else ""
    action = ""
    if "value" in o:
        what = zsh_text(o["value"]) if not o["is_choice"] else "value"
        action = f":{what}:" + (f"({o['value'].replace('|', ' ')})" if o["is_choice"] else "_files" if is_file(o) else " ")
    spelled = [f"'{repeated}--{o['name']}{'=' if 'value' in o else ''}[{zsh_text(o['help'])}]{action}'"]
    if "letter" in o:
        spelled.append(f"'{repeated}-{o['letter']}{'+' if 'value' in o else ''}[{zsh_text(o['help'])}]{action}'")
    return spelled


def zsh(told, models):
    commands = "\n".join(f"        '{c['name']}:{zsh_text(c['summary'])}'" for c in told["commands"])
    cases = []
    for c in told["commands"]:
        words = operand_words(c, models)
        operands = ["'*:argument:" + ("_files" if words == "FILES" else f"({words})") + "'"]*bool(words)
        lines = [line for o in c["options"] for line in zsh_option(o)] + operands
        cases.append(f"    {c['name']})\n        _arguments \\\n            " + " \\\n            ".join(lines) + " ;;")
    return ZSH.format(commands=commands, cases="\n".join(cases))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    told = json.loads(subprocess.run([sys.argv[1], "help", "--json"], check=True, capture_output=True).stdout)
    listed = json.loads(subprocess.run([sys.argv[1], "materials", "--json"], check=True, capture_output=True).stdout)
    models = [model["name"] for model in listed]
    os.makedirs(sys.argv[2], exist_ok=True)
    for name, text in (("facet", bash(told, models)), ("_facet", zsh(told, models))):
        with open(os.path.join(sys.argv[2], name), "w", encoding="utf-8") as stream:
            stream.write(text)


if __name__ == "__main__":
    main()
