"""Every way to take lines of numbers as the joints of a layout, and the one that makes a body."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice

import numpy as np

from nao_sim.recordings.skeletons.anatomy import Body
from nao_sim.recordings.skeletons.facing import Told
from nao_sim.recordings.skeletons.fitting import WORST
from nao_sim.recordings.skeletons.layout_file import read_layout
from nao_sim.recordings.skeletons.layouts import Layout, Row, builtin
from nao_sim.recordings.skeletons.plausibility import disproportion
from nao_sim.recordings.skeletons.points import flattened, sample_of
from nao_sim.recordings.skeletons.readings import Reading, best, by_layout, gather
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables.number_rows import Block, Frames, Style, style_of
from nao_sim.recordings.tables.row_shapes import Plan, fits, plain_joint_rows, plain_rows, plan, with_roles
from nao_sim.robot import Array

FEWEST = 13  # joints of a skeleton
COUNTS = 3  # numbers that a line above the frames may have, and lines above them
WIDEST_JOINT = 8  # numbers of a line that has one joint
SAMPLE = 200  # lines, spread over the file, that tell what they are
FINALISTS, FEW = 3, 16  # ways of taking the numbers that are looked at closely, frames of a first look
WASTE = 2.0  # of a cost: numbers that are left over, if all of them are


def chosen(source: Source) -> tuple[Plan, Block]:
    """Find out what the numbers of a line are, and how lines make frames.

    Raises:
        RecordingError: no layout fits, or several do.
    """
    own = None if source.layout is None else read_layout(source.layout)
    if own is not None and not own.joints:
        raise source.error("numbers without names", f"joints in layout {own.path}, which has names only")
    looks = _Looks(source, own)
    candidates = [found for layout in ((own,) if own else builtin()) for found in _candidates(looks, layout)]
    if own is not None and not candidates:
        raise source.error(looks.what, f"{_expected(own)}, as in layout {own.path}", looks.first[0])
    candidates = _promising(candidates)
    readings = [candidate.reading(own) for candidate in candidates]
    if own is not None and (own.rows or len(candidates) == 1):
        first = min(readings, key=lambda reading: reading.fit.cost)
    else:
        first = best(source, readings, [candidate.points for candidate in candidates], looks.what, own)
    found = next(candidate for candidate, reading in zip(candidates, readings, strict=True) if reading is first)
    return found.plan, found.block


def _promising(candidates: Sequence[_Candidate]) -> list[_Candidate]:
    """Those whose bones have a body's lengths in a few frames, or if none the likeliest of all."""
    rough = [candidate.disproportion() for candidate in candidates]
    likely = sorted(range(len(candidates)), key=lambda i: rough[i])[:FINALISTS]
    return [candidates[i] for i in range(len(candidates)) if rough[i] < WORST["disproportion"] or i in likely]


