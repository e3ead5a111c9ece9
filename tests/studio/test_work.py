"""The jobs' work itself, from a song to exports: what the page gets agrees with what lies in the folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
import soundfile

from onbeat.dance.document import DanceDocument
from onbeat.errors import OnbeatError
from onbeat.examples.troupe import dance_library
from onbeat.formats.bvh.write import write_bvh
from onbeat.formats.trc.write import write_trc
from onbeat.formats.write import write_motion
from onbeat.motion import Markers, Motion, Skeleton
from onbeat.studio import advice
from onbeat.studio.clip_list import ClipList
from onbeat.studio.song_view import song_view
from onbeat.studio.tasks import (
    BuildTask,
    DanceTask,
    Done,
    ExportTask,
    KeptDance,
    ListenTask,
    LookTask,
    RetimeTask,
    SoundSource,
)
from onbeat.studio.telling import Tell
from onbeat.studio.wire import BeatsData, FilmOrder, MotionView, SongItem
from onbeat.studio.work_dance import danced_song
from onbeat.studio.worker import work_of
from onbeat.viewer.contract import VERSION, PageData, unpack_curve
from sounds import RATE, click

SECONDS = 8.0


class Told(list[tuple[float, str]]):
    """What a job says of its progress."""

    def tell(self) -> Tell:
        return Tell(lambda share, what: self.append((share, what)))


def done(task: Any, told: Told | None = None) -> Done:
    Path(task.out).mkdir(exist_ok=True)
    return work_of(task)(task, (Told() if told is None else told).tell())


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> SoundSource:
    """A song of clicks at 120 BPM with a chord that changes each bar, heard."""
    folder = tmp_path_factory.mktemp("song")
    sound = np.zeros(round(SECONDS * RATE))
    for beat in np.arange(0.25, SECONDS - 0.1, 0.5):
        at = round(beat * RATE)
        sound[at : at + len(click())] += click()
    times = np.arange(len(sound)) / RATE
    sound += 0.1 * np.sin(2 * np.pi * np.where(np.floor((times - 0.25) / 2) % 2 == 0, 220.0, 293.7) * times)
    soundfile.write(folder / "given.flac", 0.5 * sound, RATE)
    made = SoundSource("clicks", str(folder / "given.flac"), str(folder / "out" / "song.json"))
    told = Told()
    found = done(ListenTask(str(folder / "out"), made), told)
    assert found.seconds == pytest.approx(SECONDS, abs=0.01)
    assert found.tempo == pytest.approx(120, abs=2)
    assert [share for share, _ in told] == sorted(share for share, _ in told)
    return made


@pytest.fixture(scope="module")
def moves(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The folder of a library of four seconds each of five dancers: the troupe's takes long to build."""
    folder = tmp_path_factory.mktemp("moves")
    files = [(str(folder / f"move{number}.bvh"), f"dancer {number}.bvh") for number in range(5)]
    for (path, _), take in zip(files, dance_library(fps=30.0), strict=False):
        write_bvh(take.motion[:120], path)
    assert done(BuildTask(str(folder / "list"), str(folder), files)).clips == 5
    return str(folder)


def order(out: Path, source: SoundSource, **changed: Any) -> DanceTask:
    usual = {"library": None, "marks": {}, "start": 0.5, "seconds": 6.0, "method": "optimal", "seed": 0}
    return DanceTask(out=str(out), name="clicked", song=source, **({"intensity_weight": 1.0} | usual | changed))


@pytest.fixture(scope="module")
def dance(tmp_path_factory: pytest.TempPathFactory, source: SoundSource, moves: str) -> Path:
    folder = tmp_path_factory.mktemp("dance")
    found = done(order(folder, source, library=moves))
    assert found.seconds == pytest.approx(6.0, abs=0.02)
    assert found.f50 is not None
    return folder


def scene(folder: Path) -> PageData:
    return msgspec.json.decode((folder / "scene.json").read_bytes(), type=PageData)


