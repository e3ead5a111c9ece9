"""``onbeat dance`` as people run it: what it makes, whatever names and songs it is given."""

from __future__ import annotations

import contextlib
import io
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.cli import main
from onbeat.cli.dance_told import TOLD
from onbeat.dance.document import DanceDocument
from onbeat.formats import read_motion, write_motion
from onbeat.music.song import Song

pytestmark = [pytest.mark.filterwarnings("ignore:Cyclopts application invoked"), pytest.mark.usefixtures("cache")]

FILES = {"dance.bvh", "dance.glb", "dance.html", "dance.json", "song.json"}
FILM = ("--seconds", "5", "--video")
Run = Callable[..., tuple[int, str, str]]


def one_line(err: str) -> bool:
    return err.startswith("onbeat: ") and err.count("\n") == 1 and "Traceback" not in err


@pytest.fixture(scope="module")
def danced(cache: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of some seconds of the embedded song, danced with a film."""
    folder = tmp_path_factory.mktemp("made") / "dance"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["onbeat", "dance", *FILM, "-o", str(folder)])
        with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):
            main()
    return folder


def test_all_files_are_there_and_fit_together(danced: Path) -> None:
    assert {path.name for path in danced.iterdir()} == FILES | {"dance.mp4"}
    document = DanceDocument.from_json((danced / "dance.json").read_bytes())
    heard = Song.from_json((danced / "song.json").read_bytes())
    motion = read_motion(danced / "dance.bvh")
    assert document.duration == heard.duration == pytest.approx(5.0)
    assert len(motion) == round(5.0 * document.fps)
    assert document.beats == pytest.approx(heard.beats.tolist(), abs=1e-3)
    assert len(document.joins) == len(document.moves) - 1
    assert {path.stat().st_mode & 0o777 for path in danced.iterdir()} == {0o644}


def test_another_process_with_other_threads_makes_the_same_bytes(danced: Path, tmp_path: Path) -> None:
    """It builds the library anew, in a cache of its own."""
    threads = "2" if os.environ.get("OMP_NUM_THREADS") == "1" else "1"
    names = ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    settings = os.environ | dict.fromkeys(names, threads) | {"ONBEAT_CACHE": str(tmp_path / "cache")}
    words = ["dance", *FILM, "-o", str(tmp_path / "again")]
    code = "from onbeat.cli import main; main()"
    subprocess.run([sys.executable, "-c", code, *words], env=settings, stdout=subprocess.DEVNULL, check=True)
    for path in danced.iterdir():
        data = path.read_bytes()
        assert data == (tmp_path / "again" / path.name).read_bytes(), path.name
        assert str(tmp_path.parent).encode() not in data, path.name


def test_json_on_stdout(run: Run, song: Path, clips: Path, out: Path) -> None:
    status, printed, err = run(song, "--moves", clips, "--json", "--fps", 20, "--no-warp", "-o", out)
    assert (status, err) == (0, "")
    assert printed.encode() == (out / "dance.json").read_bytes()
    assert json.loads(printed)["fps"] == 20


def test_table_and_what_next(run: Run, song: Path, clips: Path, out: Path) -> None:
    status, printed, err = run(song, "--moves", clips, "--fps", 20, "-o", out)
    assert (status, err) == (0, "")
    assert "on the beat, ±50 ms" in printed
    assert f"Look at it: open {out / 'dance.html'} (" in printed
    assert f"onbeat dance {song} --moves {clips} --fps 20 -o {out} --video\n" in printed
    assert {path.name for path in out.iterdir()} == FILES


@pytest.mark.parametrize("name", ["[bold]", "[x", ":heart: 'a' $(b)", "</b><script>alert(1)", "été ダンス 🎵", "a\nb"])
def test_names_of_any_kind(run: Run, song: Path, clips: Path, out: Path, tmp_path: Path, name: str) -> None:
    places = [tmp_path / name / "[/].wav", tmp_path / f"clips {name}"] if "/" not in name else None
    if places is None:  # a slash cannot be in a name; the folders around it can end in its parts
        places = [tmp_path / name / "song.wav", tmp_path / "clips" / name]
    for place in places:
        place.parent.mkdir(parents=True, exist_ok=True)
    places[0].write_bytes(song.read_bytes())
    places[1].symlink_to(clips)
    target = out / name
    status, printed, err = run(places[0], "--moves", places[1], "--fps", 10, "-o", target)
    assert (status, err) == (0, "")
    assert f"Look at it: open {target / 'dance.html'}" in printed
    assert json.loads((target / "song.json").read_bytes())["title"] == places[0].stem
    assert b"<script>alert" not in (target / "dance.html").read_bytes()


@pytest.mark.skipif(sys.platform != "linux", reason="names that are no text are of Linux")
def test_a_name_that_is_no_text(run: Run, song: Path, clips: Path, out: Path, tmp_path: Path) -> None:
    strange = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff\xfe.wav"))
    strange.write_bytes(song.read_bytes())
    status, _, err = run(strange, "--moves", clips, "--fps", 10, "-o", out)
    assert (status, err) == (0, "")
    assert json.loads((out / "song.json").read_bytes())["title"] == "\ufffd\ufffd"


def test_a_broken_clip_is_left_out_and_told(run: Run, song: Path, clips: Path, out: Path, tmp_path: Path) -> None:
    folder = tmp_path / "mixed"
    folder.mkdir()
    for path in clips.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    for number in range(9):
        (folder / f"[{number}].bvh").write_text(f"not a motion {number}")
    status, _, err = run(song, "--moves", folder, "--fps", 10, "-o", out)
    assert status == 0
    lines = err.splitlines()
    assert len(lines) == TOLD + 1
    assert lines[0].startswith("onbeat: left out [0].bvh: ")
    assert lines[-1] == "onbeat: … and 4 more; `onbeat moves build` tells all"


def test_a_damaged_song_is_danced_as_far_as_it_goes(
    run: Run, sound: tuple[np.ndarray, int], clips: Path, out: Path, tmp_path: Path
) -> None:
    path = tmp_path / "cut.flac"
    soundfile.write(path, *sound)
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 3 // 4])
    status, _, err = run(path, "--moves", clips, "--fps", 10, "-o", out)
    assert status == 0
    assert one_line(err)
    assert "damaged or cut off" in err
    assert 3 < json.loads((out / "dance.json").read_bytes())["duration"] < 5


@pytest.mark.parametrize(("rate", "channels"), [(8000, 1), (48000, 6), (192000, 2)])
def test_any_rate_and_channels(run: Run, clips: Path, out: Path, tmp_path: Path, rate: int, channels: int) -> None:
    clicks = np.zeros((3 * rate, channels), np.float32)
    for at in np.arange(0.2, 2.9, 0.5):
        clicks[round(at * rate) :][: rate // 100] = 0.5
    soundfile.write(tmp_path / "song.wav", clicks, rate)
    assert run(tmp_path / "song.wav", "--moves", clips, "--fps", 10, "-o", out)[0] == 0
    assert {path.name for path in out.iterdir()} == FILES


def test_a_cache_that_cannot_be_is_told_and_done_without(
    run: Run, song: Path, clips: Path, out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("ONBEAT_CACHE", str(tmp_path / "file"))
    status, _, err = run(song, "--moves", clips, "--fps", 10, "-o", out)
    assert status == 0
    assert one_line(err)
    assert "set ONBEAT_CACHE to another folder" in err


def test_a_dance_among_the_clips_is_none_of_them(run: Run, song: Path, clips: Path, tmp_path: Path) -> None:
    folder = tmp_path / "clips"
    folder.mkdir()
    for path in clips.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    words = (song, "--moves", folder, "--fps", 10, "--json", "-o", folder / "dance")
    assert run(*words) == run(*words)


def test_of_three_hours_a_minute_can_be_danced(run: Run, clips: Path, out: Path, tmp_path: Path) -> None:
    rate, beat = 4000, np.zeros(2000, np.float32)
    beat[:60] = 0.5
    with soundfile.SoundFile(tmp_path / "long.flac", "w", rate, 1) as file:
        for _ in range(180):
            file.write(np.tile(beat, 120))
    words = ("--start", 10000, "--seconds", 5, "--moves", clips, "--fps", 10, "-o", out)
    assert run(tmp_path / "long.flac", *words)[0] == 0
    assert json.loads((out / "dance.json").read_bytes())["duration"] == pytest.approx(5.0)


def test_a_body_that_never_stops_or_moves(run: Run, song: Path, clips: Path, out: Path, tmp_path: Path) -> None:
    motion = read_motion(clips / "a.npz")
    frozen = np.zeros(400, np.int64)
    write_motion(
        motion.replace(rotations=motion.rotations[frozen], root_positions=motion.root_positions[frozen]),
        tmp_path / "still.npz",
    )
    status, printed, err = run(song, "--moves", tmp_path / "still.npz", "--no-mirror", "--json", "--fps", 10, "-o", out)
    assert (status, err) == (0, "")
    assert json.loads(printed)["stops"] == []
