"""The pictures of the gallery: what each shows, and the commands that make it."""

from __future__ import annotations

from dataclasses import dataclass

GREETING = "trajectories/greeting.csv"
PERSON, STRESS, USERS = "trajectories/person_wave.csv", "trajectories/stress.csv", "trajectories/thesis_users.csv"
CAMERAS = ("front", "three-quarter", "side", "top", "orbit")
DRESSES = (
    ("studio", "orange"),
    ("classroom", "blue"),
    ("lab", "grey"),
    ("studio", "green"),
    ("classroom", "orange"),
    ("lab", "night"),
)


@dataclass(frozen=True)
class Shot:
    """A picture of the gallery.

    Attributes:
        name: its file; .webp is drawn by the renderer, .png by the plotter.
        title: of its paragraph.
        caption: what one sees.
        commands: `nao-sim` commands that write its parts, in order.
        parts: the files that they write and that are put side by side.
        moments: s; of a folder of frames, the parts.
        loop: s; of a folder of frames, from when to when it is shown as a
            film, again and again.
        words: below each part, if any.
        columns: how many parts stand side by side.
        width: pixels to which a part is made smaller, if it is wider.
    """

    name: str
    title: str
    caption: str
    commands: tuple[str, ...]
    parts: tuple[str, ...] = ("picture.png",)
    moments: tuple[float, ...] = ()
    loop: tuple[float, float] | None = None
    words: tuple[str, ...] = ()
    columns: int | None = None
    width: int | None = None


FPS = 10  # of films from which moments are taken
FRAMES = f"--fps {FPS} --quality fine --video frames.png"

SHOTS = (
    Shot(
        "imitation.webp",
        "A person moves, the robot does the same",
        "A person, drawn as a stick figure, waves, points and opens both arms; the robot beside does the same.",
        (f"play {PERSON} --size 480x360 {FRAMES}",),
        ("frames",),
        loop=(1.6, 9.2),
    ),
    Shot(
        "person_wave.webp",
        "A person beside the robot",
        "Two moments of a film: the person waves, then opens both arms; the robot does the same.",
        (f"still {PERSON} --at 2.5 --at 6.9 --size 484x364 -o picture.png",),
    ),
    Shot(
        "gestures.webp",
        "Gestures, named in the film",
        "The robot on the left imitates every frame; the one on the right plays the gestures that a caption names.",
        (f"play {PERSON} --mode both --size 484x364 {FRAMES}",),
        ("frames",),
        (3.5, 6.6),
    ),
    Shot(
        "safety.webp",
        "What the guard changes",
        "Legs that would make the robot fall are violet, joints asked to be too fast amber, arms about to hit it red.",
        (f"still {STRESS} --show-safety --at 8 --at 10 --at 11 --at 13 --size 400x300 -o picture.png",),
    ),
    Shot(
        "views.webp",
        "Cameras",
        "From the front, from three quarters, from the side, from above, and on the way round.",
        tuple(f"still {GREETING} --at 5.2 --camera {name} --size 300x380 -o {name}.png" for name in CAMERAS),
        tuple(f"{name}.png" for name in CAMERAS),
        words=tuple(f"--camera {name}" for name in CAMERAS),
    ),
    Shot(
        "looks.webp",
        "Looks and themes",
        "The same moment in a studio, a classroom and a laboratory, and in the five colours of the robot.",
        tuple(
            f"still {GREETING} --at 1.8 --look {look} --theme {theme} --size 400x300 -o {look}_{theme}.png"
            for look, theme in DRESSES
        ),
        tuple(f"{look}_{theme}.png" for look, theme in DRESSES),
        words=tuple(f"--look {look} --theme {theme}" for look, theme in DRESSES),
        columns=3,
    ),
    Shot(
        "compare.webp",
        "What was requested, beside what is safe",
        "On the left the hands are inside the chest, as a recording asks; on the right they keep off it.",
        (f"still {STRESS} --at 11 --arrange compare --overlay all --size 968x440 -o picture.png",),
    ),
    Shot(
        "arrangements.webp",
        "Layouts",
        "The person behind the robot; and beside it, with what the robot sees in a corner and the time below.",
        (
            f"still {PERSON} --at 2.5 --arrange behind --size 484x364 -o behind.png",
            f"still {PERSON} --at 2.5 --arrange eyes --overlay labels --look lab --size 484x364 -o eyes.png",
        ),
        ("behind.png", "eyes.png"),
        words=("--arrange behind", "--arrange eyes --overlay labels --look lab"),
    ),
    Shot(
        "key_poses.webp",
        "The poses that differ most",
        "The six moments of a recording whose poses differ most, with their times.",
        (f"still {PERSON} --sheet 6 --size 360x280 -o picture.png",),
    ),
    Shot(
        "dictionary.webp",
        "A dictionary of gestures",
        "Every gesture that the robot knows, at the pose that is farthest from rest; as PDF it is a page to print.",
        ("dictionary --columns 5 --size 220x250 -o picture.png",),
    ),
    Shot(
        "inspect.png",
        "What a recording holds",
        "Stick figures of the skeleton as it was understood, and how well each joint was seen.",
        (f"inspect {PERSON} --plot picture.png",),
        width=1000,
    ),
    Shot(
        "check.png",
        "What was asked, and what was commanded",
        "Requested (dashed) and commanded angles; coloured lanes say when and why the guard changed a joint.",
        (f"check {PERSON} --plot picture.png",),
        width=1000,
    ),
    Shot(
        "similarity.png",
        "How alike the robot was",
        "How far the robot's arms are from where the person's point, at every stage, and two measures of similarity.",
        (f"play {PERSON} --no-video --rollout out.npz", f"compare {PERSON} out.npz --plot picture.png"),
        width=1000,
    ),
    Shot(
        "recognised.png",
        "Gestures over time",
        "What is recognised in a recording, and when.",
        (f"recognise {PERSON} --plot picture.png",),
        width=1000,
    ),
    Shot(
        "confusion.png",
        "What strangers' gestures are taken for",
        "Five poses of six people; each is judged by what was learned from the five others.",
        (f"evaluate {USERS} -o evaluation",),
        ("evaluation/poses_confusion.png",),
        width=1000,
    ),
)
