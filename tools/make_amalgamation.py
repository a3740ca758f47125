#!/usr/bin/env python3
"""Writes libfacet as one file: tools/make_amalgamation.py FOLDER      makes FOLDER/facet.c and FOLDER/facet.h

    cc -O3 -fopenmp-simd -ffp-contract=off -c facet.c

The files of core/ are compiled several times with other settings (float and double, one loop file for each instruction
set), and each has static names of its own.  So each translation unit becomes a part of facet.c with its headers put in,
in which every name declared at file scope is given the part's prefix by a macro, and all macros end with the part.
Names by which parts call each other are renamed, too, and given back to the linker by `#pragma redefine_extname`, which
gcc and clang have.  The names are found in what the C preprocessor ($CC, cc) makes of the part.

SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PUBLIC = os.path.join(ROOT, "include", "facet", "facet.h")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^">]+)[">].*$')
MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", re.M)
TOKEN = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|[A-Za-z_]\w*|\.?\d(?:[\w.]|(?<=[eEpP])[+-])*|\S')
WORD = re.compile(r"[A-Za-z_]\w*")
CLOSING = {"(": ")", "{": "}", "[": "]"}
ATTRIBUTES = {"__attribute__", "__extension__", "_Atomic", "_Static_assert", "__asm__", "_Alignas", "__typeof__"}
KEYWORDS = set("""auto break case char const continue default do double else enum extern float for goto if inline int long
    register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while _Bool
    __inline __inline__ __const""".split())

OPENING = """\
/* facet.c: libfacet {version} as one file.  Written by tools/make_amalgamation.py: change core/, not this.
 *
 *     cc -O3 -fopenmp-simd -ffp-contract=off -c facet.c
 *
 * The header facet.h is the reference.  Without -ffp-contract=off the instruction sets need not agree bit for bit.
 *
{licence}
 */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#if defined(__GNUC__) /* a part does not use all that its headers have */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-const-variable"
