"""Measure `nao-sim live` through real WebSockets, and note the tables in RESULTS.md.

    python benchmarks/live.py RECORDINGS [latency] [lag] [load] [soak] [--soak MINUTES] [--note]

A server of its own process plays robots; people are recordings, sent at 30
frames a second in MediaPipe's or Kinect's order as JSON.

latency: from just before a frame is sent to when the first command that knows
of it has arrived, on one clock.  The robot's commands go out 50 times a second,
so a frame waits for the next one up to 20 ms; `ready` leaves that wait out: a
ping sent behind the frame is answered when the frame has become a request.

`computing` is the processor time of the same in one process without sockets: to
read a frame and make it a request, and to guard it and write the command.  It
is what remains where nothing else runs, and hardly depends on what else does.

lag: how much later the simulated arms do what the person's arms do, by
cross-correlation of their directions (`similarity_measures.delay`), on the
person's own clock, where nothing takes any time (an idle machine) and through a
WebSocket on this one.  Jitter is the rms third difference of arm angles over 20
ms: of what the raw frames ask, of what the filtered ones ask, of the commands
and of the robot.

load: people at once; a connection keeps its rate where 49 states a second
arrive.

soak: memory of the server's processes, and how far the robot's clock runs from
the wall's, at the beginning and at the end.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from benchmark import Rows, machine, note
from websockets.asyncio.client import connect

from nao_sim.imitation.retarget import one_to_one
from nao_sim.imitation.similarity_body import person_body, robot_body
from nao_sim.imitation.similarity_measures import delay
from nao_sim.live.host import Host, Inward
from nao_sim.live.moment import World
from nao_sim.live.person import layouts
from nao_sim.live.protocol import Hello
from nao_sim.live.worker import Orders, world_of
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.processors import processors
from nao_sim.recordings import load
from nao_sim.recordings.skeletons.layouts import axis
from nao_sim.robot import LEGS, load_robot

RATE, STEP = 30.0, 0.02
LAYOUT = "kinect_v2"
PEOPLE = (
    "labanotation_kinect/samples/Ges03_drawlines.csv",
    "labanotation_kinect/samples/Ges01_wavehand.csv",
    "isl_kinect_signs/samples/hello_s03_1.txt",
    "cmu_mocap6/amc/13_30.amc",
)
SECONDS = 12.0
KEPT_RATE = 49.0
AIMS = {"median": 5.0, "p99": 15.0, "lag": 120.0, "connections": 8}


@dataclass
class Heard:
    """What came back for one person: states, and for each frame when it was sent, ready and first commanded."""

    states: list[tuple[float, dict]] = field(default_factory=list)
    commands: list[tuple[float, dict]] = field(default_factory=list)
    sent: dict[float, float] = field(default_factory=dict)
    ready: dict[float, float] = field(default_factory=dict)


def at_thirty(path: Path) -> Skeleton:
    """A recording at 30 Hz, in a loop to and fro until it lasts."""
    motion = load(path).motion
    assert isinstance(motion, Skeleton)
    times = np.arange(0.0, float(motion.times[-1] - motion.times[0]), 1.0 / RATE) + motion.times[0]
    rows = np.clip(np.searchsorted(motion.times, times), 0, len(motion) - 1)
    there_and_back = np.concatenate([rows, rows[-2:0:-1]])
    many = np.tile(there_and_back, int(np.ceil(SECONDS * RATE / len(there_and_back))))[: int(SECONDS * RATE)]
    return Skeleton(np.arange(len(many)) / RATE, motion.positions[many], motion.joints)


def texts(person: Skeleton) -> list[str]:
    """The points of each frame as JSON, in the layout's order and axes."""
    known = layouts()[LAYOUT]
    assert known.axes is not None
    axes = np.stack([axis(signed) for signed in known.axes])
    tracks = np.stack([person.track(joint) for joint in known.joints], axis=1) @ axes
    rows = [[None if np.isnan(point).any() else np.round(point, 5).tolist() for point in frame] for frame in tracks]
    return [json.dumps(row) for row in rows]


@asynccontextmanager
async def server(*words: str):
    """A server; its address and the process ids of it and its workers."""
    command = [sys.executable, "-m", "nao_sim.cli", "live", "--port", "0", *words]
    process = await asyncio.create_subprocess_exec(*command, stdout=subprocess.PIPE, env=os.environ)
    assert process.stdout
    first = (await process.stdout.readline()).decode()
    found = re.search(r"ws://\S+/live", first)
    assert found, f"no address in {first!r}"
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text(encoding="utf-8").split()
    try:
        yield found[0], [process.pid, *map(int, children)]
    finally:
        process.terminate()
        await process.wait()


