"""``onbeat keyposes`` as a user runs it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.cli.keypose_input import BeatFlags
from onbeat.cli.keypose_sound import RATE, sound_of, titled
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.formats import write_motion

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two dancers' folk dance with keyposes and beats beside each."""
    place = tmp_path_factory.mktemp("folk")
    for dancer in DANCERS[:2]:
        clip = perform(dancer, [FOLK_DANCE], 1.0, 1, np.random.default_rng(0), 30.0)
        write_motion(clip.motion, place / f"{dancer.name}.npz")
        np.savetxt(place / f"{dancer.name}.keyposes.csv", clip.keyposes, fmt="%.4f", header="seconds")
        np.savetxt(place / f"{dancer.name}.beats", clip.beats, fmt="%.4f")
    return place


def test_a_motion_with_beats_gives_the_documents_a_sheet_and_a_page(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    status, out, err = onbeat(
        "keyposes", folder / "Aiko.npz", "--beats", folder / "Aiko.beats", "-o", tmp_path / "found", "--cycle", 12
    )
    assert (status, err) == (0, "")
    assert "keyposes on 16 beats, by energy" in out
    document = json.loads((tmp_path / "found" / "keyposes.json").read_text())
    assert document["fps"] == 30.0
    assert len(document["keyposes"]) >= 8
    times = np.loadtxt(tmp_path / "found" / "keyposes.csv")
    assert times.tolist() == [row["time"] for row in document["keyposes"]]
    assert (tmp_path / "found" / "keyposes.png").read_bytes()[:4] == b"\x89PNG"
    assert b"<svg" in (tmp_path / "found" / "keyposes.svg").read_bytes()[:2000]
    assert b"<html" in (tmp_path / "found" / "keyposes.html").read_bytes()[:200]


def test_the_page_holds_the_song_from_where_the_motion_begins(tmp_path: Path) -> None:
    place = tmp_path / "waltz.wav"
    soundfile.write(place, np.full((4 * RATE, 2), 0.5, np.float32), RATE)
    assert sound_of(BeatFlags(), 9.0) is None
    samples, rate = sound_of(BeatFlags(music=place, song_at=1.0), 3.0) or pytest.fail("no sound")
    assert (len(samples), rate) == (3 * RATE, RATE)
    assert not samples[:RATE].any()
    assert samples[RATE + 9 :].min() > 0.4
    cut = sound_of(BeatFlags(music=place, song_at=-3.0), 9.0)
    assert cut is not None
    assert len(cut[0]) == RATE
    assert sound_of(BeatFlags(music=place, song_at=-5.0), 9.0) is None
    assert titled("folk", BeatFlags(music=place)) == "folk · waltz"


def test_without_music_the_motion_keeps_its_own_beats(onbeat: Run, folder: Path) -> None:
    status, out, err = onbeat("keyposes", folder / "Bruno.npz", "--json")
    assert status == 0
    assert "from the motion itself, 10" in err  # 104 a minute
    assert len(json.loads(out)["keyposes"]) >= 8


def test_learning_writes_thresholds_that_finding_takes(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    learned = tmp_path / "t.json"
    names = [folder / "Aiko.npz", folder / "Bruno.npz"]
    status, out, _ = onbeat("keyposes", "learn", *names, "--tolerance", 0.12, "-o", learned)
    assert status == 0
    assert "held out" in out
    assert 0.0 < json.loads(learned.read_text())["held_out_f"] <= 1.0
    status, out, _ = onbeat("keyposes", names[0], "--beats", folder / "Aiko.beats", "--thresholds", learned, "--json")
    document = json.loads(learned.read_text())
    assert json.loads(out)["thresholds"] == {"t1": document["t1"], "t2": document["t2"]}


def test_evaluating_prints_methods_baselines_and_chance(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    picture = tmp_path / "sweep.png"
    status, out, _ = onbeat("keyposes", "evaluate", folder / "Aiko.npz", "--tolerance", 0.12, "--plot", picture)
    assert status == 0
    for row in ("energy", "paper2009", "shiratori2004", "hands", "every beat", "energy, mass weights"):
        assert row in out
    assert picture.stat().st_size > 10_000
    status, out, _ = onbeat("keyposes", "evaluate", folder / "Aiko.npz", "--tolerance", 0.12, "--json")
    scores = json.loads(out)["scores"]
    assert scores["energy"]["f"] > scores["shiratori2004"]["f"]
    assert scores["energy"]["chance"] < scores["energy"]["f"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("Aiko.npz", "--beats", "Aiko.beats", "--song-at", "99"), "two are needed: say when the song begins"),
        (("Aiko.npz", "--beats", "Aiko.beats", "--music", "x.wav"), "give one of them"),
        (("Aiko.npz", "--beats", "Aiko.beats", "--t1", "-1"), "cannot be; give 0 or more"),
        (("Aiko.npz", "--beats", "Aiko.beats", "--thresholds", "Aiko.beats"), "is not what `onbeat keyposes learn -o`"),
        (("Aiko.npz", "--song-at", "3"), "give the second of the motion at which --music or --beats begin"),
        (("Aiko.npz", "--beats", "Aiko.beats", "--song-at", "nan"), "--song-at nan"),
        (("Aiko.npz", "--beats", "Aiko.beats", "--method", "hands", "--t1", "1"), "hands does not look at --t1"),
        (
            ("Aiko.npz", "--beats", "Aiko.beats", "--method", "paper2009", "--energy", "sum"),
            "does not look at --energy",
        ),
        (("Aiko.npz", "--beats", "Aiko.beats", "--window", "0.7"), "--window 0.7 of a beat"),
        (("evaluate", "Aiko.npz", "--seed", "-1"), "--seed -1: give 0 or more"),
        (("Aiko.npz", "--beats", "Aiko.beats", "--cycle", "0"), "a cycle of 0 beats cannot be"),
        (("nobody.npz",), "no file"),
        (("learn", "nobody.npz"), "nobody.keyposes.csv beside nobody.npz"),
    ],
)
def test_what_cannot_be_is_one_clear_line(onbeat: Run, folder: Path, words: tuple[str, ...], message: str) -> None:
    paths = [folder / word if word.endswith((".npz", ".beats")) else word for word in words]
    status, out, err = onbeat("keyposes", *paths)
    assert status == 1
    assert message in err
    assert out == ""
    assert err.count("\n") == 1


@pytest.mark.parametrize("flag", ["--method", "--energy", "--order", "--weights"])
def test_an_unknown_name_is_wrong_usage_before_anything_is_read(onbeat: Run, flag: str) -> None:
    status, _, err = onbeat("keyposes", "nobody.npz", flag, "magic")
    assert status == 2
    assert "magic" in err


def test_learned_options_go_along_with_the_thresholds(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    learned = tmp_path / "t.json"
    names = [folder / "Aiko.npz", folder / "Bruno.npz"]
    onbeat("keyposes", "learn", *names, "--energy", "sum", "--order", "local", "-o", learned)
    _, out, _ = onbeat("keyposes", names[0], "--beats", folder / "Aiko.beats", "--thresholds", learned, "--json")
    document = json.loads(out)
    assert (document["energy"], document["order"], document["weights"]) == ("sum", "local", "uniform")
    _, out, _ = onbeat(
        "keyposes", names[0], "--beats", folder / "Aiko.beats", "--thresholds", learned, "--order", "global", "--json"
    )
    assert json.loads(out)["order"] == "global"


def test_examples_need_beats(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    for name in ("Aiko.npz", "Aiko.keyposes.csv"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    status, _, err = onbeat("keyposes", "learn", tmp_path / "Aiko.npz")
    assert status == 1
    assert "no Aiko.beats and no song Aiko.wav beside Aiko.npz" in err


def test_a_song_without_a_beat_is_said(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    noise = tmp_path / "noise.wav"
    soundfile.write(noise, 0.1 * np.random.default_rng(0).standard_normal(22050 * 6), 22050)
    status, out, err = onbeat("keyposes", folder / "Aiko.npz", "--music", noise)
    assert (status, out) == (1, "")
    assert f"no beat is heard in {noise}: say where the beats are with --beats, or leave the song out" in err
