"""What the rules on poses have in common: how far inside a pose is, and how that changes."""

from __future__ import annotations

from dataclasses import dataclass

from nao_sim.robot import Array


@dataclass(frozen=True, eq=False)
class Margin:
    """How far a pose is inside one rule.

    Attributes:
        rule: the rule's name, which is the reason of what it changes.
        value: m or rad; not negative where the rule is obeyed.
        gradient: (26,) its derivative by the joint vector.
        links: the two links that it is about, for self-collision.
    """

    rule: str
    value: float
    gradient: Array
    links: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Finding:
    """A rule that a way comes near or breaks.

    Attributes:
        margin: of the pose where it does.
        row: (26,) derivative of the margin by the speeds of the next step.
    """

    margin: Margin
    row: Array
