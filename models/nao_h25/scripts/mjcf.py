"""Write `nao_h25.xml`, the robot alone, from facts.json, collision.json, gains.json and assets/shells.json."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from tables import MODEL, mirrored, numbers, quaternion, rotation, table

# MuJoCo cameras look along -z with y up, rangefinders look along +z: their
# axes seen in a sensor frame that looks along +x with z up.
CAMERA_AXES = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
RANGEFINDER_AXES = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
# Collision bits; whatever has MuJoCo's default bits (floor, objects) touches all.
# The soles, boxes with corners that no foot has, touch only the world: between
# the feet the rounded capsules count.  The fingers of one hand fold onto each
# other by construction, so only those of the other hand have their bit.
WORLD, BODY, LEFT_FINGER, RIGHT_FINGER = 1, 2, 4, 8
EFFECTORS = {"Head": "Head", "LArm": "l_wrist", "RArm": "r_wrist", "LLeg": "l_ankle", "RLeg": "r_ankle"}
# A touch sensor feels contacts inside its ball, m: it reaches through the air of the collision shape around it.
TOUCH_RADIUS = "0.013"
FINGERTIPS = ("Finger13_link", "Finger23_link", "Thumb2_link")


def build(gains: Mapping[str, Mapping[str, float]]) -> str:
    """The robot's MJCF, with each joint's row of `gains` in its joint and actuator."""
    facts, collision, shells = table("facts.json"), table("collision.json"), table("assets/shells.json")
    root = ET.Element("mujoco", model="nao_h25")
    root.append(ET.Comment(" Written by scripts/build.py from facts.json; change the tables, not this file. "))
    ET.SubElement(root, "compiler", angle="radian", meshdir="assets", autolimits="true")
    # elliptic friction cones have no preferred direction, so a mirrored motion stays mirrored
    ET.SubElement(root, "option", timestep="0.002", integrator="implicitfast", cone="elliptic")
    _defaults(root)
    _assets(root, shells)
    _bodies(root, facts, collision, shells, gains)
    _contacts(root, collision)
    _couplings(root, facts)
    _actuators(root, facts, gains)
    _sensors(root, facts)
    _keyframes(root, facts)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _defaults(root: ET.Element) -> None:
    top = ET.SubElement(ET.SubElement(root, "default"), "default", {"class": "nao_h25"})
    ET.SubElement(top, "site", size="0.004", group="4", rgba="0.2 0.5 0.9 1")
    visual = ET.SubElement(top, "default", {"class": "visual"})
    ET.SubElement(visual, "geom", type="mesh", contype="0", conaffinity="0", group="2", density="0")
    shape = ET.SubElement(top, "default", {"class": "collision"})
    look = {"group": "3", "density": "0", "rgba": "0.9 0.5 0.1 0.5"}
    ET.SubElement(shape, "geom", look, type="capsule", contype=f"{WORLD | BODY}", conaffinity=f"{BODY}")
    for side, own, other in (("left", LEFT_FINGER, RIGHT_FINGER), ("right", RIGHT_FINGER, LEFT_FINGER)):
        finger = ET.SubElement(shape, "default", {"class": f"{side}_finger"})
        ET.SubElement(finger, "geom", contype=f"{WORLD | own}", conaffinity=f"{BODY | other}")
    sole = ET.SubElement(shape, "default", {"class": "sole"})
    touch = {"priority": "1", "friction": "0.8 0.01 0.001", "solref": "0.01 1"}
    ET.SubElement(sole, "geom", touch, type="box", contype=f"{WORLD}", conaffinity="0")


def _assets(root: ET.Element, shells: Mapping[str, Any]) -> None:
    asset = ET.SubElement(root, "asset")
    for name, look in shells["materials"].items():
        words = {key: numbers(value) for key, value in look.items() if key != "doc"}
        ET.SubElement(asset, "material", {"name": name, **words})
    for shell in shells["shells"]:
        ET.SubElement(asset, "mesh", name=_mesh(shell, shell["link"]), file=shell["file"])
        if shell["mirror_to"]:
            ET.SubElement(asset, "mesh", name=_mesh(shell, shell["mirror_to"]), file=shell["file"], scale="1 -1 1")


def _mesh(shell: Mapping[str, Any], link: str) -> str:
    return f"{link}_{shell['material']}"


def _bodies(
    root: ET.Element,
    facts: Mapping[str, Any],
    collision: Mapping[str, Any],
    shells: Mapping[str, Any],
    gains: Mapping[str, Mapping[str, float]],
) -> None:
    """The kinematic tree, each link with its inertia, joint, shells, shapes and sites."""
    links = {link["name"]: link for link in facts["links"]}
    shapes = _both_sides(collision["shapes"])
    sites = _sites(facts)
    worldbody = ET.SubElement(root, "worldbody")
    height = f"{_standing_height(facts):.5g}"
    bodies = {"torso": ET.SubElement(worldbody, "body", name="torso", pos=f"0 0 {height}", childclass="nao_h25")}
    ET.SubElement(bodies["torso"], "freejoint", name="root")
    joints: list[Mapping[str, Any]] = [*facts["joints"], *map(_finger_joint, facts["hand"]["finger_joints"])]
    for joint in joints:
        frame = {"name": joint["child"], "pos": numbers(joint["origin_m"])}
        if any(joint.get("origin_rpy_rad", ())):
            frame["quat"] = numbers(quaternion(rotation(joint["origin_rpy_rad"])))
        body = bodies[joint["child"]] = ET.SubElement(bodies[joint["parent"]], "body", frame)
        row = gains.get(joint["name"], gains["finger"])
        ET.SubElement(
            body,
            "joint",
            name=joint["name"],
            axis=numbers(joint["axis"]),
            range=numbers((joint["lower"], joint["upper"])),
            damping=numbers((row["damping"], 0.0, row["damping_cubic"])),
            armature=numbers(row["armature"]),
        )
    for name, body in bodies.items():
        inertial = _inertial(links.get(name), facts)
        body.insert(0 if name != "torso" else 1, ET.Element("inertial", inertial))
        for material, mesh in _link_shells(shells, name):
            ET.SubElement(body, "geom", {"class": "visual"}, mesh=mesh, material=material)
        for i, shape in enumerate(shapes.get(name, ())):
            ET.SubElement(body, "geom", _shape(name, i, shape))
        for site in sites.get(name, ()):
            ET.SubElement(body, site.pop("tag"), site)
    for side, foot in (("left", "l_ankle"), ("right", "r_ankle")):
        ET.SubElement(bodies[foot], "geom", _sole(facts, collision["sole_thickness_m"], side))


def _standing_height(facts: Mapping[str, Any]) -> float:
    """Height of the torso's origin over the floor with straight legs."""
    chain = ("LHipYawPitch", "LKneePitch", "LAnklePitch")
    return facts["foot_height_m"] - sum(j["origin_m"][2] for j in facts["joints"] if j["name"] in chain)


