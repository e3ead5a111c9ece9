"""Which awkward BVH files are read right, ours and other readers' side by side; and how fast a large file is read.

    python benchmarks/bvh_peers.py            # the table of awkward files
    python benchmarks/bvh_peers.py --large    # 11,008 frames of 96 channels: CPU seconds, memory, round trip

"right": frames, rate, joint names and the position of each joint in each frame agree with matrices made from the file's
own numbers. A file that has to be refused is right when an error is raised. A reader has ten seconds a file.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import multiprocessing
import signal
import statistics
import sys
import tempfile
import time
import tracemalloc
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from awkward import CASES, Case, Spec, turns

Seen = tuple[list[str], np.ndarray, float]
"""Joint names, (F, J, 3) positions in the file's unit and axes, frames a second."""
FRAMES, CHANNELS, RUNS = 11_008, 96, 5


def onbeat(path: str) -> Seen:
    from onbeat.formats import read_motion

    motion = read_motion(path, up="z", unit="m")
    kept = ~motion.skeleton.end_sites
    return [n for n, k in zip(motion.skeleton.names, kept, strict=True) if k], motion.positions[:, kept], motion.fps


def pymotion(path: str) -> Seen:
    from pymotion.io.bvh import BVH

    bvh = BVH()
    bvh.load(path)
    d = bvh.data
    rotations = []
    for joint, order in enumerate(d["rot_order"]):
        turn = np.eye(3)[None]
        for axis, column in zip(order, np.radians(d["rotations"][:, joint]).T, strict=True):
            turn = turn @ turns("xyz".index(axis), column)
        rotations.append(turn)
    parents = [-1, *np.asarray(d["parents"])[1:].tolist()]
    places = [np.asarray(d["positions"])[:, joint] for joint in range(len(parents))]
    return [str(n) for n in d["names"]], _placed(parents, rotations, places), 1 / float(d["frame_time"])


def bvhio(path: str) -> Seen:
    import bvhio

    container = bvhio.readAsBvh(path)
    joints = [joint for joint, _, _ in container.Root.layout()]
    root = bvhio.convertBvhToHierarchy(container.Root)
    placed = [joint for joint, _, _ in root.layout()]
    positions = np.empty((container.FrameCount, len(placed), 3))
    for frame in range(container.FrameCount):
        root.loadPose(frame, recursive=True)
        positions[frame] = [[*joint.PositionWorld] for joint in placed]
    return [joint.Name for joint in joints], positions, 1 / container.FrameTime


def _by_channels(tree: Any, names: list[str]) -> Seen:
    """Readers that give channels as text."""
    frames = np.array([[float(v) for v in frame] for frame in tree.frames])
    if len(frames) != tree.nframes:
        raise ValueError("its count of frames is not its frames")
    rotations, places, parents, at = [], [], [], 0
    for name in names:
        place, turn = np.tile(np.array(tree.joint_offset(name), float), (len(frames), 1)), np.eye(3)[None]
        for channel in tree.joint_channels(name):
            axis = "XYZ".index(channel[0])
            if channel[1:] == "position":
                place[:, axis] = frames[:, at]
            elif channel[1:] == "rotation":
                turn = turn @ turns(axis, np.radians(frames[:, at]))
            else:
                raise ValueError(channel)
            at += 1
        rotations.append(turn)
        places.append(place)
        parents.append(tree.joint_parent_index(name))
    if at != frames.shape[1]:
        raise ValueError("numbers are left over")
    return names, _placed(parents, rotations, places), 1 / float(tree.frame_time)


def bvh(path: str) -> Seen:
    from bvh import Bvh

    with open(path) as file:
        tree = Bvh(file.read())
    return _by_channels(tree, tree.get_joints_names())


def bvhtoolbox(path: str) -> Seen:
    from bvhtoolbox import BvhTree

    with open(path) as file:
        tree = BvhTree(file.read())
    return _by_channels(tree, tree.get_joints_names())


READERS: tuple[Callable[[str], Seen], ...] = (onbeat, pymotion, bvhio, bvh, bvhtoolbox)


def _placed(parents: list[int], rotations: list[np.ndarray], places: list[np.ndarray]) -> np.ndarray:
    world: list[np.ndarray] = []
    found: list[np.ndarray] = []
    for parent, turn, place in zip(parents, rotations, places, strict=True):
        if parent < 0:
            world.append(np.broadcast_to(turn, (len(place), 3, 3)))
            found.append(place)
        else:
            world.append(world[parent] @ turn)
            found.append(found[parent] + np.einsum("fij,fj->fi", world[parent], place))
    return np.stack(found, axis=1)


def verdict(reader: Callable[[str], Seen], case: Case, path: Path) -> str:
    """What a reader makes of a file."""
    path.write_bytes(case.data)
    signal.alarm(10)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            names, positions, fps = reader(str(path))
    except TimeoutError:
        return "hangs"
    except Exception as error:  # whatever a reader raises, it does not read the file
        return "right" if case.spec is None else f"fails: {type(error).__name__}"
    finally:
        signal.alarm(0)
    if case.spec is None:
        return "WRONG: reads it"
    return _compared(case.spec, names, positions, fps)


