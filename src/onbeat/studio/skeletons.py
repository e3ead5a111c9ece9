"""Skeletons of AMC files: a file that came without its other half waits for it, whichever comes first.

An ASF is for the AMC files that are called as it is or begin so: ``05.asf`` for ``05_01.amc``. One that is called
otherwise belongs to those that it came with, or for which the user chooses it.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

from onbeat.errors import FormatError

MOTION, SKELETON = ".amc", ".asf"


def is_skeleton(name: str) -> bool:
    """Whether a file of this name is a skeleton.

    Examples
    --------
    >>> is_skeleton("05.ASF"), is_skeleton("05_01.amc")
    (True, False)
    """
    return name.lower().endswith(SKELETON)


def lacks_skeleton(path: Path) -> bool:
    """Whether a file needs a skeleton that is not beside it; one of another name that is others' is not its own."""
    from onbeat.formats.acclaim.read import skeleton_file

    if path.suffix.lower() != MOTION:
        return False
    try:
        skeleton = skeleton_file(path)
    except FormatError:
        return True
    return not fits(path, skeleton) and any(fits(other, skeleton) for other in path.parent.glob(f"*{MOTION}"))


def fits(motion: Path, skeleton: Path) -> bool:
    """Whether an AMC file has a name that says so.

    Examples
    --------
    >>> [fits(Path(motion), Path("05.asf")) for motion in ("05_01.amc", "05.amc", "051_01.amc", "05_01.bvh")]
    [True, True, False, False]
    """
    name, start = motion.stem.lower(), skeleton.stem.lower()
    return motion.suffix.lower() == MOTION and (name == start or name.startswith(f"{start}_"))


def skeleton_of(motion: Path, skeletons: Iterable[Path]) -> Path | None:
    """The skeleton whose name fits best.

    Examples
    --------
    >>> str(skeleton_of(Path("HDM_bd_01.amc"), [Path("HDM.asf"), Path("HDM_bd.asf"), Path("05.asf")]))
    'HDM_bd.asf'
    """
    fitting = [path for path in skeletons if fits(motion, path)]
    return max(fitting, key=lambda path: len(path.stem), default=None)


def put_beside(skeleton: Path, motion: Path) -> None:
    """A copy of a skeleton where the reader of an AMC looks first: with its folder and name."""
    place = motion.with_suffix(SKELETON)
    if place != skeleton:
        shutil.copyfile(skeleton, place)


def what_it_lacks(path: Path) -> str:
    """What a file waits for, in words.

    Examples
    --------
    >>> what_it_lacks(Path("05_01.amc"))
    'waits for its skeleton 05.asf'
    >>> what_it_lacks(Path("05.asf"))
    'the skeleton of motions 05_…'
    """
    if is_skeleton(path.name):
        return f"the skeleton of motions {path.stem}_…"
    return f"waits for its skeleton {path.stem.rpartition('_')[0] or path.stem}{SKELETON}"
