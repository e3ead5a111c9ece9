"""A library built on an older one is the library built afresh, whatever changed."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.errors import LibraryError
from onbeat.formats import write_motion
from onbeat.motion import Motion
from onbeat.motion.retarget import retarget
from onbeat.moves.build import build_library
from persons import person, swinging
from stored_libraries import kept

SMALL, TALL = person(0.9), person(1.1, arms_down=True)
# name, content (None takes the file away): other motions, of two bodies, one too short, one broken
EDITS = st.lists(
    st.tuples(st.sampled_from("abcd"), st.sampled_from([0, 1, 2, 3, 4, "short", "broken", None])),
    min_size=1,
    max_size=4,
)


def content(kind: int | str) -> Motion:
    """Parts of one long swing, which come near each other."""
    first, frames = (0, 20) if kind == "short" else (40 * int(kind), 80 + 10 * int(kind))
    swing = swinging(SMALL, 300, 30.0)
    motion = swing.replace(root_positions=np.column_stack((swing.times, np.zeros((300, 2)))))[first : first + frames]
    return motion if kind in (0, 1, 2, "short") else retarget(motion, TALL)


def edit(folder: Path, name: str, kind: int | str | None) -> None:
    file = folder / f"{name}.npz"
    if kind is None:
        file.unlink(missing_ok=True)
    elif kind == "broken":
        file.write_bytes(b"broken")
    else:
        write_motion(content(kind), file)


def built(source: Path, library: Path, mirror: bool) -> dict[str, object] | str:
    """What a library is, or why there is none."""
    try:
        build_library([source], library, mirror=mirror)
    except LibraryError as error:
        return str(error)
    return kept(library)


def test_the_material_of_the_law_has_joins(tmp_path):
    for kind in (0, 2, 4):
        edit(tmp_path, f"{kind}", kind)
    joins = build_library([tmp_path], tmp_path / "lib").graph
    assert len({(a, b) for a, b in zip(joins.clip_of[joins.sources], joins.clip_of[joins.targets], strict=True)}) > 5


@settings(max_examples=8, deadline=None)
@given(st.lists(st.tuples(EDITS, st.booleans()), min_size=1, max_size=3))
def test_a_build_on_an_older_one_gives_the_same_bytes(rounds):
    with tempfile.TemporaryDirectory() as temporary:
        source = Path(temporary) / "source"
        source.mkdir()
        edit(source, "b", 0)
        for number, (edits, mirror) in enumerate(rounds):
            for name, kind in edits:
                edit(source, name, kind)
            grown = built(source, Path(temporary) / "grown", mirror)
            fresh = built(source, Path(temporary) / f"fresh{number}", mirror)
            assert grown == fresh
