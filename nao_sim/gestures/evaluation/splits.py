"""Who learns from whom: users left out, folds, or examples set apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.gestures.evaluation.data_set import DataSet, Example
from nao_sim.gestures.held_out import each_user, folds
from nao_sim.robot import Mask


class Split(NamedTuple):
    """Which of N examples are learned from (N,), and which are judged (N,)."""

    train: Mask
    test: Mask


class Plan(NamedTuple):
    """How a data set is judged.

    Attributes:
        words: what is done, in a few words.
        examples: (N) all of them.
        splits: of the examples.
    """

    words: str
    examples: tuple[Example, ...]
    splits: tuple[Split, ...]


def plan(data: DataSet, test: DataSet | None = None, count: int | None = None) -> Plan:
    """How to judge a data set.

    Args:
        data: the examples.
        test: others, that all of those are judged by.
        count: of folds.

    Returns:
        By `test` or in `count` folds, where they are given; by the data set's own
        `split` where it has one; else with each user left out.

    Raises:
        UsageError: both are given, or the data do not allow it.
    """
    if test is not None and count is not None:
        raise UsageError("--test and --folds contradict each other; give one of them")
    if test is not None:
        apart = np.arange(len(data.examples) + len(test.examples)) >= len(data.examples)
        words = f"learned from {data.manifest.path}, judged by {test.manifest.path}"
        return Plan(words, (*data.examples, *test.examples), (Split(~apart, apart),))
    if count is not None:
        return Plan(f"{count} folds by chance, seed 0", data.examples, _folds(data, count))
    if any(each.split for each in data.examples):
        return Plan("learned from train, judged by test", data.examples, (_given(data),))
    return Plan("each user judged by what was learned from all others", data.examples, _users(data))


def all_judged(data: DataSet, by: str) -> Plan:
    """Every example judged by what was learned elsewhere, `by` in a few words."""
    everything = np.ones(len(data.examples), bool)
    return Plan(f"judged by {by}, whoever it learned from", data.examples, (Split(~everything, everything),))


def _folds(data: DataSet, count: int) -> tuple[Split, ...]:
    if not 2 <= count <= len(data.examples):  # noqa: PLR2004
        raise UsageError(f"--folds {count}: expected 2 to {len(data.examples)}, which is the number of examples")
    return _held_out(folds(np.array([each.label for each in data.examples]), count))


def _given(data: DataSet) -> Split:
    manifest = data.manifest
    if row := next((row for row in manifest.rows if not row.split), None):
        raise manifest.error(row, "an empty cell beside others that are not", "train or test", "split")
    sides = np.array([each.split for each in data.examples])
    for side in ("train", "test"):
        if side not in sides:
            raise UsageError(f"{manifest.path}: no row of split {side}; expected train and test")
    return Split(sides == "train", sides == "test")


def _users(data: DataSet) -> tuple[Split, ...]:
    manifest = data.manifest
    if row := next((row for row in manifest.rows if not row.user), None):
        raise manifest.error(row, "nobody", "who made it (or --folds, --test)", "user")
    try:
        return _held_out(each_user(np.array([each.user for each in data.examples])))
    except ValueError:
        only = data.users[0]
        raise UsageError(
            f"{manifest.path}: examples of one user ({only}); expected two users or more, or --folds, or --test"
        ) from None


def _held_out(tests: Sequence[Mask]) -> tuple[Split, ...]:
    return tuple(Split(~test, test) for test in tests)
