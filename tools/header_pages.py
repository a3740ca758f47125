"""A public header as a page of the site, in reStructuredText: its comments are the text, its declarations the entries.

A header is read as it is written: `/* ---- Heading --- */` begins a section, and a comment belongs to the declarations
that follow it up to the next empty line or comment.

SPDX-License-Identifier: MIT
"""
import re
from typing import NamedTuple

SECTION = re.compile(r"/\* -{4} (.+?) -{4,} \*/$")
HIDDEN = re.compile(r"#\s*(if|ifdef|endif|else|include|pragma)\b|extern \"C\"|\}$")
DOCUMENT = r"docs/[\w/-]+\.md"
KINDS = {"function": "func", "type": "type", "macro": "macro"}


class Declaration(NamedTuple):
    kind: str              # function, type, macro, or constants
    names: tuple           # of which the first is the entry's
    text: str              # as it is written


def opening(text):
    """The first comment: (its first line without the file's name, the rest without the licence)."""
    lines = [re.sub(r"^(/\*| \*/?) ?", "", line) for line in text[:text.index("*/")].split("\n")]
    return lines[0].partition(": ")[2], "\n".join(line for line in lines[1:] if "SPDX" not in line).strip("\n")


def declaration(text):
    text = re.sub(r"^FACET_(API|PLUGIN) ", "", text)
    code = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    if code.startswith("#define"):
        return Declaration("macro", (re.match(r"#define (\w+)", code).group(1),), text)
    if code.startswith("enum"):
        return Declaration("constants", tuple(re.findall(r"\bFACET_\w+", code)), text)
    if code.startswith("typedef"):
        name = re.search(r"(\w+);$", code).group(1)
        constants = re.findall(r"\bFACET_\w+", code) if code.startswith("typedef enum") else []
        return Declaration("type", (name, *constants), text)
    return Declaration("function", (re.search(r"(\w+)\(", code).group(1),), text)


def ends(text):
    """Whether a declaration is complete after these lines."""
    code = re.sub(r"/\*.*?(\*/|$)", "", text, flags=re.S).rstrip()
    return code.startswith("#define") or (code.endswith(";") and code.count("{") == code.count("}"))


def groups(text):
    """Of what follows the opening comment: headings (text), and (comment, declarations) with what it belongs to."""
    body = text[text.index("*/") + 2:]
    body = re.sub(r"^#if defined\(_WIN32\).*?^#endif\n", "", body, flags=re.M | re.S)
    comment, found, pending, in_comment = [], [], "", False
    for line in body.strip("\n").split("\n") + [""]:
        section = SECTION.match(line)
        if section:
            yield section.group(1), None, None
        elif pending:
            pending += "\n" + line
        elif in_comment or line.startswith("/*"):
            if found:
                yield None, "\n".join(comment), found
                comment, found = [], []
            comment.append(re.sub(r"\s*\*/$", "", re.sub(r"^(/\*| \*) ?", "", line)))
            in_comment = not line.endswith("*/")
        elif line and not HIDDEN.match(line):
            pending = line
        elif not line and found:
            yield None, "\n".join(comment), found
            comment, found = [], []
        if pending and ends(pending):
            found.append(declaration(pending))
            pending = ""
    if pending or found:
        raise ValueError(f"not understood: {pending or found[0].text}")


class Writer:
    def __init__(self, known):
        self.known = known     # name: kind, of all headers

    def reference(self, name):
        kind, owner = self.known[name]
        return f":c:{KINDS[kind]}:`{name}`" if kind in KINDS else f":ref:`{name} <{owner}>`"

    def prose(self, text):
        """A comment's words.  Names of this interface become links, all other punctuation stays as it is."""
        def token(match):
            word = match.group()
            if word.startswith("`"):
                return f"``{word[1:-1]}``"
            if re.fullmatch(DOCUMENT, word):
                return f":doc:`{word} </{word.removesuffix('.md')}>`"
            if word in self.known:
                return r"\ " + self.reference(word) + r"\ "
            return re.sub(r"([*`|_\\<>])", r"\\\1", word)
        return re.sub(rf"`[^`]+`|{DOCUMENT}|\w+|[^\w\s]", token, text)

    def text(self, comment):
        """Paragraphs; items that begin with a dash; lines that are indented are code."""
        parts = []
        for paragraph in re.split(r"\n\s*\n", comment):
            lines = paragraph.split("\n")
            if all(line.startswith("    ") for line in lines):
                parts.append("::\n\n" + "\n".join(lines))
                continue
            blocks = re.split(r"\n(?=\s*- )", paragraph)
            blocks = [" ".join(block.split()) for block in blocks]
            parts += ["- " + self.prose(b[2:]) if b.startswith("- ") else self.prose(b) for b in blocks]
        return "\n\n".join(parts)

    def entry(self, item, comment):
        if item.kind == "constants":
            label = f".. _{item.names[0].lower()}:\n\n"
            return label + "\n\n".join(filter(None, [comment, code(item.text)]))
        if item.kind == "function":
            return f".. c:function:: {' '.join(item.text.rstrip(';').split())}\n\n{indented(comment)}"
        label = f".. _{item.names[0]}:\n\n" if len(item.names) > 1 else ""
        return label + f".. c:{item.kind}:: {item.names[0]}\n\n" + indented(
            "\n\n".join(filter(None, [comment, code(item.text)])))


def code(text):
    return ".. code-block:: c\n\n" + indented(text)


def indented(text):
    return "\n".join(("    " + line).rstrip() for line in text.split("\n"))


def names_of(texts):
    known = {}
    for text in texts:
        for _, _, found in groups(text):
            for item in found or []:
                owner = item.names[0] if item.kind == "type" else item.names[0].lower()
                known[item.names[0]] = (item.kind, owner)
                known.update({name: ("constants", owner) for name in item.names[1:]})
    return known


def heading(text, underline):
    return f"{text}\n{underline*len(text)}"


def page(header, texts, index):
    """The page of texts[index], the header at this path, with links to what the other texts declare."""
    writer = Writer(names_of(texts))
    title, introduction = opening(texts[index])
    parts = [heading(header.removeprefix("include/"), "="), writer.prose(title),
             writer.text(introduction)]
    for section, comment, found in groups(texts[index]):
        if section:
            parts.append(heading(section, "-"))
            continue
        words = writer.text(comment) if comment else ""
        for item in found:
            parts.append(writer.entry(item, words))
            words = ""
    return "\n\n".join(parts) + "\n"
