"""The robot is its own mirror image: what is near in a pose is as near in the mirrored pose, on the other side."""

from __future__ import annotations

import mujoco
import numpy as np

from nao_sim.mujoco_model import JointMap, robot_alone

from .contacts import ROBOT, Contacts, Pair

MIRROR = np.array([1.0, -1.0, 1.0])
NEAR = 0.05  # m
SAME = 1e-9  # m
# A hand is very nearly its own mirror image: its first finger, on its left, is where the other hand's second one is.
TWIN = str.maketrans("LRlr", "RLrl")
FINGERS = str.maketrans("12", "21")


def twin(link: str) -> str:
    """The link that a link is in a mirror."""
    if link[0] not in "LRlr":
        return link
    side, rest = link[0].translate(TWIN), link[1:]
    return side + (f"Finger{rest[6].translate(FINGERS)}{rest[7:]}" if rest.startswith("Finger") else rest)


def distances(contacts: Contacts, pose: np.ndarray) -> dict[Pair, float]:
    return {pair: far for pair, far in contacts.distances(pose).items() if far < NEAR - SAME}


def test_a_mirrored_pose_has_the_mirrored_distances_of_all_pairs_of_links(random_poses: np.ndarray) -> None:
    contacts, seen = Contacts(robot_alone(NEAR), within=NEAR / 2), set()
    for pose in random_poses[:300]:
        plain, mirrored = distances(contacts, pose), distances(contacts, ROBOT.mirror(pose))
        wanted = {frozenset(map(twin, pair)): far for pair, far in plain.items()}
        assert set(mirrored) == set(wanted)
        assert max((abs(mirrored[pair] - far) for pair, far in wanted.items()), default=0.0) < SAME
        seen |= set(wanted)
    assert len(seen) > 100


def test_a_mirrored_pose_has_every_link_where_the_mirror_shows_it(
    alone: mujoco.MjModel, random_poses: np.ndarray
) -> None:
    data, joints = mujoco.MjData(alone), JointMap(alone)
    other = [alone.body(twin(alone.body(i).name)).id for i in range(1, alone.nbody)]
    for pose in random_poses[:100]:
        places = []
        for qpos in joints.to_qpos(np.stack([pose, ROBOT.mirror(pose)])):
            data.qpos[:] = qpos
            mujoco.mj_kinematics(alone, data)
            places.append(data.xpos.copy())
        np.testing.assert_allclose(places[1][other], places[0][1:] * MIRROR, atol=SAME)
