"""Turns functions of core/kernel into GLSL by editing their own text, so that formulas, comments and layout stay.

What differs: real is float, int is bool where it holds a truth value (and & | on those && ||), literals carry no suffix,
every conversion is written out, records are structs, and names that GLSL reserves get a trailing underscore.  Choices
that are settled (a field with a known value) are taken, and what nothing needs any more is left out.

SPDX-License-Identifier: MIT
"""
import re

from kernel_c import COMMENT, LIBRARY, KernelError, Node

TYPES = {"real": "float", "real2": "vec2", "real3": "vec3", "real_bits": "uint", "int": "int", "bool": "bool"}
CONSTRUCTORS = {"make2": "vec2", "make3": "vec3", "splat3": "vec3"}
VECTORS = {"real2": "xy", "real3": "xyz"}
RANK = {"bool": 0, "int": 1, "real_bits": 2, "real": 3}
LOGICAL = {"&": "&&", "|": "||", "^": "^^"}
CONVERSIONS = {"real": "float", "int": "int", "real_bits": "uint"}

# Keywords of GLSL ES 3.00 and GLSL 4.50, now and in future, and the names of functions that no parameter, local,
# function or constant may hide.
KEYWORDS = set("""
    active asm atomic_uint attribute bool break buffer bvec2 bvec3 bvec4 case cast centroid class coherent common const
    continue default discard do double else enum extern external filter fixed flat float for fvec2 fvec3 fvec4 goto half
    highp hvec2 hvec3 hvec4 if in inline inout input int interface invariant ivec2 ivec3 ivec4 layout long lowp mat2
    mat3 mat4 mediump namespace noinline noperspective out output packed partition patch precise precision public
    readonly resource restrict return sample sampler2D shared short sizeof smooth static struct subroutine superp switch
    template this true false typedef uint uniform union unsigned using uvec2 uvec3 uvec4 varying vec2 vec3 vec4 void
    volatile while writeonly""".split())
RESERVED = KEYWORDS | set("""
    abs acos acosh all any asin asinh atan atanh ceil clamp cos cosh cross degrees determinant distance dot equal exp
    exp2 faceforward floor fma fract frexp inverse inversesqrt isinf isnan ldexp length log log2 max min mix mod modf
    normalize not outerProduct pow radians reflect refract round roundEven sign sin sinh smoothstep sqrt step tan tanh
    texture transpose trunc noise1 noise2 noise3 noise4""".split())


class Edits:
    """Changes to a text by position."""

    def __init__(self):
        self.list = []

    def replace(self, start, end, text):
        self.list.append((start, 1, len(self.list), end, text))

    def wrap(self, start, end, before, after):
        """Inserts around; a wrap made later at the same place lies inside."""
        self.list.append((start, 0, len(self.list), start, before))
        self.list.append((end, 0, -len(self.list), end, after))

    def apply(self, text, start, end):
        parts, position = [], start
        for at, _, _, until, new in sorted(self.list):
            if at < position:
                continue  # inside a part that is gone
            parts += [text[position:at], new]
            position = until
        parts.append(text[position:end])
        return "".join(parts)


