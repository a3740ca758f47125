"""Reads the C of core/kernel: the float build of each header as constants, records and functions, and a function's body
as a tree whose nodes remember where they stand in the text.

What it takes is what STYLE allows in a kernel: object-like macros with a constant, `typedef struct`, tables of numbers
(`static const type name[n] = {...}`), and functions marked KERNEL that declare, assign, loop with a constant length and
return.  Anything else that is needed is an error with file, line and remedy.

SPDX-License-Identifier: MIT
"""
import os
import re
from dataclasses import dataclass, field

TOKEN = re.compile(r"""
    (?P<number>0[xX][0-9a-fA-F]+[uUlL]*|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?[fFuUlL]*)
  | (?P<name>[A-Za-z_]\w*)
  | (?P<sign>\+\+|--|<<=|>>=|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|[-+*/%<>=!~&|^?:;,.(){}\[\]\#])
  | (?P<text>"(?:\\.|[^"\\])*")""", re.X)
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(\w+)((?:\\\n|[^\n])*)", re.M)

# What the preprocessor knows; every other name is not defined.
DEFINED = {"FACET_REAL_IS_DOUBLE": "0"}
# Macros that are words of the kernels' language and have no value.
MARKS = ("KERNEL", "LARGE_KERNEL", "UNROLL", "FACET_REAL_IS_DOUBLE")
# How the C is compiled into loops, which a shader has none of: ONE_VARIANT(name), EVAL_AND_PDF(name).
LOOPS_ONLY = ("ONE_VARIANT", "EVAL_AND_PDF")
# Macros of the C library.
LIBRARY = {"FLT_MAX": "3.40282346e+38f", "FLT_MIN": "1.17549435e-38f", "FLT_EPSILON": "1.1920929e-07f",
           "FACET_REAL_IS_DOUBLE": "0"}
SCALARS = ("real", "int", "real_bits")


class KernelError(Exception):
    """Kernel text that cannot be translated."""


@dataclass
class Token:
    kind: str
    text: str
    start: int
    end: int


@dataclass
class Node:
    """One expression or statement; `kids` are nodes, `op` an operator, name or literal."""
    kind: str
    op: str
    start: int
    end: int
    kids: list = field(default_factory=list)
    token: Token = None   # the operator's or name's own place
    type: str = ""
    becomes: "Node" = None  # the part that replaces this node where a choice is settled


@dataclass
class Item:
    """A constant, a table, a record or a function of a file."""
    kind: str
    name: str
    source: "Source"
    start: int
    end: int
    comment: str = ""           # what stands directly above
    type: str = ""              # of a function's result, or of a table's elements
    parameters: list = field(default_factory=list)  # (type, name, position of the type)
    fields: list = field(default_factory=list)      # of a record: Field
    statements: list = field(default_factory=list)  # of a record: (type's token, end) of each `type a, b;`
    span: tuple = ()            # a constant's value, or the first and last token of a table or of a function's body
    body: Node = None
    value: Node = None


@dataclass
class Field:
    """A field of a record; `length` is the text between brackets, `statement` counts the record's `type a, b;`."""
    type: str
    name: str
    length: str
    statement: int


def blank(text):
    return re.sub(r"[^\n]", " ", text)


