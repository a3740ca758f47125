#!/usr/bin/env python3
"""Which mistakes the tests notice: changes one constant or operator of core/kernel/ at a time, and runs them.

    tools/mutate.py [--count N] [--seed S] [--file NAME.h] [--only ID,...] [--jobs J] [--list]
                    [--build FOLDER] [--tests WORD,...] [--slowest SECONDS] [--report FILE.md] [--csv FILE]

A mutant is a copy of core/ with one of these changes in its code, never in comments or #if lines:
    number     a number times 1 + 1/16 (of the generated tables: 1 + 1/1000), an integer plus 1
    sign       a number with the other sign
    operator   + and -, * and /, < and >, kmin and kmax exchanged
    arms       c ? a : b as c ? b : a
    factor     a*b as a
It is `killed` by the first test program of tests/core that fails or takes too long, and `survived` if none does.  Not
counted are `equivalent` ones, whose object files are those of the original byte by byte, and `invalid` ones, which do
not compile.

Left out of the tests are those that compare with a copy of our own output or source, which notice everything and
prove nothing: test_batch (recorded hashes) and test_kmath_tables (the sources); and the programs slower than
--slowest, which are named.  A survivor is marked `same hashes` where even test_batch notices no change.

The build folder gives compiler and flags and needs to be configured only (cmake --preset dev).  Everything is built in
a temporary folder, at -O1 and without forced inlining, in seconds a mutant; the tree is not touched.  The batch loops
of all instruction sets are those of the base set.  Needs a linker with --defsym.  Status 0 whatever survives.

SPDX-License-Identifier: MIT
"""
import argparse
import collections
import concurrent.futures
import csv
import glob
import json
import os
import random
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import tree

LEFT_OUT = ("test_batch", "test_kmath_tables")
HASHES = "test_batch"
TABLES = ("kmath_f32.h", "kmath_f64.h")
# Without __OPTIMIZE__ real.h does not force inlining, which takes minutes.
OPTIMISATION = ["-O1", "-g0", "-w", "-fPIC", "-U__OPTIMIZE__"]
VARIANT = re.compile(r"batch_(avx\w+)\.c$")

Mutation = collections.namedtuple("Mutation", "id file line kind old new start end text")
Result = collections.namedtuple("Result", "mutation outcome by seconds")


class Failure(Exception):
    """One line for the user."""


# ---- Mutations ---------------------------------------------------------------------------------------

NUMBER = re.compile(r"(?<![\w.])(?:0x[0-9a-fA-F]+|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][-+]?\d+)?)([fFuU]?)(?!\w)")
DEFINE = re.compile(r"\s*#\s*define\s+\w+(?=\s)")
CAST = re.compile(r"\(\s*(?:real|int|real_bits|uint\d+_t|float|double)\s*\)$")
OPERATORS = {"+": "-", "-": "+", "*": "/", "/": "*", "<": ">", ">": "<"}
OPERATOR = re.compile(r"\+\+|--|->|<<|>>|[-+*/<>]")
MIN_MAX = re.compile(r"\b(?:(kmin)|(kmax))(?=\()")


def kernel_code(text):
    """One bool a character: code of kernels and the values of object-like macros."""
    mask = tree.code_mask(text)
    start, in_directive = 0, False
    for line in text.split("\n"):
        if in_directive or line.lstrip().startswith("#"):
            define = DEFINE.match(line)
            first = len(line) if in_directive or not define else define.end()
            for i in range(start, start + first):
                mask[i] = False
            in_directive = line.endswith("\\")
        start += len(line) + 1
    return mask


def is_binary(code, at):
    """Whether the operator at this place has a left operand."""
    before = code[:at].rstrip()
    if not before or re.search(r"\b(?:return|define\s+\w+)$", before) or CAST.search(before):
        return False
    return bool(re.match(r"[\w)\].]", before[-1]))


def closing(code, at):
    """The place after the bracket that closes the one here."""
    depth = 0
    for i in range(at, len(code)):
        depth += (code[i] in "([") - (code[i] in ")]")
        if depth == 0:
            return i + 1
    return len(code)