class Translation:
    """The functions `roots` and all that they need.  `pins` maps (record, field) to the constant that it always is;
    the records `filled` get their fields from outside, those in `given` are results; names that begin with one of
    `renames` begin with what that maps to."""

    def __init__(self, kernels, roots, filled, given, pins, renames, primitives):
        self.kernels, self.items, self.roots, self.filled = kernels, kernels.items, roots, filled
        self.pins, self.renames, self.primitives = dict(pins), renames, primitives
        self.true_parameters, self.true_results, self.dropped = set(), set(), set()
        self.whole_records = set(given)
        self.settle()
        self.check_names()

    # ---- What is needed ---------------------------------------------------------------------------

    def settle(self):
        """Analyses until neither truth values, nor settled choices, nor unread fields change any more."""
        while True:
            before = (set(self.true_parameters), set(self.true_results), set(self.dropped), dict(self.pins))
            self.functions, self.constants, self.records = {}, set(), set()
            self.calls, self.reads, self.writes, self.tables = {}, set(), {}, set()
            todo = list(self.roots)
            while todo:
                name = todo.pop()
                if name not in self.functions:
                    self.functions[name] = function = Function(self, self.items[name])
                    todo += function.calls
            for name in list(self.constants):
                self.need_constant(name)
            self.find_truths()
            self.pin_written_constants()
            for record in self.records - self.whole_records:
                fields = {(record, f.name) for f in self.items[record].fields}
                if fields & self.reads:  # a struct has a field at least
                    self.dropped |= fields - self.reads
            if before == (self.true_parameters, self.true_results, self.dropped, self.pins):
                return

    def find_truths(self):
        for name, calls in self.calls.items():
            for k in range(len(self.items[name].parameters)):
                if self.items[name].parameters[k][0] == "int" and all(types[k] == "bool" for types in calls):
                    self.true_parameters.add((name, k))
        for name, function in self.functions.items():
            if self.items[name].type == "int" and function.results and set(function.results) == {"bool"}:
                self.true_results.add(name)

    def pin_written_constants(self):
        """A field that no caller fills and that is only ever given one constant is that constant."""
        inside = set()
        for record in self.filled:
            inside |= self.contained(record)
        for (record, field_name), values in self.writes.items():
            if record not in inside and len(values) == 1 and None not in values:
                self.pins.setdefault((record, field_name), next(iter(values)))

    def contained(self, record):
        found = {record}
        for f in self.items[record].fields:
            if f.type in self.items and f.type not in VECTORS:
                found |= self.contained(f.type)
        return found

    def need_record(self, name):
        if name in self.records or name not in self.items or name in VECTORS:
            return
        self.records.add(name)
        for f in self.items[name].fields:
            if (name, f.name) not in self.dropped:
                self.need_record(f.type)
                if f.length and not f.length.isdigit():
                    self.need_constant(f.length)

    def need_table(self, item):
        """A table's rows are written field by field, so that all its fields stay."""
        if item.name not in self.tables:
            self.tables.add(item.name)
            self.need_record(item.type)
            self.whole_records.add(item.type)
            for name in item.parameters:
                if not name.isdigit():
                    self.need_constant(name)
            Function.of_table(self, item)

    def need_constant(self, name):
        if name == "ROUND_TO_INTEGER":
            item = self.items[name]
            item.source.fail(item.start, f"{name} is for round_to_integer() alone: a shader compiler may reassociate; "
                             "call that")
        self.constants.add(name)
        Function.of_constant(self, self.items[name])

    def constant_type(self, name):
        return Function.of_constant(self, self.items[name]).value_type

    # ---- Names ------------------------------------------------------------------------------------

    def rename(self, name):
        for old, new in self.renames.items():
            if name.startswith(old + "_"):
                name = new + name[len(old):]
        return name + "_" if name in RESERVED else name

    def type_name(self, name):
        return TYPES.get(name) or self.rename(name)

    def check_names(self):
        names = {}
        for name in list(self.functions) + list(self.constants) + list(self.tables) + list(self.records):
            other = names.setdefault(self.rename(name), name)
            if other != name:
                item = self.items[name]
                item.source.fail(item.start, f"{name} and {other} are both {self.rename(name)} in GLSL; rename one")

    # ---- Text -------------------------------------------------------------------------------------

    def text(self):
        """All definitions, in the order of the headers."""
        code = "\n".join(self.item_text(item) for source in self.kernels.sources for item in source.items.values()
                         if item.kind != "constant" and self.is_needed(item))
        self.named = set(re.findall(r"\w+", COMMENT.sub("", code)))
        while True:  # constants that only settled choices named are not needed
            more = {word for name in self.constants if self.rename(name) in self.named
                    for word in re.findall(r"\w+", self.item_text(self.items[name]))} - self.named
            if not more:
                break
            self.named |= more
        parts = []
        for source in self.kernels.sources:
            items = [item for item in source.items.values() if self.is_needed(item)]
            if not items:
                continue
            parts.append("\n" + head_comment(source) + "\n")
            last, comments = None, {""}
            for item in sorted(items, key=lambda item: item.start):
                between = "" if last is None else source.original[last.end:item.start]
                in_group = last is not None and item.kind == last.kind == "constant" and between.count("\n") == 1
                if not in_group:
                    comment = item.comment or group_comment(source, item)
                    parts.append("\n" + ("" if comment in comments else comment + "\n"))
                    comments.add(comment)
                parts.append(self.item_text(item) + "\n")
                last = item
        return "".join(parts)

    def is_needed(self, item):
        if self.items.get(item.name) is not item:
            return False
        if item.kind == "function":
            return item.name in self.functions and item.name not in CONSTRUCTORS
        if item.kind == "table":
            return item.name in self.tables
        if item.kind == "constant":
            return item.name in self.constants and self.rename(item.name) in self.named
        return item.name in self.records

    def item_text(self, item):
        if item.kind == "constant":
            return Function.of_constant(self, item).constant_text()
        if item.kind == "table":
            return Function.of_table(self, item).table_text()
        if item.kind == "record":
            return self.record_text(item)
        if item.name in self.primitives:
            return self.primitives[item.name]
        return self.functions[item.name].text()

    def record_text(self, item):
        source, edits = item.source, Edits()
        start = source.text.index("{", item.start)
        end = source.text.rindex("}", item.start, item.end)
        for k, (type_token, statement_end) in enumerate(item.statements):
            fields = [f for f in item.fields if f.statement == k]
            kept = [f for f in fields if (item.name, f.name) not in self.dropped]
            edits.replace(type_token.start, type_token.end, self.type_name(type_token.text))
            if not kept:
                edits.replace(*whole_line(source, type_token.start, statement_end), "")
            else:
                names = [self.rename_field(f.name) + (f"[{f.length}]" if f.length else "") for f in kept]
                edits.replace(type_token.end, statement_end, " " + ", ".join(names) + ";")
        body = edits.apply(source.text, start, end)
        return tidy(f"struct {self.rename(item.name)} {body}}};")

    @staticmethod
    def rename_field(name):
        return name + "_" if name in KEYWORDS else name

    # ---- Prepared parameters ----------------------------------------------------------------------

    def length(self, item, f):
        if not f.length:
            return 1
        if f.length.isdigit():
            return int(f.length)
        if f.length in self.items and self.items[f.length].kind == "constant":
            value = Function.of_constant(self, self.items[f.length]).number(self.kernels.value(self.items[f.length]))
            if value is not None:
                return value
        item.source.fail(item.start, f"the length of {item.name}.{f.name} is neither a number nor a constant's name")

    def words(self, record):
        """How many 32-bit words the record has in C: all its parts are words, so there is no padding."""
        if record in VECTORS:
            return len(VECTORS[record])
        if record in ("real", "int"):
            return 1
        return sum(self.words(f.type)*self.length(self.items[record], f) for f in self.items[record].fields)

    def loads(self, record, path, offset):
        """Lines that fill `path` from the words at `offset`."""
        if record == "real":
            return [f"{path} = uintBitsToFloat({word(offset)});"]
        if record == "int":
            return [f"{path} = int({word(offset)});"]
        if record in VECTORS:
            numbers = ", ".join(f"uintBitsToFloat({word(offset + k)})" for k in range(len(VECTORS[record])))
            return [f"{path} = {TYPES[record]}({numbers});"]
        lines, item = [], self.items[record]
        for f in item.fields:
            inner = f"{path}.{self.rename_field(f.name)}"
            if (record, f.name) not in self.dropped:
                if not f.length:
                    lines += self.loads(f.type, inner, offset)
                elif f.type == "real":
                    index = f"{offset} + k"
                    lines.append(f"for (int k = 0; k < {self.length(item, f)}; k++) "
                                 f"{inner}[k] = uintBitsToFloat(words[({index})/4][({index})%4]);")
                else:
                    item.source.fail(item.start, f"{record}.{f.name}: an array in a record is of real")
            offset += self.words(f.type)*self.length(item, f)
        return lines


