"""The page as a file: whole, small, safe whatever names hold, and the same each time."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from onbeat.errors import OnbeatError
from onbeat.motion import Motion, Skeleton
from onbeat.music.song import Song
from onbeat.viewer.contract import VERSION, ClipData, GraphData, JoinData, PageData, unpack_curve, unpack_path
from onbeat.viewer.pages.content import page_data
from onbeat.viewer.pages.graph_drawn import CLIPS, JOINS
from onbeat.viewer.pages.page import filled, render_page, write_page

HOSTILE = '</script><script>alert("1")</script><!-- \u2028 &amp; <img src=x onerror=alert(2)>'
VIEWER_JS = Path(__file__).resolve().parents[2] / "viewer-js"


@pytest.fixture
def song() -> Song:
    beats = np.arange(0.5, 4, 0.5)
    return Song(4.0, 120.0, 4, beats, beats[::4], np.zeros(len(beats)), [0, 4], [0.1, 0.8], title="Test & song")


def document(**changes: Any) -> dict[str, Any]:
    moves = [
        {"clip": "walk", "from_s": 1.0, "to_s": 3.0, "at_s": 0.0},
        {"clip": "turn", "from_s": 0.5, "to_s": 2.5, "at_s": 2.0},
    ]
    metrics = {"f50": 0.81234, "beat_align": {"score": 0.3, "null": 0.1}, "curve": [1, 2], "z": float("nan")}
    whole = {"version": 1, "fps": 60, "duration": 4.0, "seed": 0, "method": "optimal", "beats": [0.5, 1.0]}
    return whole | {"stops": [1.01, 0.49], "moves": moves, "metrics": metrics} | changes


def data_in(page: bytes) -> dict[str, Any]:
    found = re.findall(rb'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert len(found) == 1
    return json.loads(found[0])


def sine(seconds: float = 4.0) -> tuple[np.ndarray, int]:
    return np.sin(np.arange(int(22050 * seconds)) / 10).astype(np.float32) * 0.3, 22050


def test_the_page_holds_the_dance(swinger: Motion, song: Song) -> None:
    page = data_in(render_page(swinger, song, document(), sine()))
    assert page["version"] == VERSION
    assert page["title"] == "Test & song"
    assert page["beats"] == [0.5, 1.0]
    assert page["downbeats"] == [0.5, 2.5]
    assert page["stops"] == [0.49, 1.01]
    assert page["joins"] == [2.0]
    assert page["audio"]["uri"].startswith("data:audio/mpeg;base64,")
    assert {"name": "beat align · score", "value": "0.3"} in page["metrics"]
    assert {"name": "f50", "value": "0.8123"} in page["metrics"]
    assert set(page) == set(PageData.__struct_fields__)


def test_the_joints_are_where_the_motion_has_them(swinger: Motion) -> None:
    data = page_data(swinger)
    seen = unpack_path(data.path, len(data.joints))
    columns = [swinger.skeleton.index(name) for name in data.joints]
    assert np.abs(seen - swinger.positions[:, columns]).max() < 1e-4
    assert data.joints[data.spine[0]] == "Hips"
    assert data.floor == pytest.approx(0.0, abs=0.06)


def test_frames_past_sixty_a_second_are_left_out(swinger: Motion) -> None:
    fast = swinger.at(np.arange(960) / 240).replace(fps=240.0)
    data = page_data(fast)
    assert (data.fps, data.frames) == (60.0, 240)
    assert data.duration == fast.duration
    assert page_data(swinger).fps == 60.0


def test_a_minute_is_small(swinger: Motion) -> None:
    minute = swinger.at(np.arange(3600) / 60 % 4)
    clips = [ClipData(f"a clip with a long name {k}", 12.345) for k in range(CLIPS)]
    graph = GraphData(clips, [JoinData(k % CLIPS, 12.345, 7, 6.789) for k in range(JOINS)], 3000, 40_000_000)
    size = len(filled(msgspec.structs.replace(page_data(minute), graph=graph)))
    print(f"a page of 60 s is {size / 1e6:.2f} MB without its sound")
    assert size < 3_000_000


def test_names_cannot_break_out(swinger: Motion, song: Song) -> None:
    moves = [{"clip": HOSTILE, "from_s": 0.0, "to_s": 4.0, "at_s": 0.0}]
    hostile = document(moves=moves, title=HOSTILE, method=HOSTILE, metrics={HOSTILE: HOSTILE})
    page, plain = render_page(swinger, song, hostile), render_page(swinger, song, document())
    assert page.count(b"<script") == plain.count(b"<script")
    assert page.count(b"</script") == plain.count(b"</script")
    data = data_in(page)
    assert data["title"] == data["moves"][0]["clip"] == data["method"] == HOSTILE


def test_nothing_is_fetched(swinger: Motion, song: Song) -> None:
    page = render_page(swinger, song, document(), sine()).decode()
    assert "default-src 'none'" in page
    assert not re.search(r"<(?:link|script|img|iframe|audio)[^>]+(?:src|href)=[\"']?(?:https?:)?//", page)


def test_a_motion_alone_makes_a_page(swinger: Motion) -> None:
    data = page_data(swinger)
    assert data.title == "swinger"
    assert data.audio is None
    assert data.beats == data.moves == data.metrics == []
    assert len(unpack_curve(data.motion_intensity)) == 41


def test_a_body_without_roles_is_drawn_as_bones() -> None:
    rope = Skeleton(("a", "b", "c"), [-1, 0, 1], [[0, 0, 0], [0, 0, 0.5], [0, 0, 0.5]])
    data = page_data(Motion(rope, np.tile([1.0, 0, 0, 0], (10, 3, 1)), np.zeros((10, 3)), 30))
    assert len(data.capsules) == 2
    assert data.spine == [0]
    assert data.motion_intensity.base64 == ""


def test_one_frame_is_enough(swinger: Motion) -> None:
    assert page_data(swinger[:1]).frames == 1


def test_the_same_input_gives_the_same_bytes(swinger: Motion, song: Song) -> None:
    assert render_page(swinger, song, document(), sine()) == render_page(swinger, song, document(), sine())


@pytest.mark.parametrize(
    "wrong",
    [
        {"moves": [{"clip": "a"}]},
        {"stops": "many"},
        {"beats": [None]},
        {"metrics": [1]},
        {"title": 3},
        {"stops": [np.inf]},
    ],
)
def test_a_wrong_document_is_refused(swinger: Motion, wrong: dict[str, Any]) -> None:
    with pytest.raises(OnbeatError, match="no dance document"):
        render_page(swinger, None, document(**wrong))


def test_a_wrong_sound_leaves_no_file(swinger: Motion, tmp_path: Path) -> None:
    with pytest.raises(OnbeatError, match="samples"):
        write_page(tmp_path / "dance.html", swinger, audio=(np.zeros((0, 1), np.float32), 44100))
    assert not list(tmp_path.iterdir())


def test_the_file_is_the_page(swinger: Motion, tmp_path: Path) -> None:
    write_page(tmp_path / "dance.html", swinger)
    assert (tmp_path / "dance.html").read_bytes() == render_page(swinger)


def test_the_built_page_is_current() -> None:
    if not (shutil.which("node") and (VIEWER_JS / "node_modules").is_dir()):
        pytest.skip("node or viewer-js/node_modules is missing: run `npm ci` in viewer-js to compare the built page")
    checked = subprocess.run(["sh", str(VIEWER_JS / "check.sh")], capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stderr