def _finger_joint(finger: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "name": finger["name"],
        "parent": finger["parent_link"],
        "child": finger["child_link"],
        "origin_m": finger["origin_xyz_m"],
        "origin_rpy_rad": finger["origin_rpy_rad"],
        "axis": finger["axis"],
        "lower": finger["lower_rad"],
        "upper": finger["upper_rad"],
    }


def _inertial(link: Mapping[str, Any] | None, facts: Mapping[str, Any]) -> dict[str, str]:
    if link is None:  # fingers and grippers: their mass is inside the hand
        mass = facts["hand"]["finger_mass_kg"]
        return {"pos": "0 0 0", "mass": numbers(mass), "diaginertia": numbers([1e-9] * 3, 12)}
    inertia = numbers(link["inertia_about_com_kg_m2"], 12)
    return {"pos": numbers(link["com_m"]), "mass": numbers(link["mass_kg"]), "fullinertia": inertia}


def _link_shells(shells: Mapping[str, Any], link: str) -> Iterator[tuple[str, str]]:
    for shell in shells["shells"]:
        if link in (shell["link"], shell["mirror_to"]):
            yield shell["material"], _mesh(shell, link)


def _both_sides(shapes: Mapping[str, Any]) -> dict[str, Any]:
    """Add the right side's shapes: the left ones with y reversed."""
    right = {
        mirrored(link): [[kind, radius, *([x, -y, z] for x, y, z in points)] for kind, radius, *points in rows]
        for link, rows in shapes.items()
        if mirrored(link) != link
    }
    return {**shapes, **right}