async def imitated(url: str, points: Sequence[str], seconds: float, pings: bool = False) -> Heard:
    """Send a person's frames for a while; what came back."""
    heard, loop = Heard(), asyncio.get_running_loop()
    async with connect(url, compression=None) as socket:
        await socket.send(json.dumps({"type": "hello", "layout": LAYOUT}))
        session = json.loads(await socket.recv())["session"]

        async def commanded() -> None:
            async with connect(url, compression=None) as robot:
                await robot.send(json.dumps({"type": "hello", "role": "robot", "session": session}))
                await robot.recv()
                async for text in robot:
                    heard.commands.append((time.monotonic(), json.loads(text)))

        async def listen() -> None:
            async for text in socket:
                now, message = time.monotonic(), json.loads(text)
                if message["type"] == "state":
                    heard.states.append((now, message))
                elif message["type"] == "pong":
                    heard.ready[message["echo"]] = now

        listening = [loop.create_task(job) for job in ((listen(), commanded()) if pings else (listen(),))]
        began = time.monotonic()
        for number in range(int(seconds * RATE)):
            await asyncio.sleep(max(began + number / RATE - time.monotonic(), 0.0))
            stamp = round(number / RATE, 6)
            heard.sent[stamp] = time.monotonic()
            await socket.send(f'{{"type":"frame","time":{stamp},"points":{points[number % len(points)]}}}')
            if pings:
                await socket.send(f'{{"type":"ping","echo":{stamp}}}')
        await asyncio.sleep(0.2)
        for job in listening:
            job.cancel()
    return heard


def cpu_s(pids: Sequence[int]) -> float:
    """Seconds of processor time that processes have used."""
    used = (Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split() for pid in pids)
    return sum(int(each[11]) + int(each[12]) for each in used) / os.sysconf("SC_CLK_TCK")


def memory_mb(pids: Sequence[int]) -> float:
    """Resident memory of processes."""
    pages = (int(Path(f"/proc/{pid}/statm").read_text(encoding="utf-8").split()[1]) for pid in pids)
    return sum(pages) * os.sysconf("SC_PAGE_SIZE") / 2**20


def command_ms(heard: Heard) -> np.ndarray:
    """Milliseconds from each frame to the first command (state, where no commands are heard) that knows of it."""
    first: dict[float, float] = {}
    for when, message in heard.commands or heard.states:
        if message["frame_time"] is not None:
            first.setdefault(message["frame_time"], when)
    return 1000.0 * np.array([first[stamp] - sent for stamp, sent in heard.sent.items() if stamp in first])


def percentiles(values: np.ndarray) -> tuple[str, str]:
    """Median and 99th percentile."""
    return tuple(f"{value:.1f}" for value in np.percentile(values, (50, 99)))  # type: ignore[return-value]


def computing(world: World, points: Sequence[str], seconds: float) -> np.ndarray:
    """Milliseconds of processor time from each frame to the command after it, without waiting."""
    host, took = Host(world), []
    host.take([Inward("a", "open", hello=Hello(layout=LAYOUT))], 0.0)
    due = 0.0
    for number in range(int(seconds * RATE)):
        now = number / RATE
        while due + STEP <= now:
            due += STEP
            host.step(due)
        text = f'{{"type":"frame","time":{now:.6f},"points":{points[number % len(points)]}}}'
        ends: list[float] = []
        began = time.thread_time()
        host.take([Inward("a", "message", text, now)], now)
        due += STEP
        host.step(due, lambda _, ends=ends: ends.append(time.thread_time()))  # type: ignore[misc]
        if ends:
            took.append(1000.0 * (ends[0] - began))
    return np.array(took[30:])


