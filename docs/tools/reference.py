"""The parts of the documentation that the code says: commands, formats, layouts.

    python docs/tools/reference.py             # write them anew
    python docs/tools/reference.py --check     # is one not what the code says?

They stand in docs/*.md between `<!-- NAME: written by docs/tools/reference.py -->` and `<!-- /NAME -->`.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable
from importlib import import_module
from inspect import cleandoc
from pathlib import Path

import typer

from nao_sim.cli import COMMANDS
from nao_sim.recordings import FORMATS
from nao_sim.recordings.angles.writing import WRITERS
from nao_sim.recordings.skeletons.layouts import FOLDER, builtin

DOCS = Path(__file__).resolve().parents[1]


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A Markdown table; bars in its cells are escaped."""
    heads = list(head)
    lines = [heads, ["---"] * len(heads), *([cell.replace("|", "\\|").strip() for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def commands() -> str:
    """Every command with its arguments and options, as `--help` has them."""
    overview = table(("command", "what it does"), ((f"[`{name}`](#{name})", COMMANDS[name][2]) for name in COMMANDS))
    return "\n".join([overview, *map(command, COMMANDS)])


def command(name: str) -> str:
    """A command: what its docstring says, and a table of its parameters."""
    module, function, _ = COMMANDS[name]
    called = getattr(import_module(module), function)
    alone = typer.Typer(add_completion=False)
    alone.command(name, context_settings={"help_option_names": ["-h", "--help"]})(called)
    made = typer.main.get_command(alone)
    context = typer.Context(made, info_name=f"nao-sim {name}")
    text = "\n\n".join(map(_paragraph, cleandoc(called.__doc__ or "").split("\n\n")))
    rows = [parameter(*each.get_help_record(context)) for each in made.params if not each.hidden]
    options = table(("argument or option", "what", "default"), rows) if rows else "It has no options.\n"
    return f"## {name}\n\n{text}\n\n{options}"


def parameter(names: str, told: str) -> tuple[str, str, str]:
    """A row of the table from what `--help` says of a parameter."""
    what, _, more = told.partition("  [")
    default = re.search(r"default: (.*?)\]?$", more)
    shown = "" if default is None else re.sub(r"^\((.*)\)$", r"\1", default[1])
    needed = " **Needed.**" if "required" in more else ""
    return f"`{names}`", f"{_plain(what)}{needed}", _plain(shown)


def _paragraph(text: str) -> str:
    """A paragraph of a docstring; one that opens with a backspace keeps its lines, as in `--help`."""
    kept = text.strip().removeprefix("\b\n")
    return f"```text\n{kept}\n```" if "\b" in text else _plain(" ".join(kept.split()))


def _plain(text: str) -> str:
    """Text in which Markdown finds nothing of its own."""
    return re.sub(r"([*_\[])", r"\\\1", text).replace("<", "&lt;")


def formats() -> str:
    """Every format of the registry, and what tells it."""
    return table(
        ("format", "kind", "what such a file starts with"), ((f.name, f.kind, _code(f.looks)) for f in FORMATS)
    )


def _code(text: str) -> str:
    return f"`{text}`" if text.startswith(("{", "[")) else _plain(text)


def written() -> str:
    """Every format in which joint angles are written."""
    return table(("extension", "format"), ((f"`{extension}`", name) for extension, (name, _) in WRITERS.items()))


def layouts() -> str:
    """Every built-in layout, with its file."""
    files = {name(path): path.name for path in FOLDER.glob("*.toml")}
    rows = ((each.name, str(len(each.joints)), _plain(each.source), f"`{files[each.name]}`") for each in builtin())
    return table(("layout", "points", "where its order is from", "file"), rows)


def name(path: Path) -> str:
    """What the layout in a file is called."""
    from nao_sim.recordings.skeletons.layout_file import read_layout

    return read_layout(path).name


PARTS: dict[str, tuple[str, Callable[[], str]]] = {
    "commands": ("commands.md", commands),
    "formats": ("formats.md", formats),
    "written": ("formats.md", written),
    "layouts": ("layouts.md", layouts),
}


def main(arguments: list[str]) -> int:
    """Write the parts, or say which differ."""
    different = []
    for part, (document, write) in PARTS.items():
        path = DOCS / document
        before = path.read_text(encoding="utf-8")
        between = re.compile(f"(<!-- {part}: [^>]*-->\n).*?(<!-- /{part} -->)", re.DOTALL)
        made = write()
        text = between.sub(lambda found: f"{found[1]}{made}{found[2]}", before)  # noqa: B023  # called at once
        if text != before:
            different.append(f"{document} ({part})")
            if arguments != ["--check"]:
                path.write_text(text, encoding="utf-8")
    print(f"{'differ' if arguments == ['--check'] else 'written'}: {', '.join(different) or 'none'}")
    return int(bool(different) and arguments == ["--check"])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
