"""Which rules can be switched off, and what that takes."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.errors import UsageError
from nao_sim.safety.rules import ALWAYS, SPEED_FRACTION, SWITCHABLE, Rules


@given(st.sets(st.sampled_from(SWITCHABLE)))
def test_with_the_risk_accepted_exactly_the_rules_named_are_off(off):
    rules = Rules(off=frozenset(off), accept_risk=True)
    assert {rule for rule in (*SWITCHABLE, *ALWAYS) if not rules.holds(rule)} == off


@given(st.sets(st.sampled_from(SWITCHABLE), min_size=1))
def test_without_accepting_the_risk_nothing_can_be_switched_off_and_the_next_step_is_named(off):
    with pytest.raises(UsageError, match="--accept-risk") as refused:
        Rules(off=frozenset(off))
    assert all(rule in str(refused.value) for rule in off)


@pytest.mark.parametrize("rule", ALWAYS)
def test_position_limits_can_never_be_off(rule):
    with pytest.raises(UsageError, match=rf"{rule} can never be off.*expected one of {', '.join(SWITCHABLE)}"):
        Rules(off=frozenset({rule}), accept_risk=True)


@pytest.mark.parametrize("rule", ["", "limits", "Speed", "detour"])
def test_a_rule_that_there_is_not_is_refused_with_those_that_there_are(rule):
    with pytest.raises(UsageError, match=rf"no rule '{rule}'; expected one of {', '.join(SWITCHABLE)}"):
        Rules(off=frozenset({rule}), accept_risk=True)
    with pytest.raises(UsageError, match="no rule"):
        Rules().holds(rule)


@given(st.floats(allow_nan=True))
def test_the_speed_is_a_share_from_a_twentieth_to_all_of_the_motors(share):
    if 0.05 <= share <= 1.0:
        assert Rules(share).speed_fraction == share
    else:
        with pytest.raises(UsageError, match=r"0\.05 to 1 .*--max-speed"):
            Rules(share)


def test_unless_told_otherwise_all_rules_hold_at_the_usual_speed():
    assert Rules() == Rules(SPEED_FRACTION, frozenset(), False)
    assert all(Rules().holds(rule) for rule in (*SWITCHABLE, *ALWAYS))