#pragma GCC diagnostic ignored "-Wunknown-pragmas" /* omp simd, without -fopenmp-simd */
#endif
"""


def read(path):
    with open(path, encoding="utf-8") as stream:
        return stream.read()


# ---- The text of a part ---------------------------------------------------------------------------

def inline(path, seen, system):
    """The file with its own headers put in where they are first included; system headers go to `system`."""
    lines = []
    for line in read(path).split("\n"):
        found = INCLUDE.match(line)
        if line.strip() == "#pragma once":
            continue
        if not found:
            lines.append(line)
            continue
        header = found.group(2)
        if found.group(1) == "<":
            system.add(header)
            continue
        places = [os.path.normpath(os.path.join(folder, header))
                  for folder in (os.path.dirname(path), ROOT, os.path.join(ROOT, "include"))]
        target = next((place for place in places if os.path.isfile(place)), None)
        if target is None:
            sys.exit(f"{path}: {header} was not found")
        if target == PUBLIC or target in seen:
            continue
        seen.add(target)
        lines.append(inline(target, seen, system).rstrip("\n"))
    return "\n".join(lines)


# ---- The names of a part --------------------------------------------------------------------------

def preprocess(path):
    """The tokens of the file and its own headers, the public one apart; and those of the public one."""
    command = [os.environ.get("CC", "cc"), "-E", "-fopenmp-simd", "-D_POSIX_C_SOURCE=200809L", "-I" + os.path.join(ROOT, "include"),
               "-I" + ROOT, path]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    own, public = [], []
    where = own
    for line in text.split("\n"):
        if line.startswith("# "):
            name = os.path.normpath(line.split('"')[1])
            where = public if name == PUBLIC else own if name.startswith(ROOT + os.sep) else []
        elif not line.startswith("#"):
            where.append(line)
    return TOKEN.findall("\n".join(own)), TOKEN.findall("\n".join(public))


def groups(tokens):
    """Tokens with what stands in brackets as lists: ['f', ['(', 'int', 'x'], ['{', ...]]."""
    stack = [[]]
    for token in tokens:
        if token in CLOSING:
            stack.append([token])
        elif token in CLOSING.values():
            group = stack.pop()
            stack[-1].append(group)
        else:
            stack[-1].append(token)
    return stack[0]


def declarations(tokens):
    """The declarations of a file, as lists of tokens and groups."""
    statement = []
    for token in groups(tokens):
        statement.append(token)
        is_body = token[0] == "{" and len(token) > 0 and isinstance(token, list)
        begins = statement[0] if isinstance(statement[0], str) else ""
        is_function = is_body and "=" not in statement and any(isinstance(t, list) and t[0] == "(" for t in statement[:-1])
        if token == ";" or (is_function and begins != "typedef"):
            yield statement
            statement = []


def enumerators(group):
    """The constants of { A, B = 2, ... }."""
    is_name = True
    for token in group[1:]:
        if is_name and isinstance(token, str) and WORD.fullmatch(token):
            yield token
        is_name = token == ","


def simplify(statement):
    """Without attributes and the like, and without the bodies of structs; their names are left."""
    out, is_argument = [], False
    for token in statement:
        if isinstance(token, list) and (is_argument or token[0] == "{"):
            is_argument = False
            continue
        is_argument = isinstance(token, str) and token in ATTRIBUTES
        if not is_argument:
            out.append(token)
    return out


def names_of(statement):
    """What a declaration declares, and whether that is for the linker."""
    is_typedef, is_static = "typedef" in statement, "static" in statement
    for i, token in enumerate(statement):
        if token in ("struct", "union", "enum"):
            after = [t for t in simplify(statement[i + 1:i + 4]) if isinstance(t, str)]
            body = next((t for t in statement[i + 1:i + 5] if isinstance(t, list) and t[0] == "{"), None)
            if after and WORD.fullmatch(after[0]) and not (body is None and ";" not in statement[i + 1:i + 3]):
                yield after[0], False
            if token == "enum" and body:
                yield from ((name, False) for name in enumerators(body))
    if "_Static_assert" in statement:
        return
    declarator = []
    for token in simplify(statement):
        if token in (",", ";", "="):
            name = declared(declarator)
            if name:
                yield name, not is_typedef and not is_static
            if token == "=":
                return
            declarator = declarator[:1] if token == "," else []
        else:
            declarator.append(token)
    name = declared(declarator)
    if name:
        yield name, not is_typedef and not is_static


def declared(declarator):
    """The name in a declarator such as `const char * name (..)`, `name [3]` or `( * name ) (..)`."""
    before = None
    for token in declarator:
        if isinstance(token, list):
            inner = [t for t in token[1:] if isinstance(t, str)]
            if token[0] == "(" and inner[:1] == ["*"] and (before is None or before in KEYWORDS or len(inner) == 2):
                return inner[1] if len(inner) > 1 else None
            break
        before = token
    words = [t for t in declarator if isinstance(t, str) and WORD.fullmatch(t)]
    if before is None or len(words) < 2 or before in KEYWORDS or not WORD.fullmatch(before):
        return None
    return before


def all_names(tokens):
    found = {}
    for statement in declarations(tokens):
        for name, is_linked in names_of(statement):
            found[name] = found.get(name, False) or is_linked
    return found


# ---- The file -------------------------------------------------------------------------------------

def part(path, prefix, system):
    tokens, public_tokens = preprocess(path)
    public = all_names(public_tokens)
    names = {name: linked for name, linked in all_names(tokens).items() if name not in public}
    text = inline(path, set(), system)
    out = [f"/* ---- {os.path.relpath(path, ROOT)} " + "-"*60 + " */\n"]
    for name, is_linked in sorted(names.items()):
        if is_linked:  # before the macro, which would replace the name in the pragma, too
            out.append(f"#pragma redefine_extname {prefix}{name} {name}")
        out.append(f"#define {name} {prefix}{name}")
    out.append("#if defined(__GNUC__) && !defined(__clang__)\n#pragma GCC push_options\n#endif\n")
    out.append(text)
    out.append("#if defined(__GNUC__) && !defined(__clang__)\n#pragma GCC pop_options\n#endif")
    out += [f"#undef {name}" for name in sorted(set(names) | set(MACRO.findall(text)))]
    return "\n".join(out) + "\n"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    header = read(PUBLIC)
    version = subprocess.run([os.environ.get("CC", "cc"), "-E", "-dM", PUBLIC], check=True, capture_output=True, text=True).stdout
    numbers = dict(re.findall(r"#define FACET_VERSION_(MAJOR|MINOR|PATCH) (\d+)", version))
    system, parts = {"stddef.h", "stdint.h"}, []
    for i, path in enumerate(sorted(glob.glob(os.path.join(ROOT, "core", "*.c")))):
        parts.append(part(path, f"facet{i}_", system))
    licence = "\n".join((" * " + line).rstrip() for line in read(os.path.join(ROOT, "LICENSE")).strip().split("\n"))
    told = ".".join(numbers.get(key, "") for key in ("MAJOR", "MINOR", "PATCH")).strip(".")
    opening = OPENING.format(version=told, licence=licence)
    includes = "".join(f"#include <{name}>\n" for name in sorted(system))
    os.makedirs(sys.argv[1], exist_ok=True)
    with open(os.path.join(sys.argv[1], "facet.h"), "w", encoding="utf-8") as stream:
        stream.write(header)
    with open(os.path.join(sys.argv[1], "facet.c"), "w", encoding="utf-8") as stream:
        stream.write(opening + includes + '\n#include "facet.h"\n\n' + "\n".join(parts) +
                     "\n#if defined(__GNUC__)\n#pragma GCC diagnostic pop\n#endif\n")


if __name__ == "__main__":
    main()
