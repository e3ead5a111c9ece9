"""``onbeat dance`` as people run it, and as those do who mean it no good."""

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

from onbeat.cli import dance as command
from onbeat.cli import main
from onbeat.dance.document import DanceDocument
from onbeat.examples import embedded_song
from onbeat.formats import read_motion, write_motion
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song

pytestmark = [pytest.mark.filterwarnings("ignore:Cyclopts application invoked"), pytest.mark.usefixtures("cache")]

FILES = {"dance.bvh", "dance.glb", "dance.html", "dance.json", "song.json"}
STAGES = ("composing", "listening", "moves", "searching", "dancing", "warping", "measuring", "writing")
Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs the command in this process; gives exit status, stdout and stderr."""

    def call(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["onbeat", "dance", *map(str, words)])
        try:
            main()
            status = 0
        except SystemExit as stop:
            status = int(stop.code or 0)
        out, err = capsys.readouterr()
        return status, out, err

    return call


@pytest.fixture(scope="module")
def sound() -> tuple[np.ndarray, int]:
    """Six seconds of the embedded song."""
    _, samples, rate = embedded_song(20.0)
    return samples[: 6 * rate], rate


@pytest.fixture(scope="module")
def song(sound: tuple[np.ndarray, int], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("songs") / "song.wav"
    soundfile.write(path, *sound)
    return path


@pytest.fixture(scope="module")
def clips(troupe: MoveLibrary, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three short clips of the troupe in a folder."""
    folder = tmp_path_factory.mktemp("clips")
    for name, clip in zip("abc", troupe.clips[::2], strict=False):
        write_motion(clip.motion[:600], folder / f"{name}.npz")
    return folder


@pytest.fixture
def out(tmp_path: Path) -> Path:
    return tmp_path / "dance"


def one_line(err: str) -> bool:
    return err.startswith("onbeat: ") and err.count("\n") == 1 and "Traceback" not in err


# What it makes


