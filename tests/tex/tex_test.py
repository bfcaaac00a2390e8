#!/usr/bin/env python3
"""LaTeX: labels and references fit, nothing of a model can act as a command, and what comes out compiles without a word."""

import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(HERE, "..", "founding"))
from sheet import *  # noqa: E402
from sheet import Skip  # noqa: E402

test = Tests()
EXAMPLES = ["atwood", "crank", "ski", "double-pendulum", "ladder"]
HOSTILE = r"""system "50% \input{/etc/passwd} $x$ & #1 ^^41 ~ {"
#: \def\x{\x}\x  100 % of _it_ -- "quoted" <b>
param m = 1 [kg], g = 9.81 [m/s^2], k = 2 [N/m]
coord x_a
mass B: m at (x_a)
spring k between B and (0)
ask a: lagrange2, conserved
"""


def tex(program, file, *flags):
    done = subprocess.run([program, "tex", file, *flags], capture_output=True, text=True)
    need(done.returncode == 0, f"exit {done.returncode}: {done.stderr}")
    return done.stdout


def example(name):
    return os.path.join(ROOT, "examples", name + ".pleuel")


def compile_with(engine, text):
    """Two runs, as references need; what LaTeX complains about."""
    if not shutil.which(engine):
        raise Skip(f"{engine} is not installed")
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "it.tex"), "w", encoding="utf-8") as f:
            f.write(text)
        for _ in range(2):
            done = subprocess.run([engine, "-interaction=nonstopmode", "-halt-on-error", "it.tex"], cwd=folder,
                                  capture_output=True, text=True, errors="replace")
        bad = [l for l in done.stdout.splitlines() if re.match(r"!|Overfull \\hbox|LaTeX Warning: (Ref|Label)", l)]
        return done.returncode, bad


def declare(name, lang):
    @test(f"{name}, {lang}: every reference has its label, no label twice")
    def _(program):
        text = tex(program, example(name), "--standalone", "--lang", lang, "--steps", "full")
        labels = re.findall(r"\\label\{([^}]*)\}", text)
        need(len(labels) == len(set(labels)), f"twice: {labels}")
        need(all(re.fullmatch(r"[a-z0-9:-]+", l) for l in labels), f"odd characters: {labels}")
        need(set(re.findall(r"\\eqref\{([^}]*)\}", text)) <= set(labels), "a reference to nothing")
        need(text.count(r"\begin{") == text.count(r"\end{"), "environments are not balanced")

    @test(f"{name}, {lang}: pdflatex takes the document, no line is too long")
    def _(program):
        code, bad = compile_with("pdflatex", tex(program, example(name), "--standalone", "--lang", lang))
        need(code == 0 and not bad, "\n".join(bad))


for name in EXAMPLES:
    for lang in ("en", "de"):
        declare(name, lang)


@test("lualatex takes a document")
def _(program):
    code, bad = compile_with("lualatex", tex(program, example("ski"), "--standalone", "--lang", "de"))
    need(code == 0 and not bad, "\n".join(bad))


@test("two fragments in one document that has amsmath and its own dots")
def _(program):
    body = tex(program, example("atwood")) + tex(program, example("ski"), "--only", "c")
    head = "\\documentclass{article}\\usepackage{amsmath}\\newcommand{\\pldot}[1]{{#1'}}\\begin{document}\n"
    need("documentclass" not in body and "usepackage" not in body, "a fragment must not load packages")
    code, bad = compile_with("pdflatex", head + body + "\\end{document}\n")
    need(code == 0 and not [l for l in bad if not l.startswith("Overfull")], "\n".join(bad))


@test("--macros plain writes \\dot itself")
def _(program):
    text = tex(program, example("ski"), "--macros", "plain")
    need("\\dot{" in text and "pldot" not in text and "plvec" not in text, "macros in spite of plain")


@test("hostile text is text")
def _(program):
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "a%b{c.pleuel")
        with open(file, "w", encoding="utf-8") as f:
            f.write(HOSTILE)
        text = tex(program, file, "--standalone")
        need("\\input" not in text and "\\def" not in text and "^^" not in text, "a command came through")
        code, bad = compile_with("pdflatex", text)
        need(code == 0 and not bad, "\n".join(bad))


@test("the decimal comma of German is no punctuation")
def _(program):
    need("-23{,}544" in tex(program, example("atwood"), "--lang", "de"), "no 23{,}544")


if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