def operand_end(code, at):
    """The place after the factor that begins here."""
    i = at
    while code[i:i + 1] in ("-", " "):
        i += 1
    if code[i:i + 1] == "(":
        end = closing(code, i)
        return operand_end(code, end) if CAST.search(code[i:end]) else end
    operand = re.compile(r"(?:\d[\d.]*(?:[eE][-+]?\d+)?[fu]?|[\w.]+)").match(code, i)
    if not operand:
        return None
    i = operand.end()
    while code[i:i + 1] in ("(", "["):
        i = closing(code, i)
        i = re.compile(r"(?:\.\w+)*").match(code, i).end()
    return i


def arms(code, question):
    """Begin and end of both arms of the ?: here, or None."""
    depth = nested = 0
    colon = None
    for i in range(question + 1, len(code)):
        c = code[i]
        if c in "([{":
            depth += 1
        elif c in ")]}" and depth:
            depth -= 1
        elif depth:
            continue
        elif c == "?" and colon is None:
            nested += 1
        elif c == ":" and nested:
            nested -= 1
        elif c == ":" and colon is None:
            colon = i
        elif c in ")],;" or c == "}":
            return (question + 1, colon, colon + 1, i) if colon else None
    return None


def changed_number(text, suffix, is_table):
    """The number a little larger."""
    if re.fullmatch(r"(?:0x[0-9a-fA-F]+|\d+)[uU]?", text):
        number = text.rstrip("uU")
        larger = int(number, 0) + 1
        return (f"{larger:#x}" if number.startswith("0x") else str(larger)) + text[len(number):]
    value = float(text[:-1] if suffix else text)
    larger = value*(1.001 if is_table else 1.0625) or 0.0625
    digits = f"{larger:.17g}"
    return digits + ("" if re.search(r"[.e]", digits) else ".0") + suffix


def mutations_of(name, text):
    """(kind, start, end, new text) of every change to this header."""
    mask = kernel_code(text)
    code = "".join(c if inside or c == "\n" else " " for c, inside in zip(text, mask))
    is_table = name in TABLES
    in_number = set()  # where an exponent has its sign
    for match in NUMBER.finditer(code):
        in_number.update(range(match.start(), match.end()))
        old, in_index = match.group(), code[:match.start()].rstrip().endswith("[")
        yield "number", match.start(), match.end(), changed_number(old, match.group(1), is_table)
        if not old.startswith("0x") and float(old.rstrip("fu")) and not in_index:
            yield "sign", match.start(), match.end(), f"(-{old})"
    for match in OPERATOR.finditer(code):
        at, operator = match.start(), match.group()
        if operator in OPERATORS and at not in in_number and is_binary(code, at):
            yield "operator", at, match.end(), OPERATORS[operator]
            end = operand_end(code, match.end())
            if operator == "*" and end:
                yield "factor", at, end, ""
    for match in MIN_MAX.finditer(code):
        if not re.search(r"KERNEL\s+real\s*$", code[:match.start()]):
            yield "operator", match.start(), match.end(), "kmax" if match.group(1) else "kmin"
    for match in re.finditer(r"\?", code):
        found = arms(code, match.start())
        if found:
            a, b, c, d = found
            yield "arms", a, d, f" {text[c:d].strip()} :{text[a:b].rstrip()}"


def all_mutations(root):
    """All of core/kernel, in the order of files and places."""
    found = []
    for path in sorted(glob.glob(os.path.join(root, "core/kernel/*.h"))):
        name = os.path.basename(path)
        text = tree.read(root, os.path.join("core/kernel", name))
        for kind, start, end, new in sorted(mutations_of(name, text), key=lambda m: m[1:3]):
            first = text.rfind("\n", 0, start) + 1
            last = text.find("\n", end)
            before = " ".join(text[first:last].split())
            after = " ".join((text[first:start] + new + text[end:last]).split())
            found.append(Mutation(len(found), name, text.count("\n", 0, start) + 1, kind, before, after, start, end,
                                  text[:start] + new + text[end:]))
    return found


# ---- Building ----------------------------------------------------------------------------------------

def run_quietly(command, folder, what):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if "error" in line] or done.stderr.splitlines() or ["?"]
        raise Failure(f"{what}: {lines[0]}")