def test_the_sound_that_is_played_is_the_one_that_was_given(source: SoundSource):
    folder = Path(source.heard).parent
    played, rate = soundfile.read(folder / "sound.wav")
    given, _ = soundfile.read(str(source.file))
    assert rate == RATE
    np.testing.assert_allclose(played, given, atol=1e-4)
    shown = song_view(folder, SongItem("song-1", "clicks", "ready", duration=SECONDS))
    beats = np.array(shown.beats)
    assert np.abs((beats - 0.25 + 0.25) % 0.5 - 0.25).max() < 0.03
    wave = unpack_curve(shown.waveform)
    assert len(wave) == pytest.approx(SECONDS * shown.waveform.rate, abs=1)
    assert wave.max() == 1.0


def test_a_dance_has_the_page_that_onbeat_dance_writes(dance: Path):
    page = scene(dance)
    document = DanceDocument.from_json((dance / "dance.json").read_bytes())
    assert (page.version, page.audio) == (VERSION, None)
    assert page.duration == pytest.approx(6.0, abs=0.02)
    assert [move.clip for move in page.moves] == [move.clip for move in document.moves]
    assert page.graph is not None
    assert (dance / "root.npz").read_bytes() == (dance / "dance.npz").read_bytes()


def test_marks_and_kept_stretches_are_heeded(tmp_path: Path, dance: Path, source: SoundSource, moves: str):
    before = DanceDocument.from_json((dance / "dance.json").read_bytes())
    kept = [KeptDance(str(dance), 0.0, 1.6)]
    shown = {m.clip.removesuffix("~mirror") for m in before.moves if m.at_s < 2.2}
    later = {m.clip.removesuffix("~mirror") for m in before.moves if m.at_s >= 2.2} - shown
    assert later
    marks: Any = dict.fromkeys(later, "forbidden") | {"a clip that is gone": "forbidden"}
    done(order(tmp_path / "again", source, library=moves, keep=kept, marks=marks))
    after = DanceDocument.from_json((tmp_path / "again" / "dance.json").read_bytes())
    assert not {m.clip.removesuffix("~mirror") for m in after.moves} & later
    was, now = ([(m.clip, round(m.from_s, 1)) for m in d.moves if m.at_s < 1.2] for d in (before, after))
    assert was == now


def test_beats_that_the_user_put_right_are_danced_to(source: SoundSource):
    beats = np.arange(0.4, 6.5, 0.6).round(4).tolist()
    right = msgspec.structs.replace(source, beats=BeatsData(beats, beats[1::3]))
    song = danced_song(order(Path(), right, start=1.0, seconds=5.0), Told().tell())
    np.testing.assert_allclose(song.beats + 1, [beat for beat in beats if 1 <= beat < 6], atol=1e-3)
    np.testing.assert_allclose(song.downbeats + 1, [beat for beat in beats[1::3] if 1 <= beat < 6], atol=1e-3)
    assert (song.meter, song.duration) == (3, 5.0)
    assert song.chord_change.max() > 0


def test_a_faster_dance_is_made_of_the_dance_at_the_songs_own_speed(tmp_path: Path, dance: Path):
    found = done(RetimeTask(str(tmp_path / "fast"), "faster", str(dance), 1.25))
    assert found.seconds == pytest.approx(6.0 / 1.25, abs=0.05)
    page = scene(tmp_path / "fast")
    slow = scene(dance)
    np.testing.assert_allclose(np.array(page.beats) * 1.25, slow.beats[: len(page.beats)], atol=1e-3)
    assert page.tempo == pytest.approx(1.25 * slow.tempo, rel=1e-3)
    assert (tmp_path / "fast" / "root.json").read_bytes() == (dance / "root.json").read_bytes()
    assert page.graph == slow.graph
    assert [move.clip for move in page.moves] == [move.clip for move in slow.moves]


