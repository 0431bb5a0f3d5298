"""Commands and outputs as the documentation shows them: found, run in a folder with samples, compared, pasted anew.

    python -m tests.docs.shown            # which outputs differ
    python -m tests.docs.shown --write    # paste what is printed now; lines of `...` stay

A block of `sh` has commands, a line each; one of `console` has commands after `$ ` and what they print. A line `...`
stands for any lines, and `…` in a line for any words: times differ from machine to machine.
"""

from __future__ import annotations

import contextlib
import difflib
import glob
import io
import os
import re
import shlex
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
PROGRAMS = ("./run", "nao-sim")
ELIDED, SOMETHING = "...", "…"
_BLOCK = re.compile(r"^```(?P<kind>\w+)\n(?P<text>.*?)^```$", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class Step:
    """A command of a document.

    Attributes:
        document: where it stands.
        line: number of its line.
        command: as it is shown.
        shown: what it prints, as the document has it; None where it does not.
    """

    document: Path
    line: int
    command: str
    shown: str | None = None

    def __str__(self) -> str:
        return f"{self.document.relative_to(ROOT)}:{self.line}: {self.command}"


def blocks(text: str, *kinds: str) -> Iterator[re.Match[str]]:
    """Fenced blocks of some languages."""
    return (found for found in _BLOCK.finditer(text) if found["kind"] in kinds)


def steps(document: Path) -> list[Step]:
    """All commands of a document, in their order."""
    text, found = document.read_text(encoding="utf-8"), []
    for block in blocks(text, "sh", "console"):
        line = text[: block.start("text")].count("\n") + 1
        if block["kind"] == "sh":
            lines = enumerate(block["text"].splitlines(), start=line)
            found += [Step(document, number, each) for number, each in lines if shlex.split(each, comments=True)]
            continue
        for part in re.split(r"^\$ ", block["text"], flags=re.MULTILINE)[1:]:
            command, _, shown = part.partition("\n")
            found.append(Step(document, line, command, shown if shown.strip() else None))
            line += part.count("\n")
    return found


def agrees(shown: str, printed: str) -> bool:
    """Whether what is printed is what is shown, but for what is left out."""
    lines = [
        r"(?:.*\n)*?" if line == ELIDED else re.escape(line).replace(SOMETHING, ".*") + r"[ \t]*\n"
        for line in tidy(shown).splitlines()
    ]
    return re.fullmatch("".join(lines), tidy(printed)) is not None


def tidy(text: str) -> str:
    """Without spaces at the ends of lines, and empty lines at the end."""
    return "".join(f"{line.rstrip()}\n" for line in text.rstrip().splitlines())


def anew(shown: str, printed: str) -> str:
    """What is printed, with what was left out of what is shown left out again."""
    old, new = tidy(shown).splitlines(), tidy(printed).splitlines()
    loose = [re.escape(line).replace(SOMETHING, ".*") for line in old if SOMETHING in line]
    kept = [line for line in old if SOMETHING in line]
    new = [next((to for at, to in zip(loose, kept, strict=True) if re.fullmatch(at, line)), line) for line in new]
    if ELIDED in old:
        first, last = old.index(ELIDED), len(old) - 1 - old[::-1].index(ELIDED)
        new = [*new[:first], ELIDED, *new[len(new) - (len(old) - 1 - last) :]]
    return "\n".join(new) + "\n"


class Folder:
    """Where the commands of a document run, with files by the names that they use."""

    def __init__(self, path: Path) -> None:
        from tests.docs.stand_ins import furnish

        self.path = path
        furnish(path)

    def run(self, step: Step) -> tuple[int, str]:
        """The exit status of a step and what it prints; of several commands in a line the first that fails."""
        from tests.docs.stand_ins import adapted

        printed, status = io.StringIO(), 0
        with contextlib.chdir(self.path), wide(), contextlib.redirect_stdout(printed):
            with contextlib.redirect_stderr(printed):
                for command in adapted(step).split("&&"):
                    status = status or self._run(shlex.split(command, comments=True))
        return status, printed.getvalue()

    def _run(self, words: list[str]) -> int:
        from nao_sim.cli import main

        if words[0] not in PROGRAMS:
            raise AssertionError(f"{shlex.join(words)}: no command of nao-sim, and none of tests/docs/stand_ins.py")
        return main([name for word in words[1:] for name in (sorted(glob.glob(word)) or [word])])


@contextlib.contextmanager
def wide() -> Iterator[None]:
    """A terminal of 100 columns."""
    before = os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = "100"
    try:
        yield
    finally:
        os.environ.pop("COLUMNS") if before is None else os.environ.update(COLUMNS=before)


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
            for step in steps(document):
                status, printed = folder.run(step)
                print(status, step)
                if step.shown is None or agrees(step.shown, printed):
                    continue
                differ += 1
                print("".join(difflib.ndiff(tidy(step.shown).splitlines(True), tidy(printed).splitlines(True))))
                text = text.replace(f"$ {step.command}\n{step.shown}", f"$ {step.command}\n{anew(step.shown, printed)}")
        if "--write" in arguments:
            document.write_text(text, encoding="utf-8")
    return int(differ > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
