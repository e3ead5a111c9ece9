"""The default method on clicks, drums and chords: right tempo, on time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.errors import AudioError
from onbeat.music import METHODS, Song, listen, listen_samples
from onbeat.music.audio import Audio
from sounds import beat_times, click_track, hat, kick, mix, piano, snare


def late(song: Song, beats: np.ndarray) -> np.ndarray:
    """Seconds that each heard beat is behind the nearest true one."""
    return song.beats - beats[np.abs(song.beats[:, None] - beats).argmin(axis=1)]


def band(bpm: float, meter: int = 4, seconds: float = 24.0) -> tuple[np.ndarray, Audio]:
    """Drums in eighths, a chord and a bass note a bar."""
    rng = np.random.default_rng(0)
    beats = beat_times(bpm, seconds)
    events = []
    for index, at in enumerate(beats):
        events += [
            (at, kick() if index % meter == 0 else snare(rng) * 0.6),
            (at, hat(rng)),
            (at + 30.0 / bpm, hat(rng)),
        ]
        if index % meter == 0:
            root = 110.0 * 2.0 ** ((0, 5, 7, 9)[index // meter % 4] / 12)
            events += [(at, piano(root * ratio, meter * 55.0 / bpm, 0.3)) for ratio in (1.0, 2.0, 2.52, 3.0)]
    return beats, mix(seconds, events)


@pytest.mark.parametrize("bpm", [60, 72, 85, 100, 112, 128, 145, 163, 180])
def test_clicks_are_tracked_on_time(bpm: int) -> None:
    beats, audio = click_track(bpm)
    song = listen_samples(audio)
    assert song.tempo == pytest.approx(bpm, rel=2e-3)
    assert abs(np.median(late(song, beats))) < 0.008
    assert np.abs(late(song, beats)).max() < 0.02
    assert abs(len(song.beats) - len(beats)) <= 1


@pytest.mark.parametrize(("bpm", "meter"), [(96, 4), (118, 4), (131, 4), (150, 3), (168, 4)])
def test_a_band_is_tracked_with_its_bars(bpm: int, meter: int) -> None:
    beats, audio = band(bpm, meter)
    song = listen_samples(audio)
    assert song.tempo == pytest.approx(bpm, rel=3e-3)
    assert song.meter == meter
    assert abs(np.median(late(song, beats))) < 0.008
    bars = beats[::meter]
    assert np.abs(song.downbeats[:, None] - bars).min(axis=1).max() < 0.03
    assert set(song.downbeats) <= set(song.beats)


def test_a_song_is_well_formed() -> None:
    _, audio = band(120)
    for method in METHODS:
        song = listen_samples(audio, method, title="band")
        assert song.method == method
        assert song.title == "band"
        assert (np.diff(song.beats) > 0.2).all()
        assert song.beats[0] >= 0.0
        assert song.beats[-1] < song.duration == pytest.approx(24.0)
        for values in (song.chord_change, song.beat_strength, song.intensity):
            assert values.min() >= 0.0
            assert values.max() <= 1.0
        assert Song.from_json(song.to_json()).to_json() == song.to_json()


def test_no_beats_in_silence_before_and_after() -> None:
    beats, audio = band(120, seconds=12.0)
    silence = np.zeros(5 * audio.rate, np.float32)
    song = listen_samples(Audio(np.concatenate([silence, audio.samples, silence]), audio.rate))
    assert abs(len(song.beats) - len(beats)) <= 1
    assert np.abs(song.beats[0] - 5.0 - beats[0]) < 0.02
    assert song.beats[-1] < 17.5


def test_strong_beats_are_stronger() -> None:
    rng = np.random.default_rng(0)
    beats = beat_times(120, 20.0)
    events = [(at, kick() if index % 4 == 0 else hat(rng, 0.05)) for index, at in enumerate(beats)]
    song = listen_samples(mix(20.0, events))
    strong = np.isin(np.arange(len(song.beats)) % 4, [np.argmax(song.beat_strength[:4])])
    assert np.median(song.beat_strength[strong]) > 1.5 * np.median(song.beat_strength[~strong])


@pytest.mark.parametrize("method", METHODS)
def test_what_cannot_be_danced_to(tmp_path: Path, method: str) -> None:
    path = tmp_path / "song.wav"
    soundfile.write(path, np.zeros(5 * 8000), 8000)
    with pytest.raises(AudioError, match=r"silent for all of its 5\.0 s.*nothing to dance to"):
        listen(path, method)
    soundfile.write(path, 0.1 * np.ones(4000), 8000)
    with pytest.raises(AudioError, match=r"0\.50 s is too short"):
        listen(path, method)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("kind", ["noise", "tone", "constant", "one click", "two seconds"])
def test_odd_sounds_give_a_song(method: str, kind: str) -> None:
    rng = np.random.default_rng(0)
    sound = {
        "noise": 0.1 * rng.standard_normal(22050 * 6),
        "tone": 0.3 * np.sin(np.arange(22050 * 6) * 0.1),
        "constant": np.full(22050 * 6, 0.5),
        "one click": np.eye(1, 22050 * 6, 40000)[0],
        "two seconds": 0.1 * rng.standard_normal(22050 * 2),
    }[kind]
    song = listen_samples(Audio(sound.astype(np.float32), 22050), method)
    assert np.isfinite(song.beats).all()
    assert (np.diff(song.beats) > 0.0).all()
    assert np.isfinite(song.intensity).all()
    assert np.isfinite(song.chord_change).all()


def test_unknown_method_and_progress(tmp_path: Path) -> None:
    _, audio = click_track(120, 5.0)
    path = tmp_path / "a song.wav"
    soundfile.write(path, audio.samples, audio.rate)
    with pytest.raises(AudioError, match="there are barpointer, onsets, shiratori2006"):
        listen(path, "none")
    heard: list[float] = []
    assert listen(path, progress=heard.append).title == "a song"
    assert heard[-1] == pytest.approx(5.0, abs=0.01)