def test_exports_are_whole_files(tmp_path: Path, dance: Path, source: SoundSource):
    sound = str(Path(source.heard).with_name("sound.wav"))
    for format, file, begin in (("glb", "dance.glb", b"glTF"), ("html", "dance.html", b"<!doctype html>")):
        done(ExportTask(str(tmp_path), file, format, str(dance), sound, 0.5, 1.0))
        assert (tmp_path / file).read_bytes()[: len(begin)].lower() == begin.lower()
    assert b"data:audio/mpeg" in (tmp_path / "dance.html").read_bytes()


def test_a_video_has_the_size_and_the_flashes_that_were_ordered(
    tmp_path: Path, dance: Path, source: SoundSource, monkeypatch: pytest.MonkeyPatch
):
    asked: list[dict[str, Any]] = []
    monkeypatch.setattr("onbeat.viewer.video.write_video", lambda *films, **asks: asked.append(asks))
    sound = str(Path(source.heard).with_name("sound.wav"))
    for film in (FilmOrder(), FilmOrder(1080, 1920, 24.0, flash=True)):
        done(ExportTask(str(tmp_path), "dance.mp4", "mp4", str(dance), sound, 0.5, 1.0, film=film))
    assert [(asks["size"], asks["fps"]) for asks in asked] == [((1280, 720), 30.0), ((1080, 1920), 24.0)]
    assert asked[0]["flashes"] is None
    assert asked[1]["flashes"].times.tolist() == pytest.approx(scene(dance).beats, abs=1e-3)


def test_motions_are_looked_at_and_built_into_a_library(tmp_path: Path, swinger: Motion):
    write_bvh(swinger, tmp_path / "x1.bvh")
    (tmp_path / "x2.bvh").write_text("nothing")
    files = [(str(tmp_path / "x1.bvh"), "my walk.bvh"), (str(tmp_path / "x2.bvh"), "empty.bvh")]
    found = done(LookTask(str(tmp_path / "look"), [(f"motion-{k}", *file) for k, file in enumerate(files)]))
    assert [one.error is None for one in found.seen] == [True, False]
    assert "empty.bvh" in (found.seen[1].error or "")
    assert str(tmp_path) not in (found.seen[1].error or "")
    view = msgspec.json.decode((tmp_path / "look" / "motion-0.json").read_bytes(), type=MotionView)
    assert (view.name, view.seconds, view.scene.version) == ("my walk.bvh", pytest.approx(4.0, abs=0.02), VERSION)
    assert view.body.startswith("1.")
    with pytest.raises(OnbeatError, match=r"^empty\.bvh"):
        done(LookTask(str(tmp_path / "look"), [("motion-1", *files[1])]))
    built = done(BuildTask(str(tmp_path / "list"), str(tmp_path / "library"), files))
    assert built.clips == 1
    assert built.note == "1 of 2 motions are left out"
    assert ClipList.read(tmp_path / "list").problems[0].startswith("empty.bvh")


def test_a_rate_that_no_file_stores_is_assumed_told_and_said(tmp_path: Path):
    stands = "0,0,0.79,0,0,0,1"
    table = "".join(f"{stands},{','.join([f'{0.01 * (k % 7):.2f}'] * 29)}\n" for k in range(120))
    (tmp_path / "x.csv").write_text(table)
    file = ("motion-1", str(tmp_path / "x.csv"), "bow.csv")
    [assumed] = done(LookTask(str(tmp_path / "look"), [file])).seen
    assert (assumed.rate_stored, assumed.fps) == (False, 30.0)
    assert "say it on the motion's page" in assumed.note
    [said] = done(LookTask(str(tmp_path / "look"), [file], {"motion-1": 60.0})).seen
    assert (said.fps, said.seconds) == (60.0, pytest.approx(assumed.seconds / 2, abs=1e-3))
    assert "assumed" not in said.note
    write_trc(Markers(("LASI",), np.ones((1, 1, 3)), fps=100), tmp_path / "y.trc")
    (tmp_path / "y.trc").write_text((tmp_path / "y.trc").read_text().replace("\n100.00", "\nfast", 1))
    [asks] = done(LookTask(str(tmp_path / "look"), [("motion-2", str(tmp_path / "y.trc"), "odd.trc")])).seen
    assert "say it on the motion's page" in (asks.error or "")
    assert not asks.rate_stored


