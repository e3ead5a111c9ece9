"""Glitches of captures and poses of reference stay out of libraries, and it is told."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import LibraryError
from onbeat.formats import write_motion
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.leaps import LEAP, body_leaps
from onbeat.moves.build import build_library
from onbeat.moves.disk.index import INDEX, reading
from onbeat.moves.making.clips import read_recording
from onbeat.moves.making.stretches import use_of
from onbeat.moves.manage import merge_libraries, remove_recordings
from onbeat.moves.recordings import Recording
from onbeat.moves.store import open_library


def lost(motion: Motion, first: int, end: int) -> Motion:
    """Frames that are zero, as captures lose them."""
    turns, path = motion.rotations.copy(), motion.root_positions.copy()
    turns[first:end], path[first:end] = rot.IDENTITY, 0.0
    return motion.replace(rotations=turns, root_positions=path)


def clip_numbers(folder: Path) -> set[int]:
    with reading(folder / INDEX) as index:
        return {number for (number,) in index.execute("SELECT id FROM clips").fetchall()}


@pytest.fixture
def glitchy(dances: list[Motion], tmp_path: Path) -> Path:
    """Three dances of 4 s, in the second of which four frames are lost."""
    folder = tmp_path / "glitchy"
    folder.mkdir()
    for name, motion in zip("abc", dances, strict=False):
        write_motion(lost(motion, 56, 60) if name == "b" else motion, folder / f"{name}.npz")
    return folder


def test_the_dances_of_the_troupe_are_used_whole(dances):
    for motion in dances:
        used = use_of(motion, Body.of(motion.skeleton))
        assert used.note == ""
        assert [stretch.key for stretch in used.stretches] == [""]


def test_lost_frames_split_a_clip_and_are_told(glitchy, tmp_path):
    library = build_library([glitchy], tmp_path / "library", mirror=False)
    assert [clip.name for clip in library.clips] == ["a", "b@0.00", "b@2.13", "c"]
    assert [clip.source for clip in library.clips] == [0, 1, 2, 3]
    (note,) = library.notes
    assert note.startswith("b.npz: 0.4 s left out where joints leap (")
    for clip in library.clips:
        motion = clip.motion
        assert body_leaps(motion, Body.of(motion.skeleton)).max() < LEAP
    second = library.clips[2].motion
    whole = read_recording(Recording("b", "b.npz", "", lambda: second)).load()
    assert len(whole) == 120 - 64


def test_stretches_come_with_mirror_images_and_nothing_is_read_twice(glitchy, tmp_path):
    build_library([glitchy], tmp_path / "library", mirror=False)
    library = build_library([glitchy], tmp_path / "library")
    names = ["a", "a~mirror", "b@0.00", "b@0.00~mirror", "b@2.13", "b@2.13~mirror", "c", "c~mirror"]
    assert [clip.name for clip in library.clips] == names
    assert [clip.source for clip in library.clips] == [0, 0, 1, 1, 2, 2, 3, 3]
    rows = clip_numbers(tmp_path / "library")
    (glitchy / "c.npz").unlink()
    assert [clip.name for clip in build_library([glitchy], tmp_path / "library").clips] == names[:6]
    assert clip_numbers(tmp_path / "library") < rows


def test_a_stretch_that_is_missing_is_made_again(glitchy, tmp_path):
    build_library([glitchy], tmp_path / "library")
    names = [clip.name for clip in open_library(tmp_path / "library").clips]
    with sqlite3.connect(tmp_path / "library" / INDEX) as index:
        index.execute("DELETE FROM clips WHERE content LIKE '%@2.13 2/2' AND mirrored = 1")
    index.close()
    assert [clip.name for clip in build_library([glitchy], tmp_path / "library").clips] == names


def test_a_recording_is_removed_and_merged_with_all_its_stretches(glitchy, dances, tmp_path):
    build_library([glitchy], tmp_path / "one", mirror=False)
    more = tmp_path / "more"
    more.mkdir()
    write_motion(dances[3], more / "e.npz")
    write_motion(lost(dances[1], 56, 60), more / "b.npz")
    build_library([more], tmp_path / "two", mirror=False)
    merged = merge_libraries([tmp_path / "one", tmp_path / "two"], tmp_path / "both")
    assert [clip.name for clip in merged.clips] == ["a", "b@0.00", "b@2.13", "c", "e"]
    assert merged.problems == ("b.npz: the same as b.npz",)
    assert [clip.name for clip in remove_recordings(tmp_path / "one", ["b"]).clips] == ["a", "c"]


def test_a_pose_of_reference_is_left_out_to_the_frame(dances, tmp_path):
    motion = dances[0]
    frames = np.maximum(np.arange(-20, len(motion)), 0)
    turns = motion.rotations[frames].copy()
    turns[:20] = rot.IDENTITY
    shown = motion.replace(rotations=turns, root_positions=motion.root_positions[frames])
    read = read_recording(Recording("t", "t.npz", "", lambda: shown))
    (stretch,) = read.stretches
    assert (stretch.start, stretch.suffix) == (pytest.approx(20 / 30), "@0.67")
    assert read.notes == ("0.67 s left out where a pose of reference stands in front",)
    assert np.array_equal(stretch.of(read.load()).rotations, motion.rotations)


def test_motion_in_place_is_told(dances):
    motion = dances[1]
    fixed = motion.replace(root_positions=np.zeros_like(motion.root_positions))
    (note,) = read_recording(Recording("p", "p.npz", "", lambda: fixed)).notes
    assert note.startswith("the hips never move, though the feet do")


def test_a_take_of_leaps_alone_is_refused_with_the_reason(dances):
    shaken = dances[0]
    for first in range(10, 120, 20):
        shaken = lost(shaken, first, first + 2)
    with pytest.raises(
        LibraryError, match=r"4 s left out where joints leap .*the first of .* nowhere are there 1\.5 s"
    ):
        read_recording(Recording("s", "s.npz", "", lambda: shaken))