class Build:
    """How the sources of a configured build are compiled and linked here."""

    def __init__(self, root, folder):
        self.root = root
        try:
            with open(os.path.join(folder, "compile_commands.json"), encoding="utf-8") as stream:
                rows = json.load(stream)
            with open(os.path.join(folder, "CMakeCache.txt"), encoding="utf-8") as stream:
                cache = stream.read()
        except (OSError, ValueError) as why:
            raise Failure(f"{folder}: not a configured build folder ({why.__class__.__name__}); run `cmake --preset "
                          "dev`, or name one with --build") from why
        top = os.path.realpath(root)
        home = re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", cache, re.M)
        if not home or os.path.realpath(home.group(1)) != top:
            raise Failure(f"{folder}: configured for another checkout")
        cmocka = re.search(r"^pkgcfg_lib_CMOCKA_cmocka:FILEPATH=(.*)$", cache, re.M)
        self.libraries = [cmocka.group(1) if cmocka else "-lcmocka", "-lm"]
        self.flags = {}
        for row in rows:
            name = os.path.relpath(os.path.realpath(os.path.join(row["directory"], row["file"])), top)
            words = shlex.split(row["command"]) if "command" in row else row["arguments"]
            self.flags[name] = self.simplified(words)
        self.core = [n for n in sorted(self.flags) if os.path.dirname(n) == "core" and not VARIANT.search(n)]
        self.access = [n for n in sorted(self.flags) if re.fullmatch(r"tests/kernel_access\w*\.c", n)]
        self.support = [n for n in sorted(self.flags)
                        if os.path.dirname(n) in ("tests", "verify") and n not in self.access]
        self.tests = [n for n in sorted(self.flags) if re.fullmatch(r"tests/core/test_\w+\.c", n)]
        if not self.core or not self.tests:
            raise Failure(f"{folder}: has no core or no tests; configure with FACET_TESTS=ON and without sanitizers")
        self.compiler = self.flags[self.core[0]][0]
        same = [VARIANT.search(name).group(1) for name in self.flags if VARIANT.search(name)]
        self.link_flags = [f"-Wl,--defsym=facet_batch_{isa}=facet_batch_base" for isa in same]

    def simplified(self, words):
        """The command without input, output, optimisation and warnings; folders of the tree become relative."""
        kept, i = [words[0]], 1
        while i < len(words):
            word = words[i]
            if word in ("-o", "-MF", "-MT", "-MQ"):
                i += 1
            elif word.startswith("-I"):
                path = os.path.relpath(os.path.realpath(word[2:]), os.path.realpath(self.root))
                kept.append(word if path.startswith("..") else "-I" + path)
            elif word.startswith(("-D", "-std", "-isystem", "-f")) or words[i - 1] == "-isystem":
                kept.append(word)
            i += 1
        return kept

    def compile(self, name, folder, to):
        """Object file and dependencies of the source `name` of the copy in `folder`."""
        run_quietly(self.flags[name] + OPTIMISATION + ["-MMD", "-MF", to + ".d", "-c", name, "-o", to], folder, name)

    def object(self, name):
        return os.path.basename(name)[:-2] + ".o"


def same_file(a, b):
    with open(a, "rb") as x, open(b, "rb") as y:
        return x.read() == y.read()


