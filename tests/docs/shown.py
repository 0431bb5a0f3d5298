"""Commands and outputs as the documentation shows them: found, run in a folder with samples, compared, pasted anew.

    python -m tests.docs.shown            # which outputs differ
    python -m tests.docs.shown --write    # paste what is printed now; lines of `...` stay

A block of `sh` has commands, a line each; one of `console` has commands after `$ ` and what they print. A line `...`
stands for any lines, and `…` in a line for any words: times differ from machine to machine.
"""

from __future__ import annotations

import contextlib
import difflib
import io
import os
import re
import shlex
import sys
from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
PROGRAMS = ("./run", "nao-sim")
ELIDED, SOMETHING = "...", "…"
_NUMBER = re.compile(r"\d+(?:\.\d+)?")
MAKES = frozenset(("-o", "--into", "--rollout", "--json"))
_BLOCK = re.compile(r"^```(?P<kind>\w+)\n(?P<text>.*?)^```$", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class Step:
    """A command of a document.

    Attributes:
        document: where it stands.
        line: number of its line.
        command: as it is shown.
        shown: what it prints, as the document has it; empty where it does not say, None in blocks of `sh`.
        code: instead of a command, a block of Python.
    """

    document: Path
    line: int
    command: str
    shown: str | None = None
    code: str = ""

    def __str__(self) -> str:
        return f"{self.document.relative_to(ROOT)}:{self.line}: {self.command}"


def blocks(text: str, *kinds: str) -> Iterator[re.Match[str]]:
    """Fenced blocks of some languages."""
    return (found for found in _BLOCK.finditer(text) if found["kind"] in kinds)


def steps(document: Path) -> list[Step]:
    """All commands and all Python of a document, in their order."""
    text, found = document.read_text(encoding="utf-8"), []
    for block in blocks(text, "sh", "console", "python"):
        line = text[: block.start("text")].count("\n") + 1
        if block["kind"] == "python":
            found.append(Step(document, line, "python", code=block["text"]))
            continue
        if block["kind"] == "sh":
            lines = enumerate(block["text"].splitlines(), start=line)
            found += [Step(document, number, each) for number, each in lines if shlex.split(each, comments=True)]
            continue
        for part in re.split(r"^\$ ", block["text"], flags=re.MULTILINE)[1:]:
            command, _, shown = part.partition("\n")
            found.append(Step(document, line, command, shown))
            line += part.count("\n")
    return found


def to_run(document: Path) -> list[Step]:
    """The commands of a document that run with it.

    Not those that another test tries, nor those that an earlier document or a
    later block with more to say has, too; what makes a file for later
    commands runs in each document.
    """
    from tests.docs.stand_ins import elsewhere

    known: dict[str, Step] = {}
    for each in DOCUMENTS:
        here = [step for step in steps(each) if not elsewhere(step)]
        for step in here:
            own = shlex.split(step.command, comments=True) if not step.code else [step.code]
            made = {to for by, to in pairwise(own) if by in MAKES}
            later = [other.command + other.code for other in here if other.command != step.command]
            needed = any(name in words for name in made for words in later)
            key = shlex.join([*own, str(each)] if needed else own)
            if key not in known or (not known[key].shown and step.shown):
                known[key] = step
    return [step for step in steps(document) if step in known.values()]


def agrees(shown: str, printed: str) -> bool:
    """Whether what is printed is what is shown, but for what is left out, and how numbers round."""
    numbers = _NUMBER.findall("\n".join(line for line in tidy(shown).splitlines() if line != ELIDED))
    found = re.fullmatch("".join(map(_line, tidy(shown).splitlines())), tidy(printed))
    return found is not None and all(map(_alike, numbers, found.groups()))


def _line(line: str) -> str:
    if line == ELIDED:
        return r"(?:.*\n)*?"
    words = (re.escape(words).replace(SOMETHING, ".*") for words in _NUMBER.split(line))
    return r"(\d+(?:\.\d+)?)".join(words) + r"\n"


def _alike(shown: str, printed: str) -> bool:
    """Within one of the last digit, or 2 %: processors round differently."""
    last = 10.0 ** -len(shown.partition(".")[2])
    return abs(float(shown) - float(printed)) <= max(1.01 * last * (len(shown) > 1), 0.02 * float(shown))


def tidy(text: str) -> str:
    """Without spaces at the ends of lines, and empty lines at the end."""
    return "".join(f"{line.rstrip()}\n" for line in text.rstrip().splitlines())


def anew(shown: str, printed: str) -> str:
    """What is printed, with what was left out of what is shown left out again."""
    if not shown:
        return tidy(printed)
    old, new = tidy(shown).splitlines(), tidy(printed).splitlines()
    loose = [line for line in old if SOMETHING in line]
    new = [next((kept for kept in loose if re.fullmatch(_line(kept), f"{line}\n")), line) for line in new]
    if ELIDED in old:
        first, last = old.index(ELIDED), len(old) - 1 - old[::-1].index(ELIDED)
        new = [*new[:first], ELIDED, *new[len(new) - (len(old) - 1 - last) :]]
    return "\n".join(new) + "\n"


class Folder:
    """Where the commands of a document run, with files by the names that they use."""

    def __init__(self, path: Path) -> None:
        from tests.docs.stand_ins import furnish

        self.path = path
        self._names: dict[str, Any] = {}
        furnish(path)

    def run(self, step: Step) -> tuple[int, str]:
        """The exit status of a step and what it prints; of several commands in a line the first that fails."""
        from tests.docs.stand_ins import adapted, adapted_code

        printed, status = io.StringIO(), 0
        told = contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed)
        with contextlib.chdir(self.path), wide(), frugal(), told[0], told[1]:
            if step.code:
                exec(compile(adapted_code(step.code), str(step), "exec"), self._names)  # one document, one story
            for words in () if step.code else adapted(step):
                status = status or self._run(words)
        return status, printed.getvalue()

    def _run(self, words: list[str]) -> int:
        from nao_sim.cli import main

        if words[0] not in PROGRAMS:
            raise AssertionError(f"{shlex.join(words)}: no command of nao-sim, and none of tests/docs/stand_ins.py")
        return main(
            [name for word in words[1:] for name in (sorted(map(str, Path().glob(word))) if "*" in word else [word])]
        )


