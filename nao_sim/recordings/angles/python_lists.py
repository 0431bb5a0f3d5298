"""Lists that a Python program fills with literals, read without running the program.

The text is cut into statements by its brackets, strings and comments alone, so
that Python 2 around the lists does no harm.  Of these only assignments, `+=`,
`.append(...)` and `.extend(...)` are looked at, and their values must be
numbers, strings and lists of them (or a few constants such as `math.pi`).
"""

from __future__ import annotations

import ast
import json
import math
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from nao_sim.recordings.source import Source

Literal = Any  # float, str or a list of these
CONSTANTS = {
    **dict.fromkeys(("math.pi", "np.pi", "numpy.pi", "almath.PI", "pi"), math.pi),
    **dict.fromkeys(("almath.TO_RAD", "motion.TO_RAD", "TO_RAD"), math.radians(1.0)),
}
FUNCTIONS: dict[str, Callable[[float], float]] = dict.fromkeys(
    ("math.radians", "radians", "np.radians", "numpy.radians", "np.deg2rad", "numpy.deg2rad"), math.radians
)
EXPECTED = "a literal list of numbers: the program is read, not run"
_NUMBER = r"[-+0-9.eE,\s]++"


def _nested(depth: int) -> str:
    """Pattern of a list of numbers and of such lists, `depth` deep."""
    return rf"\[(?:{_NUMBER}|{_nested(depth - 1)})*+\]" if depth else r"\[\]"


_TOKEN = re.compile(
    rf"""(?P<string>\"{{3}}(?:\\.|[^\\])*?\"{{3}}|'{{3}}(?:\\.|[^\\])*?'{{3}}|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
      | (?P<comment>\#[^\n]*) | (?P<list>{_nested(4)}) | (?P<open>[\[({{]) | (?P<close>[\])}}]) | (?P<end>[\n;])
      | (?P<other>\\\n|[^"'\#\[\](){{}}\n;\\]+|.)""",
    re.VERBOSE | re.DOTALL,
)
_STATEMENT = re.compile(
    r"(?:self\.)?(?P<name>\w+)\s*(?P<how>=(?!=)|\+=|\.\s*(?:append|extend)\s*\()(?P<value>.*)", re.DOTALL
)
_DEFINITION = re.compile(r"def\s+(\w+)")
_NUMBERS = re.compile(r"[-+0-9.eE,\s\[\]]*")
_BINARY: dict[type, Callable[[float, float], float]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}


@dataclass(frozen=True)
class Statement:
    """A statement that fills a list.

    Attributes:
        line: its first.
        function: the function it stands in, empty outside.
        name: the list's, without `self.`.
        how: `=`, `append` or `extend`.
        value: the source text of what is put in.
        finished: whether its brackets close.
    """

    line: int
    function: str
    name: str
    how: str
    value: str
    finished: bool


def list_statements(text: str) -> Iterator[Statement]:
    """The statements that may fill a list."""
    function = ""
    for line, words, finished in _statements(text):
        if match := _DEFINITION.match(words):
            function = match[1]
        elif match := _STATEMENT.fullmatch(words):
            how, value = match["how"], match["value"]
            value = value.removesuffix(")") if how.startswith(".") else value
            how = "append" if "append" in how else "=" if how == "=" else "extend"
            yield Statement(line, function, match["name"], how, value, finished)


def _statements(text: str) -> Iterator[tuple[int, str, bool]]:
    """The line that each statement starts on, the statement without comments, and whether its brackets close."""
    line, depth, start, parts = 1, 0, 1, list[str]()
    for match in _TOKEN.finditer(text):
        kind, token = match.lastgroup, match[0]
        depth = max(0, depth + (kind == "open") - (kind == "close"))
        if kind == "end" and depth == 0:
            yield start, "".join(parts).rstrip(), True
            parts = []
        elif kind != "comment" and (parts or token.strip()):
            start = start if parts else line
            parts.append(token if parts else token.lstrip())
        line += token.count("\n")
    yield start, "".join(parts).rstrip(), depth == 0


def literal(source: Source, statement: Statement) -> Literal:
    """The value that a statement puts in.

    Raises:
        RecordingError: it is no literal, or not finished.
    """
    name, line, text = statement.name, statement.line, statement.value
    if not statement.finished:
        raise source.error(f"the end of the file within {name}", "the list's closing bracket", line, name)
    if _NUMBERS.fullmatch(text):  # plain lists of numbers, the most of every file
        with suppress(ValueError, RecursionError):
            return json.loads(text, parse_int=float)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of odd escapes in strings
            return _value(ast.parse(f"({text}\n)", mode="eval").body)
    except SyntaxError as error:
        raise source.error(f"{error.msg}", EXPECTED, line + (error.lineno or 1) - 1, name) from None
    except _NoLiteralError as error:
        raise source.error(f"'{_shown(error.node)}'", EXPECTED, line + error.node.lineno - 1, name) from None
    except (ValueError, OverflowError, ZeroDivisionError, RecursionError, MemoryError):
        raise source.error("a value that cannot be read", EXPECTED, line, name) from None


class _NoLiteralError(Exception):
    """Something that only running the program would tell."""

    def __init__(self, node: ast.expr) -> None:
        self.node = node


def _value(node: ast.expr) -> Literal:
    match node:
        case ast.Constant(value=bool()):
            raise _NoLiteralError(node)
        case ast.Constant(value=int() | float() as value):
            return float(value)
        case ast.Constant(value=str() as text):
            return text
        case ast.List() | ast.Tuple():
            return [_value(item) for item in node.elts]
        case ast.Call(func=ast.Name(id="list"), args=[], keywords=[]):
            return []
        case _:
            return _arithmetic(node)


def _arithmetic(node: ast.expr) -> float:
    match node:
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
            value = _real(operand)
            return -value if isinstance(node.op, ast.USub) else value
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            return _BINARY[type(op)](_real(left), _real(right))
        case ast.Attribute() | ast.Name() if ast.unparse(node) in CONSTANTS:
            return CONSTANTS[ast.unparse(node)]
        case ast.Call(func=function, args=[argument], keywords=[]) if ast.unparse(function) in FUNCTIONS:
            return FUNCTIONS[ast.unparse(function)](_real(argument))
    raise _NoLiteralError(node)


def _real(node: ast.expr) -> float:
    value = _value(node)
    if not isinstance(value, float):
        raise _NoLiteralError(node)
    return value


def _shown(node: ast.expr) -> str:
    try:
        text = " ".join(ast.unparse(node).split())
    except RecursionError:
        return "..."
    return text if len(text) <= 40 else text[:37] + "..."  # noqa: PLR2004