class Source:
    """One header.  `text` has the file's own positions, with everything that is not compiled blanked out, except
    comments, which `code` blanks out as well."""

    def __init__(self, path, name):
        self.path, self.name = path, name
        with open(path, encoding="utf-8") as stream:
            self.original = stream.read()
        self.includes = []
        self.items = {}
        self.macros = []  # (name, value's start and end, line's start and end)
        self.preprocess()
        self.tokens = [Token(m.lastgroup, m.group(), m.start(), m.end()) for m in TOKEN.finditer(self.code)]
        self.find_items()

    def fail(self, position, what):
        line = self.original.count("\n", 0, position) + 1
        raise KernelError(f"{self.name}:{line}: {what}")

    def condition(self, text, position):
        text = COMMENT.sub(" ", text).replace("\\\n", " ")
        text = re.sub(r"\bdefined\s*\(?\s*(\w+)\s*\)?", lambda m: "1" if m[1] in DEFINED else "0", text)
        text = re.sub(r"\b[A-Za-z_]\w*", lambda m: DEFINED.get(m[0], "0"), text)
        text = text.replace("&&", " and ").replace("||", " or ")
        text = re.sub(r"!(?!=)", " not ", text)
        if not re.fullmatch(r"[\d\s()<>=!+*/a-z-]*", text):
            self.fail(position, "this #if is not understood; compare names and numbers only")
        return bool(eval(text, {"__builtins__": {}}))  # numbers and operators only, checked above

    def preprocess(self):
        text, compiled, stack = self.original, [], []
        code = list(COMMENT.sub(lambda m: blank(m[0]), text))
        end_before = 0

        def active():
            return all(state == "on" for state in stack)

        for m in DIRECTIVE.finditer("".join(code)):
            part = text[end_before:m.start()]
            compiled.append(part if active() else blank(part))
            word, rest = m[1], m[2]
            if word == "if":
                stack.append("on" if self.condition(rest, m.start()) else "off")
            elif word in ("ifdef", "ifndef"):
                stack.append("on" if (rest.strip() in DEFINED) == (word == "ifdef") else "off")
            elif word == "elif":
                stack[-1] = "done" if stack[-1] != "off" else ("on" if self.condition(rest, m.start()) else "off")
            elif word == "else":
                stack[-1] = "on" if stack[-1] == "off" else "done"
            elif word == "endif":
                stack.pop()
            elif active() and word == "include":
                self.includes += re.findall(r'"([^"]+)"', text[m.start():m.end()])
            elif active() and word == "define":
                self.define(m)
            compiled.append(blank(text[m.start():m.end()]))
            end_before = m.end()
        compiled.append(text[end_before:])
        self.text = "".join(compiled)
        self.code = COMMENT.sub(lambda m: blank(m[0]), self.text)

    def define(self, m):
        name = re.match(r"\s*(\w+)", m[2])
        if name and m[2][name.end():name.end() + 1] != "(":
            self.macros.append((name[1], m.start(2) + name.end(), m.end(2), m.start()))

    # ---- Items ------------------------------------------------------------------------------------

    def comment_above(self, start):
        """The comment that ends on the line above, and where it begins."""
        head = self.original[:self.original.rfind("\n", 0, start) + 1]
        m = re.search(r"/\*(?:[^*]|\*(?!/))*\*/[ \t]*\n$", head)
        if not m:
            return ""
        line = head.rfind("\n", 0, m.start()) + 1
        return m[0].rstrip() if head[line:m.start()].strip() == "" else ""

    def add(self, item):
        item.comment = self.comment_above(item.start)
        self.items[item.name] = item

    def find_items(self):
        for name, start, end, line in self.macros:
            if name not in MARKS:
                self.add(Item("constant", name, self, line, end, span=(start, end)))
        i = 0
        while i < len(self.tokens):
            i = self.find_item(i)

    def find_item(self, i):
        t = self.tokens
        text = [token.text for token in t[i:i + 3]]
        if text[:2] == ["typedef", "struct"]:
            return self.find_record(i)
        if text[0] == "typedef" and len(text) == 3 and t[i + 3].text == ";":
            return i + 4  # real and real_bits
        if text[0] in ("KERNEL", "LARGE_KERNEL"):
            return self.find_function(i)
        if text[0] in LOOPS_ONLY:
            return self.close(i + 1, "(", ")") + 1
        if text[:2] == ["static", "const"]:
            return self.find_table(i)
        self.fail(t[i].start, f"`{t[i].text}`: a kernel file holds constants, tables, `typedef struct` and KERNEL "
                  "functions; put anything else under #ifdef FACET_PREPARE or in another file")

    def close(self, i, opening, closing):
        """The index of the token that closes the one at i."""
        depth = 0
        for k in range(i, len(self.tokens)):
            depth += (self.tokens[k].text == opening) - (self.tokens[k].text == closing)
            if depth == 0:
                return k
        self.fail(self.tokens[i].start, f"`{opening}` is not closed")

    def find_table(self, i):
        t = self.tokens
        if t[i + 4].text != "[" or t[i + 6].text != "]" or t[i + 7].text != "=" or t[i + 8].text != "{":
            self.fail(t[i].start, "a table is `static const type name[n] = { ... };`, n a number or a constant's name")
        end = self.close(i + 8, "{", "}")
        if t[end + 1].text != ";":
            self.fail(t[end].start, "a table ends with `};`")
        self.add(Item("table", t[i + 3].text, self, t[i].start, t[end + 1].end, type=t[i + 2].text,
                      parameters=[t[i + 5].text], span=(i, end)))
        return end + 2

    def find_record(self, i):
        t, k = self.tokens, i + 2
        while t[k].text != "{":
            k += 1
        end = self.close(k, "{", "}")
        if t[end + 1].kind != "name" or t[end + 2].text != ";":
            self.fail(t[end].start, "a record is `typedef struct NAME { ... } NAME;`")
        item = Item("record", t[end + 1].text, self, t[i].start, t[end + 2].end)
        k += 1
        while k < end:
            type_name, k = t[k], k + 1
            while True:
                name, length, k = t[k], "", k + 1
                if name.kind != "name":
                    self.fail(name.start, "a field is `type name;`, without pointers")
                if t[k].text == "[":
                    close = self.close(k, "[", "]")
                    length = self.code[t[k].end:t[close].start].strip()
                    k = close + 1
                item.fields.append(Field(type_name.text, name.text, length, len(item.statements)))
                k += 1
                if t[k - 1].text == ";":
                    break
                if t[k - 1].text != ",":
                    self.fail(t[k - 1].start, "a field is `type name, name[length];`")
            item.statements.append((type_name, t[k - 1].end))
        self.add(item)
        return end + 3

    def find_function(self, i):
        t = self.tokens
        item = Item("function", t[i + 2].text, self, t[i].start, 0, type=t[i + 1].text)
        if t[i + 1].kind != "name" or t[i + 2].kind != "name" or t[i + 3].text != "(":
            self.fail(t[i].start, "a kernel function is `KERNEL type name(type name, ...) { ... }`, without pointers")
        close = self.close(i + 3, "(", ")")
        k = i + 4
        while k < close and t[k].text != "void":
            if t[k].kind != "name" or t[k + 1].kind != "name" or t[k + 2].text not in (",", ")"):
                self.fail(t[k].start, f"{item.name}: a parameter is `type name`, without const and pointers; "
                          "kernels take values")
            item.parameters.append((t[k].text, t[k + 1].text, t[k].start))
            k += 3
        end = self.close(close + 1, "{", "}")
        item.end = t[end].end
        item.span = (close + 1, end)
        self.add(item)
        return end + 1