def _shape(link: str, i: int, shape: list[Any]) -> dict[str, str]:
    kind, radius, *points = shape
    finger = "Finger" in link or "Thumb" in link
    style = ("left_finger" if link[0] == "L" else "right_finger") if finger else "collision"
    place = {"fromto": numbers(np.ravel(points))} if kind == "capsule" else {"type": kind, "pos": numbers(points[0])}
    return {"name": f"{link}_collision_{i}", "class": style, "size": numbers(radius), **place}


def _sole(facts: Mapping[str, Any], thickness: float, side: str) -> dict[str, str]:
    """The documented foot box as a plate whose underside is the documented foot height."""
    (x0, x1), (y0, y1) = facts["foot"][f"box_{side}_m"]["x"], facts["foot"][f"box_{side}_m"]["y"]
    centre = (x0 + x1) / 2, (y0 + y1) / 2, thickness / 2 - facts["foot_height_m"]
    half = (x1 - x0) / 2, (y1 - y0) / 2, thickness / 2
    return {"name": f"{side}_sole", "class": "sole", "pos": numbers(centre), "size": numbers(half)}


def _name(documented: str) -> str:
    """The vendor's sensor names have slashes, which dm_control keeps for its own scopes."""
    return documented.replace("/", "_")


def _sites(facts: Mapping[str, Any]) -> dict[str, list[dict[str, str]]]:
    """Cameras and sites by link."""
    found: dict[str, list[dict[str, str]]] = {}

    def add(link: str, name: str, pos: Any, rpy: Any = (0, 0, 0), axes: np.ndarray | None = None, **more: str) -> None:
        turn = rotation(rpy) if axes is None else rotation(rpy) @ axes
        site = {"tag": "site", "name": _name(name), "pos": numbers(pos), **more}
        if not np.allclose(turn, np.eye(3)):
            site["quat"] = numbers(quaternion(turn))
        found.setdefault(link, []).append(site)

    sensors, foot = facts["sensors"], facts["foot"]
    fov = facts["versions"]["v5"]["camera_fov_deg"]["vertical"]
    for name, camera in sensors["cameras"].items():
        add(camera["link"], name, camera["xyz_m"], camera["rpy_rad"], CAMERA_AXES, tag="camera", fovy=numbers(fov))
    for group in ("imu", "touch", "infrared", "microphones"):
        for name, row in sensors[group].items():
            size = {"size": TOUCH_RADIUS} if group == "touch" else {}
            add(row["link"], name, row["xyz_m"], row.get("rpy_rad", (0, 0, 0)), **size)
    for name, row in sensors["sonar"].items():
        if isinstance(row, dict):
            add("torso", f"Sonar/{name}", row["xyz_m"], row["rpy_rad"], RANGEFINDER_AXES)
    for name, (x, y) in foot["fsr_m"].items():
        # each site is the quarter of the sole whose pressure its sensor takes up
        link = "l_ankle" if name.startswith("L") else "r_ankle"
        place = (x, y, -facts["foot_height_m"])
        add(link, name, place, type="box", size="0.045 0.0265 0.006", rgba="0.9 0.3 0.3 0.3")
    for name, row in facts["hand"]["touch"].items():
        add(row["link"], name, row["xyz_m"], row["rpy_rad"], size=TOUCH_RADIUS)
    for name, row in foot["bumpers"].items():
        # half of the toe, up to the front edge of the sole but not down to the floor
        add(
            row["link"],
            name,
            row["xyz_m"],
            row["rpy_rad"],
            type="box",
            size="0.026 0.0315 0.0095",
            rgba="0.9 0.6 0.2 0.3",
        )
    for side in "LR":
        for finger in FINGERTIPS:
            add(side + finger, f"{side}{finger.removesuffix('_link')}/Tip", (0.0185, 0.0, 0.0), size="0.003")
    for name, link in EFFECTORS.items():
        add(link, name, _effector(facts, name), size="0.006", rgba="0.2 0.8 0.3 1")
    return found


def _effector(facts: Mapping[str, Any], name: str) -> Any:
    """NAOqi's effector frames: the hand's at HandOffset, the others at their last joint."""
    hands = {joint["name"]: joint["origin_m"] for joint in facts["joints"] if joint["name"].endswith("Hand")}
    return hands.get(name.replace("Arm", "Hand"), (0.0, 0.0, 0.0))