async def latency(folder: Path) -> tuple[str, Rows]:
    """From a frame to the command, one person alone."""
    rows: Rows = [
        ("recording", "computing: median (ms)", "p99", "ready: median (ms)", "p99", "command out: median (ms)", "p99")
    ]
    every: list[tuple[np.ndarray, ...]] = []
    world = world_of(Orders())
    alone = [computing(world, texts(at_thirty(folder / name)), SECONDS / 2) for name in PEOPLE]
    async with server("--workers", "1") as (url, _):
        for name, cpu in zip(PEOPLE, alone, strict=True):
            heard = await imitated(url, texts(at_thirty(folder / name)), SECONDS, pings=True)
            late = [stamp for stamp in heard.sent if stamp > 1.0]  # it is known by then what the numbers mean
            ready = 1000.0 * np.array([heard.ready[s] - heard.sent[s] for s in late if s in heard.ready])
            every.append((cpu, ready, command_ms(heard)[30:]))
            rows.append((Path(name).name, *(text for each in every[-1] for text in percentiles(each))))
    together = [np.concatenate(values) for values in zip(*every, strict=True)]
    rows.append(("all", *(text for each in together for text in percentiles(each))))
    aims = f"aim {AIMS['median']:g}", f"{AIMS['p99']:g}"
    rows.append(("; ".join(aims), *(text for each in together for text in _met(each))))
    return "Live: from a frame sent to the request ready, and to the first command that knows of it", rows


def _met(values: np.ndarray) -> list[str]:
    found = np.percentile(values, (50, 99))
    return [
        "met" if value <= aim else "missed" for value, aim in zip(found, (AIMS["median"], AIMS["p99"]), strict=True)
    ]


def on_an_idle_machine(world: World, points: Sequence[str], seconds: float) -> Heard:
    """What would come back if nothing took any time: the same robot, stepped at the times when it is due."""
    host, heard, step = Host(world), Heard(), 0
    host.take([Inward("a", "open", hello=Hello(layout=LAYOUT), came=0.0)], 0.0)
    for number in range(int(seconds * RATE)):
        now = number / RATE
        while step * STEP < now:
            heard.states += [(step * STEP, json.loads(o.text)) for o in host.step(step * STEP) if o.kind == "state"]
            step += 1
        text = f'{{"type":"frame","time":{now:.6f},"points":{points[number % len(points)]}}}'
        heard.sent[now] = now
        host.take([Inward("a", "message", text, now)], now)
    return heard


async def lag(folder: Path) -> tuple[str, Rows]:
    """How late and how quiet the robot is."""
    rows: Rows = [
        ("recording", "machine", "requested (ms)", "commanded (ms)", "simulated (ms)", f"aim {AIMS['lag']:g}",
         "jitter raw (mrad)", "requested", "commanded", "simulated")
    ]  # fmt: skip
    world = world_of(Orders())
    idle = [on_an_idle_machine(world, texts(at_thirty(folder / name)), SECONDS) for name in PEOPLE]
    rows += [_late(folder / name, "idle", heard) for name, heard in zip(PEOPLE, idle, strict=True)]
    async with server("--workers", "1") as (url, _):
        for name in PEOPLE:
            heard = await imitated(url, texts(at_thirty(folder / name)), SECONDS)
            rows.append(_late(folder / name, "this", heard))
    return "Live: how late the robot's arms are, and how quiet, against raw frames at 30 Hz", rows


def _late(path: Path, where: str, heard: Heard) -> tuple[str, ...]:
    robot, person = load_robot(), at_thirty(path)
    arms = [i for i in np.flatnonzero(~robot.joints_of("Head", *LEGS)) if "Hand" not in robot.joint_names[i]]
    times = np.array([when - heard.sent[0.0] for when, _ in heard.states])
    on = times > 2.0
    kinds = ("requested", "commanded", "simulated")
    motion = {kind: np.array([state[kind] for _, state in heard.states], float)[on] for kind in kinds}
    late = [delay(person_body(person), robot_body(times[on], motion[kind])) for kind in kinds]
    raw = JointTrajectory(person.times, one_to_one(person, robot)).sample(np.arange(2.0, SECONDS, STEP))
    jitter = [_jitter(each[:, arms]) for each in (raw, *motion.values())]
    done = late[2]
    met = "no delay fits" if done is None else "met" if 1000.0 * done <= AIMS["lag"] else "missed"
    shown = ["-" if each is None else f"{1000.0 * each:.0f}" for each in late]
    return (path.name, where, *shown, met, *(f"{each:.1f}" for each in jitter))


def _jitter(angles: np.ndarray) -> float:
    third = np.diff(angles, n=3, axis=0)
    return float(1000.0 * np.sqrt(np.nanmean(third**2)))


