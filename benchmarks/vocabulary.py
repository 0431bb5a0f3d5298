"""Measure poses and movements recognised together, and what teaching makes of recordings; note it in GESTURES.md.

    python benchmarks/vocabulary.py RECORDINGS [together] [kinds] [alone]

RECORDINGS is a folder with `isl_kinect_signs`: 12 signs of 10 signers, three
times each.  Without names all is measured.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
from benchmark import Rows
from gesture_notes import note, wilson
from movements import Signs, signs

sys.path.append(str(Path(__file__).resolve().parent.parent / "tests"))
from gestures.postures import held, skeleton, slerp

from nao_sim.gestures.examples import MOSTLY, example_of
from nao_sim.gestures.gesture_stream import stream_gestures
from nao_sim.gestures.movement_stream import stream_movements
from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.streaming import segments_of
from nao_sim.gestures.vocabulary import Vocabulary, built_in
from nao_sim.motion import Skeleton
from nao_sim.smooth_step import minimum_jerk

WALKS = 25
TRIALS, TESTED = 3, 8  # of a word: choices of teachers, and of strangers who are tested


def together(data: Signs) -> tuple[str, str, Rows]:
    """Signs with the built-in poses beside them, and poses with signs beside them."""
    poses, signers = built_in().poses, np.unique(data.signers)[::3]
    alone, beside, shown, recognised = Counter(), Counter(), Counter(), None
    for signer in signers:
        own = data.signers == signer
        recogniser = data.fit(~own)
        recognised = recognised or recogniser
        vocabulary = Vocabulary(poses, recogniser)
        for place in np.flatnonzero(own):
            word, person = data.words[place], data.people[place]
            alone[_first(stream_movements(recogniser, person), word, recogniser)] += 1
            decisions = stream_gestures(vocabulary, person)
            beside[_first(decisions, word, recogniser)] += 1
            shown.update(each.label for each in segments_of(decisions) if each.label in vocabulary.pose_names)
    walks = Counter()
    for seed in range(WALKS):
        person, told = _walk(seed)
        for name, vocabulary in (("alone", Vocabulary(poses)), ("beside", Vocabulary(poses, recognised))):
            labels = [each.label for each in segments_of(stream_gestures(vocabulary, person))]
            walks[name] += [label for label in labels if label in vocabulary.pose_names][-len(told) :] == told
            walks[f"signs {name}"] += sum(label in vocabulary.movement_names for label in labels)
    count = sum(alone.values())
    rows: Rows = [("shown", "known", "right", "wrong", "nothing")]
    for name, found in (("signs alone", alone), ("signs and the built-in poses", beside)):
        rows.append((f"{count} signs", name, wilson(found["right"], count), str(found["wrong"]), str(found["none"])))
    for name, key in (("poses alone", "alone"), ("poses and signs", "beside")):
        rows.append(
            (f"{WALKS} sequences of poses", name, wilson(walks[key], WALKS), f"{walks['signs ' + key]} signs", "")
        )
    text = (
        "The first sign that is announced, four signers left out. Made-up people go from pose to pose, hold each for "
        "1.5 to 2.5 s and hang the arms now and then; right is a sequence in which every pose is announced in order. "
        f"Poses announced in signs: {', '.join(f'{n} {label}' for label, n in shown.most_common()) or 'none'}. "
        "The signs `afternoon` and `big` are arms held in just these poses."
    )
    return "Gestures: poses and movements together", text, rows


def kinds(data: Signs) -> tuple[str, str, Rows]:
    """What teaching takes each sign for."""
    rows: Rows = [("word", "taken for a movement", "arms kept still, median")]
    still = np.array([example_of(person).stillness for person in data.people])
    for word in np.unique(data.words):
        own = still[data.words == word]
        rows.append((word, f"{(own < MOSTLY).sum()} of {len(own)}", f"{100 * np.median(own):.0f} %"))
    rows.append(("all", wilson(int((still < MOSTLY).sum()), len(still)), f"{100 * np.median(still):.0f} %"))
    return "Gestures: pose or movement", "Signs that some signers hold still are poses to `nao-sim teach`.", rows


def alone(data: Signs) -> tuple[str, str, Rows]:
    """A vocabulary whose only movement is taught by a few examples."""
    rows: Rows = [("examples, each of another signer", "strangers' found", "other signs taken for it")]
    random = np.random.default_rng(0)
    for count in (1, 3, 5):
        hits, false = [], []
        for word in np.repeat(np.unique(data.words), TRIALS):
            teachers = random.choice(np.unique(data.signers), count, replace=False)
            strange, same = ~np.isin(data.signers, teachers), data.words == word
            shown = [random.choice(np.flatnonzero(same & (data.signers == each))) for each in teachers]
            recogniser = MovementRecogniser.fit([data.windows[i] for i in shown], [word] * count)
            for rows_, found in ((strange & same, hits), (strange & ~same, false)):
                tested = random.choice(np.flatnonzero(rows_), TESTED, replace=False)
                found += [recogniser.decide(data.windows[i]).label == word for i in tested]
        rows.append((str(count), wilson(sum(hits), len(hits)), wilson(sum(false), len(false))))
    text = "Harder than with other movements known, whose examples show what is usual and what is something else."
    return "Gestures: the first movement taught", text, rows


def _first(decisions: tuple, word: str, recogniser: MovementRecogniser) -> str:
    found = [each.label for each in segments_of(decisions) if each.label in recogniser.names]
    return "none" if not found else "right" if found[0] == word else "wrong"


def _walk(seed: int) -> tuple[Skeleton, list[str]]:
    """Somebody who shows poses, and which."""
    random = np.random.default_rng(seed)
    hang = held("down")
    parts, told = [hang[None].repeat(30, 0)], []
    for name in random.permutation(["side", "forward", "piUp", "up"]):
        arm = random.choice(["", "left_", "right_"])
        goal = {"": held(name), "left_": held(name, "down"), "right_": held("down", name)}[arm]
        way = minimum_jerk(np.linspace(0.0, 1.0, int(random.integers(15, 36))))
        parts += [np.stack([slerp(parts[-1][-1], goal, share) for share in way])]
        parts += [goal[None].repeat(int(random.integers(45, 75)), 0)]
        told.append(f"{arm}{name}")
        if random.random() < 0.5:
            parts += [np.stack([slerp(goal, hang, share) for share in way]), hang[None].repeat(30, 0)]
            told.append("down")
    return skeleton(np.concatenate(parts), noise=0.007, seed=seed), told


PARTS: dict[str, Callable[[Signs], tuple[str, str, Rows]]] = {"together": together, "kinds": kinds, "alone": alone}


def main() -> None:
    """Measure and note."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", type=Path, metavar="RECORDINGS")
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"any of {', '.join(PARTS)}")
    args = parser.parse_args()
    if strange := set(args.parts) - set(PARTS):
        parser.error(f"unknown part {', '.join(sorted(strange))}; expected any of {', '.join(PARTS)}")
    data = signs(args.recordings / "isl_kinect_signs")
    for name in args.parts or PARTS:
        title, text, rows = PARTS[name](data)
        note(title, text, rows, f"vocabulary.py RECORDINGS {name}")


if __name__ == "__main__":
    main()