def _compared(spec: Spec, names: list[str], positions: np.ndarray, fps: float) -> str:
    wanted = [name for name, _, _, _ in spec.rows if name]
    truth = np.stack([spec.truth[name] for name in wanted], axis=1)
    if positions.shape != truth.shape:
        return f"WRONG: {positions.shape[0]} frames, {positions.shape[1]} joints"
    if not np.allclose(positions, truth, atol=1e-2):  # bvhio works with 32-bit floats
        return "WRONG: positions"
    if abs(fps / spec.fps - 1) > 1e-3:
        return f"WRONG: {fps:g} frames a second"
    twins = len(set(names)) < len(names) or "LeftArm_2" in wanted
    return "right" if names == wanted or twins else "WRONG: names"


def _stop(*_: object) -> None:
    raise TimeoutError


def _all_of(reader: Callable[[str], Seen], pipe: Any) -> None:
    signal.signal(signal.SIGALRM, _stop)
    with tempfile.TemporaryDirectory() as folder:
        for number, case in enumerate(CASES):
            pipe.send((number, verdict(reader, case, Path(folder, "a.bvh"))))
    pipe.close()


def judged(reader: Callable[[str], Seen]) -> list[str]:
    """A reader's verdicts, in a process of its own."""
    if importlib.util.find_spec(reader.__name__) is None:
        return ["not installed"] * len(CASES)
    found = ["crashes"] * len(CASES)
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_all_of, args=(reader, theirs))
    process.start()
    theirs.close()
    while True:
        try:
            number, word = ours.recv()
        except EOFError:
            break
        found[number] = word
    process.join()
    return found


def awkward_table() -> None:
    columns = [judged(reader) for reader in READERS]
    width = max(len(case.name) for case in CASES) + 2
    print(f"{'':{width}}" + "".join(f"{reader.__name__:26}" for reader in READERS))
    for number, case in enumerate(CASES):
        name = case.name if case.spec else f"{case.name} *"
        print(f"{name:{width}}" + "".join(f"{column[number]:26.25}" for column in columns))
    print(f"{'right of ' + str(len(CASES)):{width}}" + "".join(f"{column.count('right'):<26}" for column in columns))
    print("* has to be refused")


def large_file(path: Path) -> None:
    """31 joints in chains, 96 channels."""
    rows = [("j0", "", (0.0, 0.0, 0.0), "Xp Yp Zp Zr Xr Yr")]
    for number in range(1, 31):
        parent = "j0" if number % 6 == 1 else f"j{number - 1}"
        rows.append((f"j{number}", parent, (float(number % 3), 20.0, 1.0), "Zr Xr Yr"))
    spec = Spec(tuple(rows), frame_time="0.008333", fps=120, frames=FRAMES, large=80.0, digits=6)
    assert spec.values.shape == (FRAMES, CHANNELS)
    path.write_text(spec.text)


def _cpu(call: Callable[[], Any]) -> float:
    spent = []
    for _ in range(RUNS):
        start = time.process_time()
        call()
        spent.append(time.process_time() - start)
    return statistics.median(spent)


def large_table() -> None:
    from pymotion.io.bvh import BVH

    from onbeat.formats import read_motion, write_motion

    with tempfile.TemporaryDirectory() as folder:
        path, again = Path(folder, "large.bvh"), Path(folder, "again.bvh")
        large_file(path)
        print(
            f"{FRAMES} frames of {CHANNELS} channels, {path.stat().st_size / 1e6:.1f} MB; median of {RUNS} runs, CPU s"
        )
        array = FRAMES * CHANNELS * 8
        reads, theirs = [], []
        for _ in range(3):  # in turns, so that a change of the machine's speed meets both
            reads.append(_cpu(lambda: read_motion(path)))
            theirs.append(_cpu(lambda: BVH().load(str(path))))
        read, peer = statistics.median(reads), statistics.median(theirs)
        motion = read_motion(path)
        write = _cpu(lambda: write_motion(motion, again))
        print(f"onbeat reads   {read:.3f}   {read / peer:.2f} of pymotion's")
        print(f"pymotion reads {peer:.3f}")
        print(f"onbeat writes  {write:.3f}   {write / read:.2f} of reading")
        tracemalloc.start()
        read_motion(path)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        print(f"peak memory    {peak / 1e6:.1f} MB traced, {peak / array:.2f} of the array; "
              f"{_grown(path) / array:.2f} as the process grows")  # fmt: skip
        same = (
            path.read_text().split("Frame Time")[1].split("\n", 1)[1]
            == (again.read_text().split("Frame Time")[1].split("\n", 1)[1])
        )
        print(f"round trip     {'every printed digit is the same' if same else 'DIFFERS'}")


def _grown(path: Path) -> int:
    """Bytes by which a fresh process grows that reads the file."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(_growth, (str(path),))


def _growth(path: str) -> int:
    from onbeat.formats import read_motion

    with tempfile.TemporaryDirectory() as folder:  # once before, so that what is imported and kept does not count
        small = Path(folder, "small.bvh")
        small.write_bytes(CASES[0].data)
        read_motion(small)
    before = _highest()
    read_motion(path)
    return _highest() - before


def _highest() -> int:
    """Bytes this process has held at most; unlike ``ru_maxrss`` it begins anew with each program (Linux)."""
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1]) * 1024


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--large", action="store_true", help="the large file instead of the awkward ones")
    parser.add_argument("--json", action="store_true", help="verdicts as JSON")
    options = parser.parse_args()
    if options.large:
        large_table()
    elif options.json:
        verdicts = {r.__name__: dict(zip([c.name for c in CASES], judged(r), strict=True)) for r in READERS}
        print(json.dumps(verdicts, indent=1))
    else:
        awkward_table()


if __name__ == "__main__":
    main()