class Parser:
    """Expressions and statements of tokens[first..last] of a source."""
    BINARY = [["||"], ["&&"], ["|"], ["^"], ["&"], ["==", "!="], ["<", ">", "<=", ">="], ["<<", ">>"], ["+", "-"],
              ["*", "/", "%"]]

    def __init__(self, source, tokens, types):
        self.source, self.tokens, self.types, self.k = source, tokens, types, 0

    def peek(self, ahead=0):
        k = self.k + ahead
        return self.tokens[k].text if k < len(self.tokens) else ""

    def next(self, wanted=None):
        if self.k >= len(self.tokens) or (wanted and self.tokens[self.k].text != wanted):
            token = self.tokens[min(self.k, len(self.tokens) - 1)]
            self.source.fail(token.start, f"`{token.text}` where {wanted or 'an expression'} is wanted; kernels are "
                             "plain expressions of values (no pointers, initialiser lists, if or switch)")
        self.k += 1
        return self.tokens[self.k - 1]

    # ---- Expressions ------------------------------------------------------------------------------

    def expression(self):
        condition = self.binary(0)
        if self.peek() != "?":
            return condition
        token = self.next("?")
        first = self.expression()
        self.next(":")
        second = self.expression()
        return Node("choice", "?", condition.start, second.end, [condition, first, second], token)

    def binary(self, level):
        if level == len(self.BINARY):
            return self.unary()
        left = self.binary(level + 1)
        while self.peek() in self.BINARY[level]:
            token = self.next()
            right = self.binary(level + 1)
            left = Node("binary", token.text, left.start, right.end, [left, right], token)
        return left

    def unary(self):
        if self.peek() in ("-", "+", "!", "~"):
            token = self.next()
            operand = self.unary()
            return Node("unary", token.text, token.start, operand.end, [operand], token)
        if self.peek() == "(" and self.peek(1) in self.types + ("void",) and self.peek(2) == ")":
            token = self.next("(")
            name = self.next().text
            self.next(")")
            if self.peek() == "{":
                self.source.fail(token.start, "an initialiser list; declare a local and assign its fields")
            operand = self.unary()
            return Node("cast", name, token.start, operand.end, [operand], token)
        return self.postfix()

    def postfix(self):
        node = self.primary()
        while True:
            if self.peek() == ".":
                self.next(".")
                name = self.next()
                node = Node("member", name.text, node.start, name.end, [node], name)
            elif self.peek() == "[":
                self.next("[")
                index = self.expression()
                end = self.next("]").end
                node = Node("index", "[]", node.start, end, [node, index])
            else:
                return node

    def primary(self):
        token = self.next()
        if token.kind == "number":
            return Node("literal", token.text, token.start, token.end, token=token)
        if token.text == "(":
            inner = self.expression()
            return Node("paren", "()", token.start, self.next(")").end, [inner], token)
        if token.kind != "name":
            self.source.fail(token.start, f"`{token.text}`: an expression of values is wanted; kernels have no "
                             "pointers, strings or initialiser lists")
        if self.peek() != "(":
            return Node("name", token.text, token.start, token.end, token=token)
        self.next("(")
        arguments = []
        while self.peek() != ")":
            arguments.append(self.expression())
            if self.peek() != ")":
                self.next(",")
        return Node("call", token.text, token.start, self.next(")").end, arguments, token)

    def numbers(self):
        """{ ... }, the elements of a table or the fields of one element."""
        token = self.next("{")
        kids = []
        while self.peek() != "}":
            kids.append(self.numbers() if self.peek() == "{" else self.expression())
            if self.peek() != "}":
                self.next(",")
        return Node("list", "{}", token.start, self.next("}").end, kids, token)

    # ---- Statements -------------------------------------------------------------------------------

    def block(self):
        start = self.next("{").start
        kids = []
        while self.peek() != "}":
            kids.append(self.statement())
        return Node("block", "", start, self.next("}").end, kids)

    def statement(self):
        token, word = self.tokens[self.k], self.peek()
        if word == "{":
            return self.block()
        if word == "UNROLL":
            self.next()
            return Node("mark", word, token.start, token.end, token=token)
        if word == "return":
            self.next()
            value = self.expression()
            return Node("return", "", token.start, self.next(";").end, [value], token)
        if word == "for":
            return self.loop()
        if word in ("if", "switch", "while", "do", "goto", "const", "static"):
            self.source.fail(token.start, f"`{word}` in a kernel; compute both and select with ?:, loop with a constant "
                             "length, and write locals without const")
        node = self.simple()
        node.end = self.next(";").end
        return node

    def simple(self):
        """A declaration, an assignment or `(void)name`, without its semicolon."""
        token = self.tokens[self.k]
        if token.text in self.types:
            return self.declaration()
        target = self.expression()
        if target.kind == "cast" and target.op == "void":
            return Node("unused", "", target.start, target.end, [], token)
        operator = self.next()
        if operator.text in ("++", "--"):
            return Node("assign", operator.text, target.start, operator.end, [target], operator)
        if operator.text not in ("=", "+=", "-=", "*=", "/="):
            self.source.fail(operator.start, "a statement is a declaration, an assignment, a loop or a return")
        value = self.expression()
        return Node("assign", operator.text, target.start, value.end, [target, value], operator)

    def declaration(self):
        token = self.next()
        node = Node("declare", token.text, token.start, token.end, [], token)
        while True:
            name = self.next()
            if name.kind != "name" or self.peek() == "[":
                self.source.fail(name.start, "a local is `type name = value;`, without pointers and arrays")
            one = Node("local", name.text, name.start, name.end, [], name)
            if self.peek() == "=":
                self.next("=")
                one.kids.append(self.expression())
                one.end = one.kids[0].end
            node.kids.append(one)
            if self.peek() != ",":
                node.end = one.end
                return node
            self.next(",")

    def loop(self):
        start = self.next("for").start
        self.next("(")
        first = self.simple()
        self.next(";")
        condition = self.expression()
        self.next(";")
        step = self.simple()
        self.next(")")
        body = self.statement()
        return Node("loop", "", start, body.end, [first, condition, step, body])


