"""The sheet as files: whole, readable, the same bytes each time, and what it shows is what was found."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib import image
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from folk_dancers import dancers
from onbeat.errors import OnbeatError
from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.extract import Keyposes, Options, find_keyposes
from onbeat.motion import Markers, Motion
from onbeat.viewer.keypose.drawing import LOOKS
from onbeat.viewer.keypose.poses import fitted, pose_pictures, poses_at
from onbeat.viewer.keypose.sheet import A4, DPI, keypose_pages, save_pages, write_keypose_sheet


@cache
def folk() -> tuple[Keyposes, Motion]:
    clip = dancers(1)[0]
    return find_keyposes(clip.motion, clip.beats), clip.motion


@cache
def pages() -> list[Any]:
    found, motion = folk()
    return keypose_pages(found, motion, title="Folk $dance_", downbeats=found.song_beats[::4])


def words(page: Any) -> list[str]:
    return [text.get_text() for text in page.axes[0].texts]


def boxes(page: Any) -> np.ndarray:
    """(N, 2, 2) inches, the lower left and upper right corner of every text."""
    renderer = FigureCanvasAgg(page).get_renderer()
    found = [text.get_window_extent(renderer) for text in page.axes[0].texts if text.get_text()]
    return np.array([((box.x0, box.y0), (box.x1, box.y1)) for box in found]) / DPI


def overlaps(boxes: np.ndarray) -> int:
    apart = (boxes[:, None, 0] > boxes[None, :, 1]).any(-1) | (boxes[None, :, 0] > boxes[:, None, 1]).any(-1)
    return int((~apart).sum() - len(boxes)) // 2


@pytest.mark.parametrize("ending", [".png", ".svg", ".pdf"])
def test_the_same_dance_gives_the_same_bytes(tmp_path: Path, ending: str):
    found, motion = folk()
    first = save_pages(pages(), tmp_path / f"a{ending}")
    again = save_pages(
        keypose_pages(found, motion, title="Folk $dance_", downbeats=found.song_beats[::4]), tmp_path / f"b{ending}"
    )
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]
    assert len(first) == (1 if ending == ".pdf" else len(pages()))


def test_a_page_is_an_a4_page(tmp_path: Path):
    (first, *_) = save_pages(pages(), tmp_path / "sheet.png")
    picture = image.imread(first)
    assert picture.shape[:2] == (round(A4[1] * DPI), round(A4[0] * DPI))
    assert picture[:20].min() == picture[:, :20].min() == 1.0  # margins are white


def test_every_keypose_is_drawn_with_its_number_second_and_beat():
    found, _ = folk()
    said = [word for page in pages() for word in words(page)]
    for number, (time, beat) in enumerate(zip(found.times, found.beats, strict=True), 1):
        assert said.count(str(number)) >= 2  # above the curves and under the picture
        assert f"beat {beat + 1}\n{time:.2f} s" in said
    assert sum(len(page.axes[0].images) for page in pages()) == len(found)


@pytest.mark.parametrize("cycle", [None, 16])
def test_no_words_lie_over_others(cycle: int | None):
    found, motion = folk()
    for page in keypose_pages(found, motion, title="x" * 200, downbeats=found.song_beats[::4], cycle=cycle):
        every = boxes(page)
        assert overlaps(every) == 0
        assert every.min() > 0.1
        assert every[:, 1, 0].max() < A4[0]
        assert every[:, 1, 1].max() < A4[1]


def test_keyposes_of_a_cycle_stand_under_each_other():
    found, motion = folk()
    page = keypose_pages(found, motion, cycle=14)[0]
    places = {round(picture.get_extent()[0], 3) for picture in page.axes[0].images}
    numbers = {word for word in words(page) if word.isdigit()} - {"1", "2", "3", "4"}
    assert len(places) < len(page.axes[0].images)
    assert numbers


def test_ten_minutes_are_pages_of_a_page_each():
    found, motion = folk()
    times = np.arange(0.5, motion.duration - 0.5, 0.12)
    many = Keyposes(
        times, np.arange(len(times)), ("global",) * len(times), times, {"global": times, "local": times},
        found.energy, found.thresholds, "energy", found.fps,
    )  # fmt: skip
    made = keypose_pages(many, motion)
    assert len(made) > 3
    assert all(page.get_size_inches().tolist() == list(A4) for page in made)
    assert all(len(page.axes[0].images) <= 36 for page in made)


def test_png_and_svg_are_twelve_pages_at_most_and_a_pdf_is_all(tmp_path: Path):
    many = [Figure(figsize=(1, 1)) for _ in range(14)]
    written = save_pages(many, tmp_path / "s.png")
    assert [path.name for path in written] == ["s.png", *(f"s_{n}.png" for n in range(2, 13))]
    (pdf,) = save_pages(many, tmp_path / "s.pdf")
    assert pdf.read_bytes().count(b"/Type /Page ") == 14
    for other in ("s_2.svg", "s_14.png", "t_3.png", "s_x.png"):
        (tmp_path / other).write_bytes(b"of somebody else")
    save_pages(many[:2], tmp_path / "s.png")
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == ["s.pdf", "s.png", "s_14.png", "s_2.png", "s_2.svg", "s_x.png", "t_3.png"]


def test_where_the_bodys_frame_is_not_known_there_is_one_graph():
    found, motion = folk()
    energy = replace(found.energy, local=np.zeros(0))
    sources = ("global",) * len(found)
    alone = replace(found, energy=energy, sources=sources, candidates={"global": found.candidates["global"]})
    both, one = keypose_pages(found, motion)[0], keypose_pages(alone, motion)[0]
    assert not any("local" in word for word in words(one))
    assert "global: rest in the world" in words(one)
    assert LOOKS["local"].colour not in {line.get_color() for line in one.axes[0].lines}
    assert len(one.axes[0].images) == len(both.axes[0].images)
    assert overlaps(boxes(one)) == 0


def test_no_keypose_and_two_beats_are_drawn(tmp_path: Path):
    _, motion = folk()
    none = find_keyposes(motion, np.array([1.0, 1.5]), options=Options(thresholds=Thresholds(0.0, 99.0)))
    assert len(none) == 0
    (path,) = write_keypose_sheet(tmp_path / "none.svg", none, motion, title="日本")
    assert b"<svg" in path.read_bytes()


@pytest.mark.parametrize(
    ("method", "rest"), [("shiratori2004", "rest of hands and feet"), ("hands", "rest of the hands")]
)
def test_other_methods_are_drawn(method: str, rest: str):
    clip = dancers(1)[0]
    found = find_keyposes(clip.motion, clip.beats, method)
    (page,) = keypose_pages(found, clip.motion)[:1]
    assert any(rest in word for word in words(page))


def test_wrong_endings_and_cycles_are_refused(tmp_path: Path):
    with pytest.raises(OnbeatError, match=r"use \.png, \.svg, \.pdf"):
        save_pages(pages(), tmp_path / "sheet.jpg")
    found, motion = folk()
    with pytest.raises(OnbeatError, match="cycle of 0 beats"):
        keypose_pages(found, motion, cycle=0)


def test_poses_are_seen_from_their_front_whichever_way_the_dancer_turns(swinger: Motion):
    """The swinger walks a circle, and after each second of it has the same pose."""
    poses = poses_at(swinger, np.array([0.5, 1.5, 2.5]))
    assert np.ptp(poses.yaws) > 2
    pictures = [picture.astype(float) for picture in pose_pictures(poses, (80, 100))]
    body = slice(0, 55)  # above the floor, whose tiles lie elsewhere
    assert np.abs(pictures[0][body] - pictures[1][body]).mean() < 1.0
    assert np.abs(pictures[0][body] - pictures[2][body]).mean() < 1.0


def test_markers_that_tell_no_body_are_dots():
    swing = 0.2 * np.cos(2 * np.pi * np.arange(90) / 30)
    positions = np.random.default_rng(3).uniform(0, 1.6, (12, 3)) + swing[:, None, None]
    positions[20:40, 3] = np.nan
    markers = Markers([f"m{k}" for k in range(12)], positions, 30.0)
    assert fitted(markers) is markers
    found = find_keyposes(markers, np.arange(0.0, 2.9, 0.5), options=Options(order="global"))
    assert len(found) > 1
    (page,) = keypose_pages(found, markers)
    picture = page.axes[0].images[0].get_array()
    assert (picture < 110).any()


def test_to_markers_of_a_body_a_body_is_fitted(data: Path):
    from onbeat.formats.read import read_file

    markers = read_file(data / "c3d" / "MOTEK__ballet_reduced.trc")
    assert isinstance(markers, Markers)
    assert isinstance(fitted(markers), Motion)