def test_a_size_that_is_no_person_s_is_doubted(tmp_path: Path, swinger: Motion):
    bones = swinger.skeleton
    small = Skeleton(bones.names, bones.parents, 0.15 * bones.offsets)
    write_motion(Motion(small, swinger.rotations, 0.15 * swinger.root_positions, swinger.fps), tmp_path / "x.npz")
    write_motion(swinger, tmp_path / "y.npz")
    files = [(f"motion-{k}", str(tmp_path / f"{k}.npz"), f"{k}.npz") for k in "xy"]
    odd, usual = done(LookTask(str(tmp_path / "look"), files)).seen
    assert "m (is that right?)" in odd.body
    assert "is the unit right?" in odd.note
    assert "right?" not in usual.body + usual.note


def test_a_library_has_its_motions_at_the_rates_that_were_said(tmp_path: Path, moves: str, swinger: Motion):
    write_bvh(swinger, tmp_path / "x1.bvh")
    files = [(str(tmp_path / "x1.bvh"), "walk.bvh")]
    spans: list[list[float]] = []
    for rates in ({}, {files[0][0]: 2 * swinger.fps}, {}):
        done(BuildTask(str(tmp_path / "list"), str(tmp_path / "library"), files, rates))
        spans.append([seconds for _, seconds in ClipList.read(tmp_path / "list").clips])
    assert spans[0] == spans[2] == [pytest.approx(swinger.duration, abs=0.05)]
    assert spans[1] == [pytest.approx(swinger.duration / 2, abs=0.05)]


def test_less_than_was_asked_for_is_told(tmp_path: Path, source: SoundSource, moves: str):
    found = done(order(tmp_path / "short", source, library=moves, start=3.0, seconds=60.0))
    assert found.seconds == pytest.approx(5.0, abs=0.02)
    assert found.note == "60 seconds were asked for; the song ends after 5.0"


def test_a_picture_is_no_song_and_is_told_so_by_its_name(tmp_path: Path):
    (tmp_path / "original.mp3").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(100))
    with pytest.raises(OnbeatError, match=r"^holiday\.mp3") as refused:
        done(ListenTask(str(tmp_path / "out"), SoundSource("holiday.mp3", str(tmp_path / "original.mp3"))))
    assert str(tmp_path) not in str(refused.value)


@pytest.mark.parametrize(
    ("said", "here"),
    [
        ("a: choose a stretch with --start and --seconds", "a: choose a stretch of the song"),
        (
            "too few poses; add clips, or dance to 9.5 --seconds at most",
            "too few poses; add clips, or dance to 9.5 sec",
        ),
        ("no beat is heard: or say where the beats are with --beats or --tap", "no beat is heard: or put its beats in"),
        ("no rate; say it with --fps (of `onbeat convert`, --source-fps)", "no rate; where that is wrong, "),
        ("is the unit right? (`--source-unit`; in are inches)", "is the unit right?"),
        ("a.bvh: no end; 3 more to know: `onbeat info a.bvh`", "a.bvh: no end; 3 more to know"),
    ],
)
def test_nobody_is_told_of_a_command_line_that_is_not_there(said: str, here: str):
    found = advice.here(said)
    assert found.startswith(here)
    assert "--" not in found
    assert "`" not in found


def test_a_motion_without_its_skeleton_is_told_to_come_with_it(tmp_path: Path):
    (tmp_path / "walk.amc").write_text("#!OML:ASF\n:FULLY-SPECIFIED\n:DEGREES\n1\n")
    with pytest.raises(OnbeatError, match=r"^my walk\.amc .* drop both together"):
        done(LookTask(str(tmp_path / "look"), [("motion-0", str(tmp_path / "walk.amc"), "my walk.amc")]))