class Kernels:
    """All items that a header sees, in the order of its includes."""

    def __init__(self, root, headers):
        self.root, self.sources, self.items = root, [], {}
        for header in headers:
            self.read(header)
        self.types = tuple(SCALARS) + tuple(n for n, item in self.items.items() if item.kind == "record")

    def read(self, header):
        if any(source.name == header for source in self.sources):
            return
        path = os.path.join(self.root, header)
        if not os.path.isfile(path):
            raise KernelError(f"{header}: no such file")
        source = Source(path, header)
        for name in source.includes:
            self.read(os.path.normpath(os.path.join(os.path.dirname(header), name)))
        self.sources.append(source)
        for name, item in source.items.items():
            if name in self.items and item.kind != "constant":
                source.fail(item.start, f"{name} is defined in {self.items[name].source.name} as well")
            self.items[name] = item

    def body(self, item):
        if item.body is None:
            first, last = item.span
            item.body = Parser(item.source, item.source.tokens[first:last + 1], self.types).block()
        return item.body

    def table(self, item):
        if item.value is None:
            first, last = item.span
            item.value = Parser(item.source, item.source.tokens[first + 8:last + 1], self.types).numbers()
        return item.value

    def value(self, item):
        """The tree of a constant's value; its positions are those of the header."""
        if item.value is None:
            start, end = item.span
            code = COMMENT.sub(lambda m: blank(m[0]), item.source.original[start:end])
            tokens = [Token(m.lastgroup, m.group(), start + m.start(), start + m.end()) for m in TOKEN.finditer(code)]
            if not tokens:
                item.source.fail(item.start, f"{item.name} has no value and is used as one")
            parser = Parser(item.source, tokens, self.types)
            item.value = parser.expression()
            if parser.k != len(tokens):
                item.source.fail(item.start, f"{item.name} is not one expression; a macro of a kernel is a constant")
        return item.value