@pytest.fixture(scope="module")
def danced(cache: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of six seconds of the embedded song, danced with a film."""
    folder = tmp_path_factory.mktemp("made") / "dance"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["onbeat", "dance", "--seconds", "6", "--video", "-o", str(folder)])
        with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):
            main()
    return folder


def test_all_files_are_there_and_fit_together(danced: Path) -> None:
    assert {path.name for path in danced.iterdir()} == FILES | {"dance.mp4"}
    document = DanceDocument.from_json((danced / "dance.json").read_bytes())
    heard = Song.from_json((danced / "song.json").read_bytes())
    motion = read_motion(danced / "dance.bvh")
    assert document.duration == heard.duration == pytest.approx(6.0)
    assert len(motion) == round(6.0 * document.fps)
    assert document.beats == pytest.approx(heard.beats.tolist(), abs=1e-3)
    assert len(document.joins) == len(document.moves) - 1
    assert {path.stat().st_mode & 0o777 for path in danced.iterdir()} == {0o644}


def test_other_processes_and_threads_make_the_same_bytes(danced: Path, tmp_path: Path) -> None:
    """At once, into one new cache: one of them builds the library there, on one thread, the other on two."""
    code = "from onbeat.cli import main; main()"
    running = []
    for threads in ("1", "2"):
        names = ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS")
        settings = os.environ | dict.fromkeys(names, threads) | {"ONBEAT_CACHE": str(tmp_path / "cache")}
        words = ["dance", "--seconds", "6", "--video", "-o", str(tmp_path / threads)]
        running.append(subprocess.Popen([sys.executable, "-c", code, *words], env=settings, stdout=subprocess.DEVNULL))
    assert [process.wait(timeout=120) for process in running] == [0, 0]
    for path in danced.iterdir():
        data = path.read_bytes()
        assert str(tmp_path.parent).encode() not in data
        assert [name for name in ("1", "2") if (tmp_path / name / path.name).read_bytes() != data] == [], path.name


def test_json_on_stdout(run: Run, song: Path, clips: Path, out: Path) -> None:
    status, printed, err = run(song, "--moves", clips, "--json", "--fps", 20, "--no-warp", "-o", out)
    assert (status, err) == (0, "")
    assert printed.encode() == (out / "dance.json").read_bytes()
    assert json.loads(printed)["fps"] == 20


def test_table_and_what_next(run: Run, song: Path, clips: Path, out: Path) -> None:
    status, printed, err = run(song, "--moves", clips, "--fps", 20, "-o", out)
    assert (status, err) == (0, "")
    assert "on the beat, ±50 ms" in printed
    assert f"Look at it: open {out / 'dance.html'}" in printed
    assert f"onbeat dance {song} --moves {clips} --video" in printed
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
    assert len(lines) == command.TOLD + 1
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


# What it refuses: before any work is done, in a line, leaving nothing


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--seconds", "0"), "--seconds 0: give more than 0"),
        (("--seconds", "-1"), "--seconds -1: give more than 0"),
        (("--seconds", "nan"), "--seconds nan: give more than 0"),
        (("--seconds", "1e9"), "at most 1200"),
        (("--start", "-1"), "--start -1: give a second of the song"),
        (("--start", "nan"), "--start nan: give a second of the song"),
        (("--start", "inf"), "--start inf: give a second of the song"),
        (("--start", "1e9"), "the embedded song lasts 60 s"),
        (("--start", "1e9", "--seconds", "8"), "the embedded song lasts 1200 s"),
        (("SONG", "--start", "7"), "lasts 6.0 s"),
        (("SONG", "--start", "5.9"), "too short to hear a beat in"),
        (("--fps", "0"), "--fps 0: give a rate"),
        (("--fps", "1e9"), "give a rate"),
        (("--fps", "nan"), "--fps nan: give a rate"),
        (("--seed", "-1"), "--seed -1: give a whole number"),
        (("--seed", str(2**64)), "give a whole number"),
        (("missing.wav",), "missing.wav: no such file"),
        (("folder",), "folder: is a folder"),
        (("text.wav",), "text.wav: not a sound file"),
        (("empty.wav",), "the file is empty"),
        (("silent.wav",), "silent for all of its 3.0 s"),
        (("half.wav",), "0.50 s is too short"),
        (("long.flac",), "lasts 180 minutes; a dance lasts at most 20: choose a stretch"),
        (("SONG", "--moves", "missing"), "no file or folder missing"),
        (("SONG", "--moves", "folder"), "no motion files in folder"),
        (("SONG", "--moves", "broken"), "none of 2 files can be used; 0.bvh"),
        (("SONG", "--moves", "tiny"), "no joint found for chest"),
        (("SONG", "--moves", "text.wav"), "the only file cannot be used; text.wav"),
        (("-o", "text.wav"), "text.wav is not a folder"),
        (("-o", "text.wav/a/b"), "text.wav is not a folder"),
        (("-o", "x" * 300), "File name too long"),
    ],
)
def test_errors_are_one_line(
    run: Run, song: Path, wrong: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], message: str
) -> None:
    monkeypatch.chdir(wrong)
    before = sorted(wrong.rglob("*"))
    status, printed, err = run(*(str(song) if word == "SONG" else word for word in words))
    assert (status, printed) == (1, "")
    assert message in err
    assert one_line(err)
    assert sorted(wrong.rglob("*")) == before


@pytest.fixture(scope="module")
def wrong(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of everything that is wrong."""
    folder = tmp_path_factory.mktemp("wrong")
    (folder / "folder").mkdir()
    (folder / "text.wav").write_text("hello")
    (folder / "empty.wav").touch()
    soundfile.write(folder / "silent.wav", np.zeros(24000), 8000)
    soundfile.write(folder / "half.wav", np.ones(4000) * 0.3, 8000)
    with soundfile.SoundFile(folder / "long.flac", "w", 1000, 1) as file:
        for _ in range(180):
            file.write(np.zeros(60000))
    (folder / "broken").mkdir()
    for number in range(2):
        (folder / "broken" / f"{number}.bvh").write_text("HIERARCHY\nROOT x\n{\nOFFSET nan")
    (folder / "tiny").mkdir()
    bones = Skeleton(["a", "b", "c"], [-1, 0, 1], np.array([[0, 0, 0], [0, 0, 0.5], [0, 0, 0.5]]))
    still = Motion(bones, np.tile(rot.IDENTITY, (300, 3, 1)), np.zeros((300, 3)), 60.0, "tiny")
    write_motion(still, folder / "tiny" / "tiny.npz")
    return folder


@pytest.mark.parametrize("words", [("--seconds", "abc"), ("--method", "knit"), ("--foo",), ("a", "b")])
def test_usage_exits_with_2(run: Run, words: tuple[str, ...]) -> None:
    status, printed, err = run(*words)
    assert status == 2
    assert printed == ""
    assert "Traceback" not in err


def test_of_three_hours_a_minute_can_be_danced(run: Run, clips: Path, out: Path, tmp_path: Path) -> None:
    rate, beat = 4000, np.zeros(2000, np.float32)
    beat[:60] = 0.5
    with soundfile.SoundFile(tmp_path / "long.flac", "w", rate, 1) as file:
        for _ in range(180):
            file.write(np.tile(beat, 120))
    words = ("--start", 10000, "--seconds", 5, "--moves", clips, "--fps", 10, "-o", out)
    assert run(tmp_path / "long.flac", *words)[0] == 0
    assert json.loads((out / "dance.json").read_bytes())["duration"] == pytest.approx(5.0)


def test_what_one_clip_cannot_fill_is_refused(run: Run, song: Path, clips: Path, out: Path, tmp_path: Path) -> None:
    short = read_motion(clips / "a.npz")[:120]
    write_motion(short, tmp_path / "short.npz")
    status, _, err = run(song, "--moves", tmp_path / "short.npz", "-o", out)
    assert status == 1
    assert one_line(err)
    assert "add clips or take fewer --seconds" in err
    assert not out.exists()


def test_a_body_that_never_stops_or_moves(run: Run, song: Path, clips: Path, out: Path, tmp_path: Path) -> None:
    motion = read_motion(clips / "a.npz")
    frozen = np.zeros(500, np.int64)
    write_motion(
        motion.replace(rotations=motion.rotations[frozen], root_positions=motion.root_positions[frozen]),
        tmp_path / "still.npz",
    )
    status, printed, err = run(song, "--moves", tmp_path / "still.npz", "--json", "--fps", 10, "-o", out)
    assert (status, err) == (0, "")
    assert json.loads(printed)["stops"] == []


# Stopped in the middle


@pytest.mark.parametrize("stage", STAGES)
def test_stopped_in_any_stage_nothing_is_left(
    run: Run, song: Path, clips: Path, out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    monkeypatch.setenv("ONBEAT_CACHE", str(tmp_path / "cache"))

    def stop(stages: command.Stages, name: str, share: float, detail: str = "") -> None:
        if name == stage and (share > 0 or name not in ("writing", "moves")):
            raise KeyboardInterrupt

    monkeypatch.setattr(command.Stages, "__call__", stop)
    words = ("--seconds", 4) if stage == "composing" else (song, "--moves", clips)
    assert run(*words, "--fps", 10, "-o", out) == (130, "", "onbeat: stopped\n")
    assert not out.exists()
    assert [path for path in tmp_path.rglob("*") if ".part" in path.name or path.name.startswith(".d")] == []


def test_stopped_while_writing_the_older_dance_is_kept(
    run: Run, song: Path, clips: Path, out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out.mkdir()
    (out / "dance.bvh").write_text("older")
    monkeypatch.setattr("onbeat.viewer.page.write_page", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    assert run(song, "--moves", clips, "--fps", 10, "-o", out)[0] == 130
    assert [path.name for path in out.iterdir()] == ["dance.bvh"]
    assert (out / "dance.bvh").read_text() == "older"


def test_a_full_disk_is_told_and_nothing_is_left(
    run: Run, song: Path, clips: Path, out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(source: str, target: str) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("onbeat.files.os.replace", full)
    monkeypatch.setenv("ONBEAT_CACHE", str(out.parent / "cache"))
    status, printed, err = run(song, "--moves", clips, "--fps", 10, "-o", out)
    assert (status, printed) == (1, "")
    assert err.splitlines()[-1] == (
        f"onbeat: cannot write {out / 'dance.bvh'}: No space left on device; choose another folder with -o"
    )
    assert not out.exists()


def test_two_at_once_in_a_folder(out: Path) -> None:
    with command._staged(out) as one, command._staged(out) as other:
        for number, folder in enumerate((one, other)):
            (folder / "dance.json").write_text(str(number))
    assert [path.name for path in out.iterdir()] == ["dance.json"]
