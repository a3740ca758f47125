#!/usr/bin/env python3
"""The man pages and the completion: tests/packaging/check_manual.py BUILD_FOLDER

Each command has a page that names all its options and that mandoc and man (those that are installed) take without a
warning.  Completion is tried by typing into bash and zsh on a terminal of their own.

SPDX-License-Identifier: MIT
"""
import glob
import json
import os
import pty
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))

# What is typed, and the arguments that the command then has.
TYPED = [
    (b"facet ren\t", ["render"]),
    (b"facet compare --metric fl\t", ["compare", "--metric", "flip"]),
    (b"facet render --all\t", ["render", "--allow-outside"]),
    (b"facet info sc\t", ["info", "scene of mine.glb"]),
    (b"facet render -o pict\t", ["render", "-o", "pictures.exr"]),
    (b"facet albedo beck\t", ["albedo", "beckmann"]),
    (b"facet mer\tscene\t", ["merge", "scene of mine.glb"]),
]


def written(program, folder):
    """The pages and the completion as a package makes them, with a date."""
    environment = dict(os.environ, SOURCE_DATE_EPOCH="1000000000")
    for tool, name in (("make_man.py", "man"), ("make_completion.py", "completion")):
        subprocess.run([sys.executable, "-B", os.path.join(ROOT, "tools", tool), program, os.path.join(folder, name)],
                       check=True, env=environment)
    return os.path.join(folder, "man"), os.path.join(folder, "completion")


def warnings_of(page):
    """What the formatters say; those that are not installed say nothing."""
    said = ""
    if shutil.which("mandoc"):
        said += subprocess.run(["mandoc", "-Tlint", "-Wwarning", page], capture_output=True, text=True).stdout
    if shutil.which("man") and shutil.which("groff"):
        said += subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", page], capture_output=True, text=True,
                               env=dict(os.environ, LC_ALL="C.UTF-8", MANWIDTH="80")).stderr
    return said


def check_pages(program, folder):
    told = json.loads(subprocess.run([program, "help", "--json"], check=True, capture_output=True).stdout)
    pages = sorted(os.path.basename(page) for page in glob.glob(os.path.join(folder, "*")))
    wanted = sorted(["facet.1"] + [f"facet-{c['name']}.1" for c in told["commands"]])
    if pages != wanted:
        sys.exit(f"there are the pages {pages}, not {wanted}")
    for page in pages:
        said = warnings_of(os.path.join(folder, page))
        if said:
            sys.exit(f"{page}: {said}")
    for c in told["commands"]:
        with open(os.path.join(folder, f"facet-{c['name']}.1"), encoding="utf-8") as stream:
            text = stream.read().replace("\\-", "-")
        for o in c["options"]:
            if f"--{o['name']}\\fR" not in text:
                sys.exit(f"facet-{c['name']}.1 does not tell of --{o['name']}")
    print(f"{len(pages)} pages")


def type_into(shell, setup, folder):
    """For each line the arguments that the shell passed to `facet`, which is a function here."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(folder)
        environment = {"PATH": os.environ["PATH"], "TERM": "dumb", "HOME": folder, "LC_ALL": "C.UTF-8", "PS1": "> "}
        os.execvpe(shell[0], shell, environment)
    text = b""

    def read_until(mark):
        nonlocal text
        while mark not in text:
            try:
                more = os.read(terminal, 4096)
            except OSError:
                more = b""
            if not more:
                sys.exit(f"{shell[0]} ended: {text.decode(errors='replace')}")
            text += more
        text = text[text.index(mark) + len(mark):]

    os.write(terminal, setup.encode() + b"\nprintf 'rea%s\\n' dy\n")
    read_until(b"ready\r\n")
    results = []
    for line, _ in TYPED:
        os.write(terminal, line + b"\n")
        read_until(b"<<")

        while b">>" not in text:
            text += os.read(terminal, 4096)
        rest, text = text.split(b">>", 1)
        results.append(rest.decode().split("|")[1:])
    os.write(terminal, b"exit\n")
    os.close(terminal)
    os.waitpid(pid, 0)
    return results


def check_completion(completion, folder):
    for name in ("scene of mine.glb", "pictures.exr"):
        open(os.path.join(folder, name), "w").close()
    report = "facet() { printf '<%s' '<'; printf '|%s' \"$@\"; printf '>%s\\n' '>'; }"
    shells = {
        "bash": (["bash", "--norc", "--noprofile", "-i"],
                 f"bind 'set bell-style none'; bind 'set enable-bracketed-paste off'; . '{completion}/facet'; {report}"),
        "zsh": (["zsh", "-f", "-i"],
                f"unsetopt zle_bracketed_paste prompt_sp; fpath=('{completion}' $fpath); autoload -Uz compinit; compinit -u -D; "
                f"{report}"),
    }
    for name, (command, setup) in shells.items():
        if not shutil.which(name):
            print(f"{name} is not installed: not tried")
            continue
        for (line, wanted), found in zip(TYPED, type_into(command, setup, folder)):
            if found != wanted:
                sys.exit(f"{name}: `{line.decode()}` gave {found}, not {wanted}")
        print(f"{name}: {len(TYPED)} lines completed")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    program = os.path.abspath(os.path.join(sys.argv[1], "facet"))
    with tempfile.TemporaryDirectory(prefix="facet-test-") as folder:
        man, completion = written(program, folder)
        check_pages(program, man)
        home = os.path.join(folder, "home")
        os.mkdir(home)
        check_completion(completion, home)


if __name__ == "__main__":
    main()
