"""``onbeat dance`` refuses in one line what cannot be danced, and leaves nothing half-written when it is stopped."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.cli import dance as command
from onbeat.formats import read_motion, write_motion
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

pytestmark = [pytest.mark.filterwarnings("ignore:Cyclopts application invoked"), pytest.mark.usefixtures("cache")]

STAGES = ("composing", "listening", "moves", "searching", "dancing", "warping", "measuring", "writing")
Run = Callable[..., tuple[int, str, str]]


def one_line(err: str) -> bool:
    return err.startswith("onbeat: ") and err.count("\n") == 1 and "Traceback" not in err


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
        (("long.flac",), "long.flac lasts 180:00 minutes; a dance lasts at most 20:00 minutes: choose a stretch"),
        (("SONG", "--moves", "missing"), "no file or folder missing"),
        (("SONG", "--moves", "folder"), "no motion files in folder"),
        (("SONG", "--moves", "broken"), "none of 2 files can be used; 0.bvh"),
        (("SONG", "--moves", "tiny"), "no joint found for chest"),
        (("SONG", "--moves", "text.bvh"), "the only file cannot be used; text.bvh"),
        (("folder", "--moves", "text.wav"), "text.wav is a song, no motion; give `onbeat dance folder --moves MOTION`"),
        (("text.wav", "empty.wav"), "empty.wav is a song, no motion; give `onbeat dance text.wav --moves MOTION`"),
        (
            ("tiny", "text.wav"),
            "tiny is motion, no song and text.wav is a song, no motion: they look swapped; give "
            "`onbeat dance text.wav --moves tiny`",
        ),
        (("text.bvh",), "text.bvh is motion, no song; give `onbeat dance SONG --moves text.bvh`"),
        (("--source-fps", "0"), "--source-fps 0: give a rate"),
        (("--source-fps", "60"), "--source-fps: it is the rate of the files of --moves"),
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
    (folder / "text.bvh").write_text("hello")
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


@pytest.mark.parametrize("words", [("--seconds", "abc"), ("--method", "knit"), ("--foo",), ("a", "b", "c")])
def test_usage_exits_with_2(run: Run, words: tuple[str, ...]) -> None:
    status, printed, err = run(*words)
    assert status == 2
    assert printed == ""
    assert "Traceback" not in err


def test_what_one_clip_cannot_fill_is_refused(run: Run, song: Path, clips: Path, out: Path, tmp_path: Path) -> None:
    short = read_motion(clips / "a.npz")[:120]
    write_motion(short, tmp_path / "short.npz")
    status, _, err = run(song, "--moves", tmp_path / "short.npz", "-o", out)
    assert status == 1
    assert one_line(err)
    assert "add clips, or dance to 2.8 --seconds at most" in err
    assert not out.exists()


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


def test_stopped_in_a_compiled_loop(run: Run, song: Path, out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def inner() -> None:
        raise SystemError("returned a result with an exception set") from KeyboardInterrupt()

    def loop(*_: object) -> None:
        try:
            inner()
        except SystemError as error:
            raise SystemError("returned a result with an exception set") from error  # a loop that called another

    monkeypatch.setattr(command, "hear", loop)
    assert run(song, "-o", out) == (130, "", "onbeat: stopped\n")


def test_a_screen_that_is_full_is_told(run: Run, song: Path, out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(command, "hear", full)
    monkeypatch.setattr("onbeat.cli.os.dup2", lambda *_: None)
    assert run(song, "-o", out) == (1, "", "onbeat: standard output: No space left on device\n")


def test_stopped_while_writing_the_older_dance_is_kept(
    run: Run, song: Path, clips: Path, out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out.mkdir()
    (out / "dance.bvh").write_text("older")
    stop = lambda *_: (_ for _ in ()).throw(KeyboardInterrupt)  # noqa: E731
    monkeypatch.setattr("onbeat.viewer.pages.dance.write_dance_page", stop)
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
        f"onbeat: cannot write {out / 'dance.bvh'}: No space left on device; choose another folder"
    )
    assert not out.exists()


def test_two_at_once_in_a_folder(out: Path) -> None:
    with command._staged(out) as one, command._staged(out) as other:
        for number, folder in enumerate((one, other)):
            (folder / "dance.json").write_text(str(number))
    assert [path.name for path in out.iterdir()] == ["dance.json"]