def word(k):
    return f"words[{k//4}].{'xyzw'[k%4]}"


def tidy(text):
    """Without the blank lines that edits leave, and with columns of = and of trailing comments in line again."""
    text = re.sub(r"[ \t]+\n", "\n", text)
    lines = re.sub(r"\n\n+", "\n", text).split("\n")
    align(lines, re.compile(r"(?P<indent> +)(?P<head>\w[\w.]*(?: \w+)?) *(?P<mark> = )"))
    align(lines, re.compile(r"(?P<indent> +)(?P<head>[\w, \[\]]+;) *(?P<mark> /\*)"))
    return "\n".join(lines)


def align(lines, pattern):
    """Pads `head` so that `mark` stands in one column in each run of lines that match; the lines that go on below one
    of them move with it."""
    k = 0
    while k < len(lines):
        first = pattern.match(lines[k])
        if not first:
            k += 1
            continue
        end, starts = k, []
        while end < len(lines):
            m = pattern.match(lines[end])
            if m and m["indent"] == first["indent"]:
                starts.append(end)
            elif not re.match(first["indent"] + r"  +[^ ]", lines[end]) or lines[end - 1].endswith((";", "{", "}")):
                break
            end += 1
        width = max(len(pattern.match(lines[i])["head"]) for i in starts)
        shift = 0
        for i in range(k, end):
            m = pattern.match(lines[i]) if i in starts else None
            if m:
                before = m.start("mark")
                lines[i] = m["indent"] + m["head"].ljust(width) + lines[i][before:]
                shift = len(m["indent"]) + width - before
            else:
                indent = len(lines[i]) - len(lines[i].lstrip())
                lines[i] = " "*max(indent + shift, 0) + lines[i].lstrip()
        k = end


