"""Files that are made to hurt, each given to ``onbeat info`` as a user would: seconds, peak memory, exit code, message.

    python benchmarks/hostile.py [--folder DIR]     # writes and removes 3 GB there, by default in the temporary folder

Wanted: exit code 1, one line on stderr, under 2 s and 500 MB, of which a fresh Python with NumPy takes most.
"""

from __future__ import annotations

import argparse
import io
import os
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from persons import AMC, ASF, BVH

SPACES = 3 * 10**9
SECONDS, MEGABYTES = 2.0, 500


def _spaces(path: Path, before: bytes = b"", after: bytes = b"") -> None:
    block = b" " * (1 << 24)
    with path.open("wb") as file:
        file.write(before)
        for _ in range(SPACES // len(block)):
            file.write(block)
        file.write(after)


def _npz(path: Path, **changed: object) -> None:
    kept: dict[str, object] = {
        "onbeat_motion": 1,
        "names": np.array(["a", "b"]),
        "parents": np.array([-1, 0]),
        "offsets": np.zeros((2, 3)) + 0.1,
        "end_sites": np.zeros(2, bool),
        "rotations": np.tile([1.0, 0, 0, 0], (3, 2, 1)),
        "root_positions": np.zeros((3, 3)),
        "fps": 30.0,
        "name": np.array("x"),
    }
    np.savez(path, **{**kept, **changed})  # type: ignore[arg-type]


def _bomb(path: Path) -> None:
    """4 GB of zeros in 4 MB, as the rotations of a motion."""
    head = io.BytesIO()
    shape = (4 * 10**9 // 64, 2, 4)
    np.lib.format.write_array_header_1_0(head, {"descr": "<f8", "fortran_order": False, "shape": shape})
    _npz(path)
    with zipfile.ZipFile(path) as file:
        members = {name: file.read(name) for name in file.namelist() if name != "rotations.npy"}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, data in members.items():
            file.writestr(name, data)
        with file.open("rotations.npy", "w", force_zip64=True) as member:
            member.write(head.getvalue())
            block = bytes(1 << 24)
            for _ in range(shape[0] * 64 // len(block)):
                member.write(block)


def _nested_pickle(path: Path) -> None:
    path.write_bytes(b"\x80\x02" + b"]" * 10**6 + b"a" * (10**6 - 1) + b".")


def _amc(path: Path, text: str = AMC) -> None:
    path.with_suffix(".asf").write_text(ASF)
    path.write_text(text)


def _spaces_amc(path: Path) -> None:
    path.with_suffix(".asf").write_text(ASF)
    _spaces(path, AMC.encode())


NAN = np.tile([1.0, 0, 0, 0], (3, 2, 1))
NAN[1, 1] = np.nan
FILES: tuple[tuple[str, str, Callable[[Path], object]], ...] = (
    ("10⁹ frames promised", "a.bvh", lambda p: p.write_text(BVH.replace("Frames: 2", "Frames: 1000000000"))),
    ("3 GB of spaces", "a.bvh", _spaces),
    ("3 GB of spaces after MOTION", "a.bvh", lambda p: _spaces(p, BVH.split("1.0 90.0")[0].encode())),
    ("3 GB of spaces", "a.amc", _spaces_amc),
    ("3 GB of spaces", "a.trc", _spaces),
    ("3 GB of spaces", "a.csv", _spaces),
    ("3 GB of spaces", "a.c3d", _spaces),
    ("3 GB of spaces", "a.npz", _spaces),
    ("3 GB of spaces", "a.pkl", _spaces),
    ("a NaN rotation", "a.bvh", lambda p: p.write_text(BVH.replace("51.0", "nan"))),
    ("a NaN rotation", "a.amc", lambda p: _amc(p, AMC.replace("9e1", "nan"))),
    ("a NaN rotation", "a.npz", lambda p: _npz(p, rotations=NAN)),
    ("a cyclic hierarchy", "a.npz", lambda p: _npz(p, parents=np.array([-1, 1]))),
    ("a zip bomb", "a.npz", _bomb),
    ("objects to unpickle", "a.npz", lambda p: _npz(p, rotations=np.array([{}, print], object))),
    ("a pickle of a command", "a.pkl", lambda p: p.write_bytes(b"cos\nsystem\n(S'echo harm > harm'\ntR.")),
    ("a million nested lists", "a.pkl", _nested_pickle),
    ("a million braces", "a.bvh", lambda p: p.write_text("HIERARCHY\nROOT a\n" + "{\n" * 10**6 + "MOTION\n")),
    ("a word of 100 MB", "a.bvh", lambda p: p.write_text(BVH.replace("71.0", "1" * 10**8))),
    ("a name of 10 MB", "a.bvh", lambda p: p.write_text(BVH.replace("JOINT Leg", "JOINT " + "x" * 10**7))),
)

PROGRAM = """
import sys
from onbeat.cli import main
try:
    sys.argv = ["onbeat", "info", sys.argv[1]]
    main()
finally:
    line = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
    print("PEAK", int(line.split()[1]) // 1024)
"""


def tried(folder: Path) -> Iterator[tuple[str, float, int, int, str]]:
    """Name, seconds, megabytes, exit code and message of each file."""
    for name, file, make in FILES:
        path = folder / file
        make(path)
        start = time.monotonic()
        words = [sys.executable, "-c", PROGRAM, str(path)]
        found = subprocess.run(words, capture_output=True, text=True, timeout=300, check=False, cwd=folder)
        seconds = time.monotonic() - start
        peak = int(found.stdout.split("PEAK ")[-1]) if "PEAK " in found.stdout else -1
        yield f"{name}, {path.suffix}", seconds, peak, found.returncode, found.stderr.strip()
        for made in folder.iterdir():
            made.unlink()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, help="where the files are made")
    options = parser.parse_args()
    bad = 0
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        subprocess.run([sys.executable, "-c", "import onbeat.cli.info"], check=True, env={**os.environ})  # warm caches
        for name, seconds, peak, code, message in tried(Path(folder)):
            good = code == 1 and message.count("\n") == 0 and seconds < SECONDS and peak < MEGABYTES
            bad += not good
            print(f"{name:36} {seconds:5.2f} s {peak:5} MB  exit {code}  {'' if good else 'NOT SO: '}"
                  f"{message.replace(folder + '/', '')[:150]}")  # fmt: skip
    print("all as wanted" if not bad else f"{bad} not as wanted")
    sys.exit(bool(bad))


if __name__ == "__main__":
    main()