@contextlib.contextmanager
def wide() -> Iterator[None]:
    """A terminal of 100 columns."""
    before = os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = "100"
    try:
        yield
    finally:
        os.environ.pop("COLUMNS") if before is None else os.environ.update(COLUMNS=before)


@cache
def _compiled(version: str, base: Any) -> Any:
    from nao_sim.simulation.scene import compile_scene

    return compile_scene(version, base)


@contextlib.contextmanager
def frugal() -> Iterator[None]:
    """One process to work and to draw, and simulators whose model was compiled before: each gets a copy."""
    from nao_sim.simulation import simulator

    def again(version: str = "v5", base: Any = "free") -> Any:
        return copy(_compiled(version, base))

    before, simulator.compile_scene = simulator.compile_scene, again
    processors, os.sched_getaffinity = os.sched_getaffinity, lambda _: {0}
    try:
        yield
    finally:
        simulator.compile_scene, os.sched_getaffinity = before, processors


def main(arguments: list[str]) -> int:
    """Run what shows its output, and say or paste what differs."""
    import tempfile

    names, differ = [word for word in arguments if not word.startswith("-")], 0
    for document in DOCUMENTS:
        if names and not any(name in str(document) for name in names):
            continue
        text = document.read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as path:
            folder = Folder(Path(path))
            for step in to_run(document):
                status, printed = folder.run(step)
                print(status, step)
                if step.shown is None or (step.shown and agrees(step.shown, printed)):
                    continue
                differ += 1
                print("".join(difflib.ndiff(tidy(step.shown).splitlines(True), tidy(printed).splitlines(True))))
                if not step.shown and not printed:
                    continue
                text = text.replace(f"$ {step.command}\n{step.shown}", f"$ {step.command}\n{anew(step.shown, printed)}")
        if "--write" in arguments:
            document.write_text(text, encoding="utf-8")
    return int(differ > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