class Workshop:
    """One copy of the sources, its objects without a mutation, and the test programs.  Paths in objects are relative,
    so that those of two copies are equal."""

    def __init__(self, build, folder):
        self.build, self.folder = build, folder
        self.base, self.new = os.path.join(folder, "base"), os.path.join(folder, "new")
        os.makedirs(self.base)
        for part in ("include", "core", "verify", "tests"):
            shutil.copytree(os.path.join(build.root, part), os.path.join(folder, part),
                            ignore=shutil.ignore_patterns("data", "corpus", "*.csv"))
        self.depends = {}

    def prepare(self, progress):
        b = self.build
        for name in b.core + b.access + b.support + b.tests:
            progress(f"building {name}")
            to = os.path.join(self.base, b.object(name))
            try:
                b.compile(name, self.folder, to)
            except Failure:
                if name not in b.support:  # of a test that is not of the core
                    raise
                continue
            with open(to + ".d", encoding="utf-8") as stream:
                self.depends[name] = set(re.findall(r"\bkernel/(\w+\.h)", stream.read()))
        archive = os.path.join(self.base, "libsupport.a")
        members = [os.path.join(self.base, b.object(n)) for n in b.support if n in self.depends]
        run_quietly(["ar", "rcs", archive] + members, self.folder, "ar")
        self.link_core(self.base, {})
        for name in b.tests:
            self.link_test(name, self.base, self.base)

    def kernel_tests(self):
        return [n for n in self.build.tests if self.depends[n]]

    def link_core(self, to, objects):
        b = self.build
        files = [objects.get(n, os.path.join(self.base, b.object(n))) for n in b.core + b.access]
        library = os.path.join(to, "libfacet_core.so")
        run_quietly([b.compiler, "-shared", "-o", library] + files + b.link_flags + ["-lm"], self.folder,
                    "linking core")

    def link_test(self, name, objects, to):
        b = self.build
        run_quietly([b.compiler, os.path.join(objects, b.object(name)), os.path.join(self.base, "libsupport.a"),
                     "-L" + self.base, "-lfacet_core", "-o", os.path.join(to, b.object(name)[:-2])] + b.libraries,
                    self.folder, f"linking {name}")

    def run(self, name, libraries, limit):
        """Exit status, None after the time limit, and seconds."""
        program = os.path.join(libraries, self.build.object(name)[:-2])
        if not os.path.exists(program):
            program = os.path.join(self.base, os.path.basename(program))
        environment = dict(os.environ, LD_LIBRARY_PATH=libraries, TMPDIR=self.folder)
        began = time.monotonic()
        process = subprocess.Popen([program], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        try:
            status = process.wait(limit)
        except subprocess.TimeoutExpired:
            status = None
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        return status, time.monotonic() - began

    def build_mutant(self, mutation):
        """`invalid`, `equivalent`, or None where there is something to test."""
        b = self.build
        shutil.rmtree(self.new, ignore_errors=True)
        os.makedirs(self.new)
        path = os.path.join(self.folder, "core/kernel", mutation.file)
        with open(path, encoding="utf-8", newline="") as stream:
            original = stream.read()
        if mutation.text[:mutation.start] != original[:mutation.start]:
            raise Failure(f"core/kernel/{mutation.file} has changed meanwhile; start again")
        try:
            with open(path, "w", encoding="utf-8", newline="") as stream:
                stream.write(mutation.text)
            objects, is_other = {}, False
            for name in b.core + b.access + self.kernel_tests():
                if mutation.file not in self.depends[name]:
                    continue
                objects[name] = os.path.join(self.new, b.object(name))
                try:
                    b.compile(name, self.folder, objects[name])
                except Failure:
                    return "invalid"
                is_other |= not same_file(objects[name], os.path.join(self.base, b.object(name)))
            if not is_other:
                return "equivalent"
            self.link_core(self.new, objects)
            for name in self.kernel_tests():
                if name in objects:
                    self.link_test(name, self.new, self.new)
            return None
        finally:
            with open(path, "w", encoding="utf-8", newline="") as stream:
                stream.write(original)


# ---- Running -----------------------------------------------------------------------------------------

def words(name):
    return set(re.sub(r"^test_|\.[hc]$", "", os.path.basename(name)).split("_"))


class Tests:
    """The programs, and the order in which they most likely kill soonest."""

    def __init__(self, seconds):
        self.seconds = seconds
        self.kills = collections.Counter()
        self.lock = threading.Lock()

    def order(self, file):
        def cost(name):
            return self.seconds[name]*(0.2 if words(name) & words(file) else 1)/(1 + self.kills[file, name])
        with self.lock:
            return sorted(self.seconds, key=cost)

    def limit(self, name):
        return 20 + 10*self.seconds[name]

    def killed(self, file, name):
        with self.lock:
            self.kills[file, name] += 1


def measure(workshop, wanted, slowest, progress):
    """Seconds of each test program without a mutation, and the names of the slower ones."""
    seconds, slow = {}, []
    for name in workshop.build.tests:
        if os.path.basename(name)[:-2] in LEFT_OUT or not any(word in name for word in wanted):
            continue
        progress(f"running {name}")
        status, took = workshop.run(name, workshop.base, slowest)
        if status is None:
            slow.append(os.path.basename(name)[:-2])
        elif status:
            raise Failure(f"{name} fails without a mutation")
        else:
            seconds[name] = took
    if not seconds:
        raise Failure("no test is left by --tests and --slowest")
    return Tests(seconds), slow


def examine(workshop, tests, mutation):
    began = time.monotonic()
    outcome, by = workshop.build_mutant(mutation), ""
    if not outcome:
        outcome = "survived"
        for name in tests.order(mutation.file):
            status, _ = workshop.run(name, workshop.new, tests.limit(name))
            if status != 0:
                outcome, by = "killed", os.path.basename(name)[:-2] + (" (hangs)" if status is None else "")
                tests.killed(mutation.file, name)
                break
    if outcome == "survived":
        hashes = [n for n in workshop.build.tests if os.path.basename(n)[:-2] == HASHES]
        is_same = hashes and workshop.run(hashes[0], workshop.new, 300)[0] == 0
        by = "same hashes" if is_same else ""
    return Result(mutation, outcome, by, time.monotonic() - began)


class Progress:
    def __init__(self):
        self.is_terminal = sys.stderr.isatty()
        self.began = time.monotonic()

    def __call__(self, text):
        if self.is_terminal:
            sys.stderr.write(f"\r{text[:100]:100}")
        elif not text.startswith(("building", "running")):
            sys.stderr.write(text + "\n")
        sys.stderr.flush()

    def of(self, results, total):
        counts = collections.Counter(r.outcome for r in results)
        left = (time.monotonic() - self.began)/len(results)*(total - len(results))
        last = results[-1]
        self(f"[{len(results)}/{total}] killed {counts['killed']}, survived {counts['survived']}, "
             f"{left/60:.0f} min left: {last.mutation.id} {last.mutation.file}:{last.mutation.line} {last.outcome} "
             f"{last.by} {last.seconds:.1f} s")

    def end(self):
        if self.is_terminal:
            sys.stderr.write("\r" + " "*100 + "\r")


def shown(mutation):
    m = mutation
    return f"{m.id} core/kernel/{m.file}:{m.line}: {m.kind}: {m.old} -> {m.new}"


def summary(results, slow):
    counts = collections.Counter(r.outcome for r in results)
    valid = counts["killed"] + counts["survived"]
    lines = [f"killed {counts['killed']} of {valid}, {100*counts['killed']/valid:.1f} %" if valid else "killed 0 of 0",
             f"survived {counts['survived']}, equivalent {counts['equivalent']}, invalid {counts['invalid']}"]
    if slow:
        lines.append("tests left out because they are slow: " + " ".join(slow))
    return lines


def write_report(path, results, slow, arguments):
    with open(path, "w", encoding="utf-8") as stream:
        stream.write("# Mutants of the kernels\n\n" + "\n".join(summary(results, slow)) + ".\n\n")
        stream.write("By `tools/mutate.py " + " ".join(arguments) + "`.\n\n## By file\n\n")
        stream.write("| file | killed | survived | equivalent | invalid |\n|---|---|---|---|---|\n")
        for file in sorted({r.mutation.file for r in results}):
            counts = collections.Counter(r.outcome for r in results if r.mutation.file == file)
            stream.write(f"| {file} | " + " | ".join(str(counts[o]) for o in ("killed", "survived", "equivalent",
                                                                               "invalid")) + " |\n")
        stream.write("\n## Survivors\n\n")
        for r in results:
            if r.outcome == "survived":
                m = r.mutation
                stream.write(f"- {m.id} `{m.file}:{m.line}`, {m.kind}: `{m.old}` became `{m.new}`"
                             + (f" ({r.by})" if r.by else "") + "\n")


def write_csv(path, results):
    with open(path, "w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["id", "file", "line", "kind", "old", "new", "outcome", "by", "seconds"])
        for r in results:
            m = r.mutation
            table.writerow([m.id, m.file, m.line, m.kind, m.old, m.new, r.outcome, r.by, f"{r.seconds:.1f}"])


def chosen(options, mutations):
    if options.file:
        wanted = set(options.file)
        unknown = wanted - {m.file for m in mutations}
        if unknown:
            raise Failure(f"core/kernel/{sorted(unknown)[0]} has nothing to change")
        mutations = [m for m in mutations if m.file in wanted]
    if options.only:
        ids = set(options.only)
        found = [m for m in mutations if m.id in ids]
        if len(found) != len(ids):
            raise Failure("--only: no such mutation; --list shows all")
        return found
    if 0 < options.count < len(mutations):
        mutations = random.Random(options.seed).sample(mutations, options.count)
    return sorted(mutations)


def run(options, arguments):
    root = tree.default_root()
    if options.list:
        options.count = 0
        for mutation in chosen(options, all_mutations(root)):
            print(shown(mutation))
        return
    build = Build(root, options.build or os.path.join(root, "build/dev"))
    mutations = chosen(options, all_mutations(root))
    progress, results = Progress(), []
    folder = tempfile.mkdtemp(prefix="facet-mutate-")
    pool = concurrent.futures.ThreadPoolExecutor(options.jobs)
    try:
        shops = []
        for i in range(options.jobs):
            shops.append(Workshop(build, os.path.join(folder, str(i))))
            shops[-1].prepare(progress)
        tests, slow = measure(shops[0], options.tests.split(","), options.slowest, progress)
        progress.began = time.monotonic()
        free = list(shops)

        def work(mutation):
            shop = free.pop()
            try:
                return examine(shop, tests, mutation)
            finally:
                free.append(shop)

        # In random order, so that what an interrupted run has done is a sample too.
        order = random.Random(options.seed).sample(mutations, len(mutations))
        try:
            for future in concurrent.futures.as_completed([pool.submit(work, m) for m in order]):
                results.append(future.result())
                progress.of(results, len(mutations))
        except KeyboardInterrupt:
            progress(f"interrupted; {len(results)} of {len(mutations)} done")
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
        shutil.rmtree(folder, ignore_errors=True)
    progress.end()
    results.sort(key=lambda r: r.mutation.id)
    print("\n".join(summary(results, slow)))
    for r in results:
        if r.outcome == "survived":
            print(shown(r.mutation) + (f" ({r.by})" if r.by else ""))
    if options.report:
        write_report(options.report, results, slow, arguments)
    if options.csv:
        write_csv(options.csv, results)


def positive(text):
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("must be 1 or more")
    return value


def main():
    described, _, rest = __doc__.partition("\n\n")
    about = rest.split("\n\n", 1)[1].rsplit("\n\nSPDX", 1)[0]
    parser = argparse.ArgumentParser(description=described + "\n\n" + about,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100, metavar="N", help="mutants, drawn at random; 0: all (100)")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="of the draw (1)")
    parser.add_argument("--file", action="append", metavar="NAME.h", help="only of this header; may be repeated")
    parser.add_argument("--only", type=lambda text: [int(word) for word in text.split(",")], metavar="ID,...",
                        help="only these, by the first number of their line in --list")
    parser.add_argument("--jobs", type=positive, default=1, metavar="J", help="mutants at a time (1)")
    parser.add_argument("--list", action="store_true", help="print all mutations and end")
    parser.add_argument("--build", metavar="FOLDER", help="a configured build folder (build/dev)")
    parser.add_argument("--tests", default="test_", metavar="WORD,...",
                        help="only test programs whose name contains one of these")
    parser.add_argument("--slowest", type=float, default=30, metavar="SECONDS",
                        help="leave out test programs that take longer without a mutation (30)")
    parser.add_argument("--report", metavar="FILE.md", help="write the result as Markdown")
    parser.add_argument("--csv", metavar="FILE", help="write one row a mutant")
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # cleans up as Ctrl-C does, and reports what is done
    try:
        run(options, sys.argv[1:])
    except KeyboardInterrupt:
        sys.exit(130)
    except (Failure, OSError) as why:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {why}")


if __name__ == "__main__":
    main()