@dataclass(frozen=True, eq=False)
class _Candidate:
    plan: Plan
    block: Block
    sample: Array
    declared: bool

    @cached_property
    def points(self) -> Array:
        """The points (S, J, 3) of the sample."""
        return sample_of(self.plan.points(self.sample), self.plan.layout.zeros_missing)

    def reading(self, own: Layout | None) -> Reading:
        """The points by this plan, at a higher cost the more numbers are left over."""
        layout, planar = self.plan.layout, self.plan.planar
        told = Told(layout.unit, layout.axes, firm=own is not None, usual=own is None, planar=planar)
        reading = by_layout(flattened(self.points) if planar else self.points, layout, told)
        cost = reading.fit.cost + WASTE * self.plan.unexplained * (not self.declared)
        return replace(reading, fit=replace(reading.fit, cost=cost))

    def disproportion(self) -> float:
        """How unlike a body the bones are, by a few frames."""
        columns = self.plan.layout.columns
        few = self.points[:: max(len(self.points) // FEW, 1)]
        return float(np.nan_to_num(disproportion(Body(tuple(columns), gather(columns, few))), nan=np.inf))


def _expected(own: Layout) -> str:
    widths = [row.width(len(own)) for row in own.rows] or [len(own) * size for size in (3, 4)]
    return f"{' or '.join(str(width) for width in dict.fromkeys(widths))} numbers a line"


def opening(rows: Sequence[Sequence[str]]) -> int:
    """How many lines of a few numbers stand above lines of many: counts of frames, joints and the like."""
    few = next((place for place, row in enumerate(rows) if len(row) > COUNTS), 0)
    return few if few <= COUNTS and len(rows) > few and len(rows[few]) >= 2 * FEWEST else 0


class _Looks:
    """What lines look like: their style and length, and the numbers of some."""

    def __init__(self, source: Source, own: Layout | None) -> None:
        self.source, self._own = source, own
        self._samples: dict[tuple[int, bool, int, int], tuple[Array, Array] | None] = {}
        header = own.header if own and own.header else 0
        lines = list(islice(Frames(source, Block(Style(None), header=header)).lines(), COUNTS + 2))
        if not lines:
            raise source.error("no numbers", "a line of numbers a frame (or a joint)")
        skipped = opening([style_of(text).cells(text) for _, text in lines]) if own is None else 0
        self.header = lines[skipped][0] - 1 if skipped else header
        self.first = lines[skipped]
        self.style = style_of(self.first[1], own.separator if own else None)
        self.width = len(self.style.cells(self.first[1]))
        self.opens = self.width <= len(("frames", "joints")) and len(lines) > 1

    @property
    def what(self) -> str:
        """What there is, for messages."""
        return f"{self.width} number{'s' * (self.width > 1)} a line"

    def block(self, found: Plan) -> Block:
        """How lines make frames by a plan."""
        row, layout = found.row, found.layout
        header = self.header if row.header is None else row.header
        style = Style(None) if row.counted else self.style
        return Block(style, found.lines, row.between, header, row.counted, layout.end, found.columns)

    def sample(self, block: Block) -> tuple[Array, Array] | None:
        """Frames (S, C) spread over the file, and the first ones (H, C) in a row; None where none is whole."""
        key = (block.lines, block.counted, block.header, len(block.columns))
        if key not in self._samples:
            self._samples[key] = self._sampled(block)
        return self._samples[key]

    def _sampled(self, block: Block) -> tuple[Array, Array] | None:
        head = next(Frames(self.source, block).chunks(), None)
        if head is None:
            return None
        if block.lines > 1 or len(head[0]) < SAMPLE:
            return head[1], head[1][:SAMPLE]
        spread = Frames(self.source, block).spread(SAMPLE)
        return np.vstack([spread, head[1][:SAMPLE]]), head[1][:SAMPLE]


def _candidates(looks: _Looks, layout: Layout) -> Iterator[_Candidate]:
    """The ways to take lines of this length as a layout's joints, the likelier first."""
    known = [row for row in layout.rows if row.counted == looks.opens and _right(looks, row, layout)]
    own = layout.path is not None
    plain = list[Row]()
    if not looks.opens and not (own and layout.rows):
        plain += plain_rows(looks.width, len(layout))
        plain += plain_joint_rows(looks.width) if looks.width <= WIDEST_JOINT else ()
    trusted = False
    for row in (*known, *(row for row in plain if row not in known)):
        found = plan(layout, row)
        block = looks.block(found)
        sampled = looks.sample(block) if not (trusted and row in plain) else None
        if sampled is None or not fits(found, sampled[0]):
            continue
        trusted = trusted or (row in known and found.planar and found.trust is not None)
        declared = row in known
        yield _Candidate(found if declared else with_roles(found, *sampled), block, sampled[0], declared)


def _right(looks: _Looks, row: Row, layout: Layout) -> bool:
    """Whether a row shape has as many numbers as the file's lines."""
    return row.counted or row.width(len(layout)) == looks.width