async def loads(folder: Path) -> tuple[str, Rows]:
    """How many people at once a machine serves."""
    points = texts(at_thirty(folder / PEOPLE[0]))
    rows: Rows = [
        ("people", "states a second, worst", "command out: median (ms)", "p99", "CPU a connection (% of a core)",
         "connections a core at that")
    ]  # fmt: skip
    cores, world = processors(), world_of(Orders())
    used = time.thread_time()
    on_an_idle_machine(world, points, SECONDS)
    share = (time.thread_time() - used) / SECONDS
    rows.append(("1, no sockets, no waiting", "50.0", "", "", f"{100.0 * share:.1f}", f"{1.0 / share:.1f}"))
    async with server("--workers", str(cores), "--max-robots", "64") as (url, pids):
        for people in (1, 2, 4, 8, 12, 16):
            used, began = cpu_s(pids), time.monotonic()
            heard = await asyncio.gather(*(_later(i, imitated(url, points, SECONDS)) for i in range(people)))
            share = (cpu_s(pids) - used) / (time.monotonic() - began) / people
            rate = min(len(each.states) / (each.states[-1][0] - each.states[0][0]) for each in heard)
            waits = np.concatenate([command_ms(each)[30:] for each in heard])
            kept = f"{rate:.1f}" + ("" if rate >= KEPT_RATE else " (not kept)")
            rows.append((str(people), kept, *percentiles(waits), f"{100.0 * share:.1f}", f"{1.0 / share:.1f}"))
            if rate < KEPT_RATE:
                break
    return f"Live: people at once (aim: {AIMS['connections']} connections a core at full rate)", rows


async def _later(place: int, work):
    """People do not all begin in the same millisecond."""
    await asyncio.sleep(place * 0.037)
    return await work


async def soak(folder: Path, minutes: float) -> tuple[str, Rows]:
    """Whether memory grows or the clock drifts in a long session."""
    points = texts(at_thirty(folder / PEOPLE[0]))
    rows: Rows = [("minute", "memory (MB)", "robot's clock behind the wall's (ms)", "states a second", "dropped, lost")]
    async with server("--workers", "1") as (url, pids), connect(url, compression=None) as socket:
        await socket.send(json.dumps({"type": "hello", "layout": LAYOUT}))
        await socket.recv()
        began, number, first, count, marks = time.monotonic(), 0, None, 0, np.linspace(0.5, minutes, 6)
        for mark in marks:
            while time.monotonic() - began < 60.0 * mark:
                wait = began + number / RATE - time.monotonic()
                if wait <= 0:
                    row = points[number % len(points)]
                    await socket.send(f'{{"type":"frame","time":{number / RATE:.6f},"points":{row}}}')
                    number += 1
                    continue
                try:
                    message = json.loads(await asyncio.wait_for(socket.recv(), wait))
                except TimeoutError:
                    continue
                if message["type"] == "state":
                    now, count = time.monotonic(), count + 1
                    behind = now - message["time"]
                    first = behind if first is None else first
                    last, frames = behind, message["frames"]
            rate = count / (time.monotonic() - began)
            told = f"{frames['dropped']}, {frames['lost']}"
            drift = f"{1000.0 * (last - first):.0f}"
            rows.append((f"{mark:.1f}", f"{memory_mb(pids):.1f}", drift, f"{rate:.1f}", told))
    return f"Live: one person for {minutes:g} minutes", rows


def main(words: Sequence[str] | None = None) -> None:
    """Measure, print, and note."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", type=Path, help="the folder of shared recordings")
    parser.add_argument("names", nargs="*", metavar="NAME", help="latency, lag, load, soak (default: all)")
    parser.add_argument("--soak", type=float, default=60.0, metavar="MINUTES", help="of a soak (default 60)")
    parser.add_argument("--note", action="store_true", help="add the tables to RESULTS.md")
    args = parser.parse_args(words)
    known = {"latency": latency, "lag": lag, "load": loads, "soak": lambda folder: soak(folder, args.soak)}
    if unknown := set(args.names) - set(known):
        parser.error(f"unknown benchmark {', '.join(sorted(unknown))}; expected any of {', '.join(known)}")
    for name in args.names or known:
        where = machine()
        title, rows = asyncio.run(known[name](args.recordings))  # type: ignore[arg-type]
        more = f" --soak {args.soak:g}" if name == "soak" else ""
        note(title, rows, f"live.py RECORDINGS {name}{more}", where, not args.note)


if __name__ == "__main__":
    main()