def _contacts(root: ET.Element, collision: Mapping[str, Any]) -> None:
    contact = ET.SubElement(root, "contact")
    for first, second in exclusions(collision):
        ET.SubElement(contact, "exclude", name=f"{first}-{second}", body1=first, body2=second)


def exclusions(collision: Mapping[str, Any]) -> list[tuple[str, str]]:
    """All excluded pairs of links: the table's, their mirror images, and each hand with its own fingers."""
    pairs = [(first, second) for first, second, _ in collision["exclusions"]]
    pairs += [("l_wrist", link) for link in collision["shapes"] if "Finger" in link or "Thumb" in link]
    pairs += [(mirrored(first), mirrored(second)) for first, second in pairs if mirrored(first) != mirrored(second)]
    return list(dict.fromkeys(pairs))


def _couplings(root: ET.Element, facts: Mapping[str, Any]) -> None:
    """One motor turns both HipYawPitch joints, one motor closes all fingers of a hand."""
    equality = ET.SubElement(root, "equality")
    rows = [(j["name"], j["driven_by"], 1.0) for j in facts["joints"] if "driven_by" in j]
    rows += [(f["name"], f["driven_by"], f["multiplier"]) for f in facts["hand"]["finger_joints"]]
    for joint, driver, ratio in rows:
        attributes = {"name": joint, "joint1": joint, "joint2": driver, "polycoef": f"0 {numbers(ratio)} 0 0 0"}
        ET.SubElement(equality, "joint", attributes, solref="0.008 1", solimp="0.99 0.999 0.001")


def _actuators(root: ET.Element, facts: Mapping[str, Any], gains: Mapping[str, Mapping[str, float]]) -> None:
    actuator = ET.SubElement(root, "actuator")
    for joint in facts["joints"]:
        if "driven_by" in joint:
            continue
        name, row = joint["name"], gains[joint["name"]]
        ET.SubElement(
            actuator,
            "position",
            name=name,
            joint=name,
            kp=numbers(row["kp"]),
            kv=numbers(row["kv"]),
            ctrlrange=numbers((joint["lower"], joint["upper"])),
            forcerange=numbers((-row["force"], row["force"])),
        )


def _sensors(root: ET.Element, facts: Mapping[str, Any]) -> None:
    sensor = ET.SubElement(root, "sensor")
    ET.SubElement(sensor, "gyro", name="Gyrometer", site="Gyrometer")
    ET.SubElement(sensor, "accelerometer", name="Accelerometer", site="Accelerometer")
    for name in facts["foot"]["fsr_m"]:
        ET.SubElement(sensor, "touch", name=name, site=name)
    for name, row in facts["sensors"]["sonar"].items():
        if isinstance(row, dict):
            ET.SubElement(sensor, "rangefinder", name=f"Sonar_{name}", site=f"Sonar_{name}", cutoff="3")
    touched = (*facts["sensors"]["touch"], *facts["hand"]["touch"], *facts["foot"]["bumpers"])
    for name in map(_name, touched):
        ET.SubElement(sensor, "touch", name=name, site=name)
    for quantity in ("jointpos", "jointvel"):
        for joint in facts["joints"]:
            ET.SubElement(sensor, quantity, name=f"{joint['name']}_{quantity[5:]}", joint=joint["name"])


def _keyframes(root: ET.Element, facts: Mapping[str, Any]) -> None:
    """The vendor's postures where they rest on the floor (base poses from keyframes.json)."""
    bases = table("keyframes.json")["base_pose"]
    order = [element.get("name") for element in root.iter("joint") if element.get("range")]
    driven = {f["name"]: (f["driven_by"], f["multiplier"]) for f in facts["hand"]["finger_joints"]}
    keyframe = ET.SubElement(root, "keyframe")
    for posture, angles in facts["postures"].items():
        qpos = list(bases[posture])
        for name in order:
            driver, ratio = driven.get(name, (name, 1.0))
            qpos.append(ratio * angles[driver])
        ctrl = [angles[a.get("name")] for a in root.find("actuator") or ()]
        ET.SubElement(keyframe, "key", name=posture, qpos=numbers(qpos, 7), ctrl=numbers(ctrl, 7))


if __name__ == "__main__":
    print(build(table("gains.json")["v5"]))
    print(MODEL)