def head_comment(source):
    """What the file says of itself, without its licence, which the output states once."""
    m = re.match(r"/\*.*?\*/", source.original, re.S)
    text = m[0] if m else f"/* {source.name} */"
    return re.sub(r"\n \* SPDX-License-Identifier:.*\*/", " */", text)


def group_comment(source, item):
    """For a constant: the comment above the first of the lines of constants that it stands in."""
    if item.kind != "constant":
        return ""
    first = item
    for other in sorted(source.items.values(), key=lambda other: -other.start):
        if other.kind == "constant" and source.original[other.end:first.start].count("\n") == 1 and other is not first:
            first = other
    return first.comment


def whole_line(source, start, end):
    """The span of a statement with its indentation, its trailing comment and the end of its line."""
    line = source.text.rfind("\n", 0, start) + 1
    if source.text[line:start].strip():
        return start, end
    m = re.compile(r"[ \t]*(/\*.*?\*/)?[ \t]*\n", re.S).match(source.text, end)
    return (line, m.end()) if m else (start, end)


class Function:
    """One function, or one constant, with a type for each of its nodes."""

    def __init__(self, whole, item):
        self.whole, self.item, self.source = whole, item, item.source
        self.calls, self.results, self.settled, self.assigned = [], [], {}, set()
        self.local_types = {}
        whole.need_record(item.type)
        for k, (type_name, name, position) in enumerate(item.parameters):
            if type_name not in whole.kernels.types:
                self.source.fail(position, f"{type_name} is no type of the kernels: real, real2, real3, int or a record")
            whole.need_record(type_name)
            self.local_types[name] = "bool" if (item.name, k) in whole.true_parameters else type_name
        if item.name in whole.primitives:
            for name in set(re.findall(r"\w+", whole.primitives[item.name])) - {item.name}:
                known = whole.items.get(name)
                if known and known.kind == "record":
                    whole.need_record(name)
                    whole.reads |= {(name, f.name) for f in known.fields}
            return
        if item.name not in CONSTRUCTORS:
            self.body = whole.kernels.body(item)
            self.find_assigned(self.body)
            self.visit(self.body)

    @classmethod
    def of_constant(cls, whole, item):
        self = cls.__new__(cls)
        self.whole, self.item, self.source = whole, item, item.source
        self.calls, self.results, self.settled, self.assigned, self.local_types = [], [], {}, set(), {}
        self.value_type = self.typed(whole.kernels.value(item))
        return self

    @classmethod
    def of_table(cls, whole, item):
        self = cls.__new__(cls)
        self.whole, self.item, self.source = whole, item, item.source
        self.calls, self.results, self.settled, self.assigned, self.local_types = [], [], {}, set(), {}
        for element in whole.kernels.table(item).kids:
            self.typed_element(element, item.type)
        return self

    def typed_element(self, node, wanted):
        node.type = wanted
        if node.kind != "list":
            self.typed(node)
            return
        record = self.whole.items.get(wanted)
        if not record or record.kind != "record" or len(record.fields) != len(node.kids):
            self.source.fail(node.start, f"{{...}} where a {wanted} is wanted; give a value to every field, in order")
        for f, kid in zip(record.fields, node.kids):
            self.typed_element(kid, f.type)

    # ---- Types and settled choices ----------------------------------------------------------------

    def find_assigned(self, node):
        if node.kind == "assign" and node.kids[0].kind == "name":
            self.assigned.add(node.kids[0].op)
        for kid in node.kids:
            self.find_assigned(kid)

    def visit(self, node):
        if node.kind in ("block", "loop"):
            for kid in node.kids:
                if kid.kind in ("declare", "assign", "return", "block", "loop", "mark", "unused"):
                    self.visit(kid)
                else:
                    self.typed(kid)
        elif node.kind == "declare":
            self.whole.need_record(node.op)
            for one in node.kids:
                found = self.typed(one.kids[0]) if one.kids else node.op
                is_truth = node.op == "int" and found == "bool" and one.op not in self.assigned and len(node.kids) == 1
                self.local_types[one.op] = "bool" if is_truth else node.op
                if one.kids and one.op not in self.assigned:
                    self.settled[one.op] = self.number(one.kids[0])
            node.type = self.local_types[node.kids[0].op]
        elif node.kind == "assign":
            if not self.is_dropped(node):
                self.typed_target(node.kids[0])
                for kid in node.kids[1:]:
                    self.typed(kid)
                self.note_write(node)
        elif node.kind == "return":
            self.results.append(self.typed(node.kids[0]))

    def is_dropped(self, node):
        """Whether an assignment fills a field that nobody reads."""
        target = node.kids[0]
        while target.kind in ("member", "index"):
            base = self.typed(target.kids[0], is_read=False)
            if (base, target.op) in self.whole.dropped or (base, target.op) in self.whole.pins:
                return True
            target = target.kids[0]
        return False

    def typed_target(self, node):
        node.type = self.typed(node, is_read=False)

    def note_write(self, node):
        target = node.kids[0]
        if target.kind == "member" and target.type == "int":
            base = target.kids[0].type
            value = self.number(node.kids[1]) if node.op == "=" else None
            plain = strip(node.kids[1])
            name = plain.op if plain.kind in ("name", "literal") and value is not None else None
            self.whole.writes.setdefault((base, target.op), set()).add(name)

    def typed(self, node, is_read=True):
        """The type of an expression; also settles choices and notes what is used."""
        node.becomes = None
        method = getattr(self, "type_" + node.kind)
        node.type = method(node, is_read) if node.kind in ("member", "index") else method(node)
        return node.type

    def type_literal(self, node):
        if node.op[-1] in "uU":
            return "real_bits"
        is_hex = node.op[:2] in ("0x", "0X")
        return "real" if not is_hex and re.search(r"[.eEfF]", node.op) else "int"

    def type_name(self, node):
        if node.op in self.local_types:
            return self.local_types[node.op]
        if node.op in LIBRARY:
            return "int" if LIBRARY[node.op].isdigit() else "real"
        item = self.whole.items.get(node.op)
        if item and item.kind == "table":
            self.whole.need_table(item)
            return item.type + "[]"
        if not item or item.kind != "constant":
            self.source.fail(node.start, f"{node.op} is neither a parameter, nor a local, nor a constant of a kernel header")
        self.whole.constants.add(node.op)
        return self.whole.constant_type(node.op)

    def type_call(self, node):
        if node.op in ("UINT32_C", "UINT64_C"):
            return "real_bits"
        item = self.whole.items.get(node.op)
        if not item or item.kind != "function":
            self.source.fail(node.start, f"{node.op}() is no function of the kernels; use those of core/kernel/kmath.h, or "
                             "write it as a KERNEL function in a header that this one includes")
        if len(node.kids) != len(item.parameters):
            self.source.fail(node.start, f"{node.op} takes {len(item.parameters)} arguments")
        if node.op == "select3":
            self.typed(node.kids[0])
            first = self.number(node.kids[0])
            if first is not None:
                node.becomes = node.kids[1 if first else 2]
                return self.typed(node.becomes)
        self.calls.append(node.op)
        types = [self.typed(kid) for kid in node.kids]
        self.whole.calls.setdefault(node.op, []).append(types)
        return "bool" if node.op in self.whole.true_results else item.type

    def type_member(self, node, is_read):
        base = self.typed(node.kids[0], is_read)
        if base in VECTORS:
            return "real"
        item = self.whole.items.get(base)
        f = item and next((f for f in item.fields if f.name == node.op), None)
        if not f:
            self.source.fail(node.start, f"{base} has no field {node.op}")
        if is_read and (base, node.op) not in self.whole.pins:
            self.whole.reads.add((base, node.op))
        if (base, node.op) in self.whole.pins:
            name = self.whole.pins[base, node.op]
            if is_read and not name.isdigit():
                self.whole.constants.add(name)
        return f.type + ("[]" if f.length else "")

    def type_index(self, node, is_read):
        base = self.typed(node.kids[0], is_read)
        if not base.endswith("[]") or self.typed(node.kids[1]) not in ("int", "real_bits"):
            self.source.fail(node.start, "an index is an int, into a table or into an array that is a field of a record")
        return base[:-2]

    def type_paren(self, node):
        return self.typed(node.kids[0])

    def type_unary(self, node):
        inner = self.typed(node.kids[0])
        return "bool" if node.op == "!" else ("int" if inner == "bool" else inner)

    def type_cast(self, node):
        self.typed(node.kids[0])
        return node.op

    def type_binary(self, node):
        left, right = [self.typed(kid) for kid in node.kids]
        if node.op in LOGICAL and left == right == "bool" and node.op != "^":
            for kid, other in (node.kids, node.kids[::-1]):
                value = self.number(kid)
                if value is not None and bool(value) == (node.op == "&"):
                    node.becomes = other
        if left not in RANK or right not in RANK:
            self.source.fail(node.start, f"`{node.op}` of {left} and {right}; use the functions of real.h")
        if node.op in ("==", "!=", "<", ">", "<=", ">=", "&&", "||"):
            return "bool"
        if node.op in LOGICAL and left == right == "bool":
            return "bool"
        if node.op in ("<<", ">>"):
            return left
        return max(left, right, "int", key=lambda name: RANK[name])

    def type_choice(self, node):
        self.typed(node.kids[0])
        value = self.number(node.kids[0])
        if value is not None:
            node.becomes = node.kids[1 if value else 2]
            return self.typed(node.becomes)
        first, second = [self.typed(kid) for kid in node.kids[1:]]
        if first == second:
            return first
        if first not in RANK or second not in RANK:
            self.source.fail(node.start, f"?: of {first} and {second}")
        return max(first, second, key=lambda name: RANK[name])

    def number(self, node):
        """The value of an integer expression that is known, else None."""
        if node.becomes:
            return self.number(node.becomes)
        if node.kind == "paren":
            return self.number(node.kids[0])
        if node.kind == "literal" and re.fullmatch(r"\d+", node.op):
            return int(node.op)
        if node.kind == "choice":
            value = self.number(node.kids[0])
            return None if value is None else self.number(node.kids[1 if value else 2])
        if node.kind == "name":
            if node.op in LIBRARY:
                return int(LIBRARY[node.op]) if LIBRARY[node.op].isdigit() else None
            if node.op in self.local_types:
                return self.settled.get(node.op)
            item = self.whole.items.get(node.op)
            is_integer = item and item.kind == "constant" and self.whole.constant_type(node.op) == "int"
            return self.number(self.whole.kernels.value(item)) if is_integer else None
        if node.kind == "member":
            pin = self.whole.pins.get((node.kids[0].type, node.op))
            return None if pin is None else self.pinned_number(pin)
        if node.kind == "unary" and node.op in "!-":
            value = self.number(node.kids[0])
            return None if value is None else (-value if node.op == "-" else int(not value))
        if node.kind != "binary":
            return None
        left, right = [self.number(kid) for kid in node.kids]
        if node.op in ("&", "&&") and 0 in (left, right):
            return 0
        if None in (left, right):
            return None
        known = {"==": left == right, "!=": left != right, "<": left < right, ">": left > right, "<=": left <= right,
                 ">=": left >= right, "&&": left and right, "||": left or right}
        if node.op in known:
            return int(bool(known[node.op]))
        integers = {"&": left & right, "|": left | right, "+": left + right, "-": left - right, "*": left*right}
        return integers.get(node.op)

    def pinned_number(self, name):
        if name.isdigit():
            return int(name)
        return self.number(self.whole.kernels.value(self.whole.items[name]))

    # ---- Text -------------------------------------------------------------------------------------

    def text(self):
        item, source = self.item, self.source
        self.edits = Edits()
        tokens = [t for t in source.tokens if item.start <= t.start < item.end]
        self.edits.replace(tokens[0].start, tokens[1].start, "")
        result = "bool" if item.name in self.whole.true_results else item.type
        self.edits.replace(tokens[1].start, tokens[1].end, self.whole.type_name(result))
        self.edits.replace(tokens[2].start, tokens[2].end, self.whole.rename(item.name))
        for token in tokens[4:]:
            if token.text == ")":
                break
            if token.text == "void":
                self.edits.replace(token.start, token.end, "")
        for k, (type_name, name, position) in enumerate(item.parameters):
            is_truth = (item.name, k) in self.whole.true_parameters
            self.edits.replace(position, position + len(type_name), self.whole.type_name("bool" if is_truth else type_name))
            token = next(t for t in tokens if t.start > position)
            self.edits.replace(token.start, token.end, self.local(name))
        self.write(self.whole.kernels.body(item))
        return tidy(self.edits.apply(source.text, item.start, item.end))

    def constant_text(self):
        self.edits = Edits()
        node = self.whole.kernels.value(self.item)
        node = strip(node)
        self.emit(node, self.value_type)
        value = self.edits.apply(self.source.original, node.start, node.end)
        rest = COMMENT.search(self.source.original[node.end:self.item.end])
        name = self.whole.rename(self.item.name)
        return f"const {self.whole.type_name(self.value_type)} {name} = {value};" + (f" {rest[0]}" if rest else "")

    def table_text(self):
        self.edits, item, node = Edits(), self.item, self.whole.kernels.table(self.item)
        kind, length = self.whole.type_name(item.type), item.parameters[0]
        self.emit_elements(node, item.type)
        rows = self.edits.apply(self.source.text, node.token.end, node.end - 1).rstrip().rstrip(",")
        return f"const {kind} {self.whole.rename(item.name)}[{length}] = {kind}[{length}]({rows});"

    def emit_elements(self, node, kind):
        """Edits `a, b` between braces; the elements of a table are all of one kind."""
        for kid in node.kids:
            if kid.kind != "list":
                self.emit(kid, kind)
                continue
            self.edits.replace(kid.token.start, kid.token.end, self.whole.type_name(kid.type) + "(")
            for f, inner in zip(self.whole.items[kid.type].fields, kid.kids):
                self.emit_elements(Node("list", "", 0, 0, [inner]), f.type)
            self.edits.replace(kid.end - 1, kid.end, ")")

    @staticmethod
    def local(name):
        return name + "_" if name in RESERVED else name

    def write(self, node):
        """Edits a statement."""
        if node.kind == "block":
            for kid in node.kids:
                self.write(kid)
        elif node.kind in ("mark", "unused") or (node.kind == "assign" and self.is_dropped(node)):
            self.edits.replace(*whole_line(self.source, node.start, node.end), "")
        elif node.kind == "loop":
            first, condition, step, body = node.kids
            self.write(first)
            self.emit(condition, "bool")
            self.write(step)
            self.write(body)
        elif node.kind == "declare":
            self.edits.replace(node.token.start, node.token.end, self.whole.type_name(node.type))
            for one in node.kids:
                self.edits.replace(one.token.start, one.token.end, self.local(one.op))
                for kid in one.kids:
                    self.emit(kid, self.local_types[one.op])
        elif node.kind == "assign":
            self.emit(node.kids[0], node.kids[0].type)
            for kid in node.kids[1:]:
                self.emit(kid, node.kids[0].type)
        elif node.kind == "return":
            self.write_return(node.token.start, node.kids[0])

    def write_return(self, start, value):
        """Edits `return value` that begins at `start`.  WebGL has no ?: of structs: one that is returned becomes
        branches."""
        whole = value
        while value.becomes or (value.kind == "paren" and self.is_record(value.type)):
            value = value.becomes or value.kids[0]
        if value.kind != "choice" or not self.is_record(value.type):
            self.emit(whole, "bool" if self.item.name in self.whole.true_results else self.item.type)
            return
        condition, first, second = value.kids
        self.edits.replace(start, condition.start, "if " if condition.type != "bool" else "if (")
        self.emit(condition, "bool")
        self.edits.replace(condition.end, first.start, " return " if condition.type != "bool" else ") return ")
        self.emit(first, self.item.type)
        self.edits.replace(first.end, second.start, ";\n    ")
        self.edits.wrap(second.start, second.end, "return ", "")
        self.emit(second, self.item.type)
        self.edits.replace(second.end, whole.end, "")

    def is_record(self, kind):
        return kind in self.whole.items and kind not in VECTORS

    def emit(self, node, wanted):
        """Edits an expression whose value is used as `wanted`."""
        if node.becomes:
            kept = node.becomes
            self.edits.replace(node.start, kept.start, "")
            self.emit(kept, wanted)
            self.edits.replace(kept.end, node.end, "")
            return
        if node.kind == "literal":
            self.edits.replace(node.start, node.end, literal(node.op, wanted))
        elif node.kind == "choice":
            if self.is_record(node.type):
                self.source.fail(node.start, "WebGL has no ?: of records but in a return; write a function for it")
            self.emit(node.kids[0], "bool")
            for kid in node.kids[1:]:
                self.emit(kid, wanted)
        elif node.kind == "unary" and node.op in "-+" and strip(node.kids[0]).kind == "literal" and wanted != "bool":
            self.emit(node.kids[0], wanted)
        elif node.kind == "paren" and (node.type == wanted or strip(node).kind in ("literal", "choice")):
            self.emit(node.kids[0], wanted)
        elif node.kind == "cast":
            self.emit_cast(node, wanted)
        elif node.type != wanted:
            self.convert(node, wanted)
        else:
            getattr(self, "emit_" + node.kind)(node)

    def convert(self, node, wanted):
        if node.type not in RANK or wanted not in RANK:
            self.source.fail(node.start, f"a {node.type} where a {wanted} is wanted")
        if wanted == "bool":
            self.edits.wrap(node.start, node.end, "(", f" != {literal('0', node.type)})")
        elif node.kind == "paren":
            self.edits.wrap(node.start, node.end, CONVERSIONS[wanted], "")
        else:
            self.edits.wrap(node.start, node.end, CONVERSIONS[wanted] + "(", ")")
        self.emit(node, node.type)

    def emit_cast(self, node, wanted):
        inner = node.kids[0]
        number = strip(inner.kids[0] if inner.kind == "unary" and inner.op in "-+" else inner)
        if node.type != wanted and number.kind != "literal":
            self.convert(node, wanted)
            return
        self.edits.replace(node.start, inner.start, "")
        self.emit(inner, wanted if number.kind == "literal" else node.type)

    def emit_name(self, node):
        if node.op in self.local_types:
            new = self.local(node.op)
        else:
            new = literal(LIBRARY[node.op], node.type) if node.op in LIBRARY else self.whole.rename(node.op)
        self.edits.replace(node.start, node.end, new)

    def emit_call(self, node):
        if node.op in ("UINT32_C", "UINT64_C"):
            self.edits.replace(node.start, node.end, node.kids[0].op.rstrip("uUlL") + "u")
            return
        name = CONSTRUCTORS.get(node.op) or self.whole.rename(node.op)
        self.edits.replace(node.token.start, node.token.end, name)
        for k, kid in enumerate(node.kids):
            is_truth = (node.op, k) in self.whole.true_parameters
            self.emit(kid, "bool" if is_truth else self.whole.items[node.op].parameters[k][0])

    def emit_member(self, node):
        pin = self.whole.pins.get((node.kids[0].type, node.op))
        if pin is not None:
            self.edits.replace(node.start, node.end, self.whole.rename(pin))
            return
        self.emit(node.kids[0], node.kids[0].type)
        self.edits.replace(node.token.start, node.token.end, self.whole.rename_field(node.op))

    def emit_index(self, node):
        self.emit(node.kids[0], node.kids[0].type)
        self.emit(node.kids[1], node.kids[1].type)

    def emit_paren(self, node):
        self.emit(node.kids[0], node.type)

    def emit_unary(self, node):
        self.emit(node.kids[0], "bool" if node.op == "!" else node.type)

    def emit_binary(self, node):
        left, right = node.kids
        if node.op in ("&&", "||") or (node.op in LOGICAL and node.type == "bool"):
            self.edits.replace(node.token.start, node.token.end, LOGICAL.get(node.op, node.op))
            kinds = "bool", "bool"
        elif node.op in ("<<", ">>"):
            kinds = node.type, right.type
        elif node.type == "bool":
            common = left.type if left.type == right.type else max(left.type, right.type, "int", key=RANK.get)
            kinds = common, common
        else:
            kinds = node.type, node.type
        self.emit(left, kinds[0])
        self.emit(right, kinds[1])


def strip(node):
    """Without parentheses."""
    while node.kind == "paren" and not node.becomes:
        node = node.kids[0]
    return node


def literal(text, wanted):
    """A number as GLSL writes it."""
    if text[:2] in ("0x", "0X"):
        digits = text.rstrip("uUlL")
        return digits + "u" if wanted == "real_bits" else digits
    digits = text.rstrip("fFuUlL")
    is_whole = not re.search(r"[.eE]", digits)
    if wanted == "real":
        return digits + ".0" if is_whole else digits + ("0" if digits[-1] == "." else "")
    if not is_whole:
        raise KernelError(f"the number {text} stands where a {wanted} is wanted")
    if wanted == "bool":
        return "true" if int(digits) else "false"
    return digits + "u" if wanted == "real_bits" else digits
