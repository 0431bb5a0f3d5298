"""Which rules the guard keeps, and how fast it lets the robot move."""

from __future__ import annotations

from dataclasses import dataclass

from nao_sim.errors import UsageError

SPEED_FRACTION = 0.8  # of the motors' no-load speed, unless somebody asks for another
SLOWEST, FASTEST = 0.05, 1.0
SWITCHABLE = ("coupling", "speed", "self_collision", "balance", "stream")
ALWAYS = ("limit", "margin", "position", "one_motor")  # position limits, and what the machine is


@dataclass(frozen=True)
class Rules:
    """What the guard is told.

    Attributes:
        speed_fraction: greatest speed of a joint, as a share (0.05 to 1) of its motor's no-load speed.
        off: rules that are switched off, of `SWITCHABLE`; position limits never are.
        accept_risk: whether whoever switched them off knows what that may do.

    Raises:
        UsageError: no such share, no such rule, or a rule off without `accept_risk`.
    """

    speed_fraction: float = SPEED_FRACTION
    off: frozenset[str] = frozenset()
    accept_risk: bool = False

    def __post_init__(self) -> None:
        if not SLOWEST <= self.speed_fraction <= FASTEST:  # not a number is refused, too
            raise UsageError(
                f"speed fraction {self.speed_fraction:g}: expected a share of the motors' no-load speed "
                f"from {SLOWEST:g} to {FASTEST:g} (--max-speed)"
            )
        object.__setattr__(self, "off", frozenset(self.off))
        for rule in sorted(self.off):
            _check(rule)
        if self.off and not self.accept_risk:
            raise UsageError(
                f"without {' and '.join(sorted(self.off))} the robot can break, fall or hurt somebody; "
                "expected --accept-risk (accept_risk=True) beside it"
            )

    def holds(self, rule: str) -> bool:
        """Whether a rule is on; position limits always are.

        Raises:
            UsageError: there is no such rule.
        """
        if rule in ALWAYS:
            return True
        _check(rule)
        return rule not in self.off


def _check(rule: str) -> None:
    """Refuse a rule that cannot be switched off.

    Raises:
        UsageError: it always holds, or there is none of that name.
    """
    known = f"expected one of {', '.join(SWITCHABLE)}"
    if rule in ALWAYS:
        raise UsageError(f"rule {rule} can never be off: the joints' position limits always hold; {known}")
    if rule not in SWITCHABLE:
        raise UsageError(f"there is no rule {rule!r}; {known}")


ALL = Rules()  # every rule, at the usual speed
