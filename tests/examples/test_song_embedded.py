"""The embedded song: its sound is sound, and its truth is true."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile
from scipy.signal import lfilter

from onbeat.errors import AudioError
from onbeat.examples.song import RATE, DemoSong, demo_score, demo_song, encode, perform, true_song, write
from onbeat.music.song import Song


@pytest.fixture(scope="module")
def demo() -> DemoSong:
    return demo_song()


def level(samples: np.ndarray) -> float:
    """Root mean square in dB of full scale."""
    return float(10.0 * np.log10(np.mean(samples.astype(np.float64) ** 2)))


def test_sound_is_clean(demo: DemoSong) -> None:
    samples = demo.samples
    assert samples.shape == (60 * RATE, 2)
    assert samples.dtype == np.float32
    assert np.isfinite(samples).all()
    assert np.abs(samples).max() < 0.98
    assert np.abs(samples.mean(axis=0)).max() < 1e-4
    assert -17.5 < level(samples) < -14.5
    assert 0.2 < np.corrcoef(samples[:, 0], samples[:, 1]).item(1) < 0.95


def test_ends_are_silent_and_no_click_stands_out(demo: DemoSong) -> None:
    assert np.abs(demo.samples[[0, -1]]).max() < 1e-4
    assert np.abs(demo.samples[-RATE // 50 :]).max() < 1e-3


def test_same_arguments_same_samples(demo: DemoSong) -> None:
    assert np.array_equal(demo.samples, demo_song(60.0, seed=0, tempo=106.0, meter=4).samples)
    assert not np.array_equal(demo_song(12.0, seed=1).samples, demo_song(12.0, seed=2).samples)


@pytest.mark.parametrize(("seconds", "meter", "tempo"), [(7.3, 4, 106.0), (20.0, 3, 130.0), (31.01, 4, 90.0)])
def test_other_lengths_and_meters(seconds: float, meter: int, tempo: float) -> None:
    demo = demo_song(seconds, seed=5, tempo=tempo, meter=meter)
    assert len(demo.samples) == round(seconds * RATE)
    assert abs(demo.tempo / tempo - 1.0) < 0.03
    assert np.array_equal(demo.downbeats, demo.beats[::meter])
    assert demo.sections[0].start == 0.0
    assert demo.sections[-1].end == pytest.approx(seconds, abs=1e-4)
    assert all(before.end == after.start for before, after in zip(demo.sections[:-1], demo.sections[1:], strict=True))


@pytest.mark.parametrize(("seed", "meter"), [(0, 4), (1, 4), (2, 3)])
def test_kicks_stand_on_beats_to_the_millisecond(seed: int, meter: int) -> None:
    score = demo_score(40.0, seed, meter=meter)
    kick = np.abs(perform(score, 40.0, seed).listen("kick"))
    loud = np.flatnonzero(kick > 0.02)
    starts = loud[np.diff(loud, prepend=-RATE) > 0.08 * RATE] / RATE
    nearest = np.abs(starts[:, None] - score.grid.beats).min(axis=1)
    assert len(starts) >= score.grid.bars
    assert nearest.max() < 1e-3
    downbeats = score.grid.beats[::meter]
    assert np.abs(downbeats[:, None] - starts).min(axis=1).max() < 1e-3


def test_tempo_drifts_and_comes_back(demo: DemoSong) -> None:
    tempo = 60.0 / np.diff(demo.beats)
    assert tempo[0] == pytest.approx(104.0, abs=0.5)
    assert tempo[len(tempo) // 2] == pytest.approx(108.0, abs=0.5)
    assert tempo[-1] == pytest.approx(104.0, abs=0.5)
    assert np.abs(np.diff(tempo)).max() < 0.2


def test_sections_sound_as_intense_as_they_are(demo: DemoSong) -> None:
    names = [section.name for section in demo.sections]
    assert names == ["intro", "verse", "chorus", "break", "chorus", "outro"]
    levels = [level(demo.samples[int(part.start * RATE) : int(part.end * RATE)]) for part in demo.sections]
    intro, verse, chorus, pause, last, outro = levels
    assert min(chorus, last) > verse > max(intro, pause, outro)
    assert max(intro, pause, outro) < chorus - 3.0


def test_chords_are_heard(demo: DemoSong) -> None:
    """In each bar the tones of its chord hold more of the sound than other tones do."""
    mono = demo.samples.mean(axis=1)
    wins = 0
    for start, end, chord in zip(demo.beats[:-1], demo.beats[1:], demo.chords[:-1], strict=True):
        piece = mono[int(start * RATE) : int(end * RATE)]
        power = np.abs(np.fft.rfft(piece * np.hanning(len(piece)), 1 << 16)) ** 2
        tones = np.arange(45, 82)
        bins = np.round(440.0 * 2.0 ** ((tones - 69) / 12) * (1 << 16) / RATE).astype(int)
        chroma = np.bincount(tones % 12, np.log1p(power[bins]), 12)
        wins += chroma[list(chord.tones)].mean() > np.median(chroma)
    assert wins > 0.95 * (len(demo.beats) - 1)


def test_truth_is_a_song_document(demo: DemoSong) -> None:
    song = true_song(demo)
    again = Song.from_json(song.to_json())
    assert again.meter == 4
    assert np.allclose(again.beats, demo.beats, atol=1e-4)
    assert len(demo.chords) == len(demo.beats) == len(again.chord_change)
    changed = np.array([True] + [a != b for a, b in zip(demo.chords[:-1], demo.chords[1:], strict=True)])
    assert np.array_equal(song.chord_change > 0, changed)
    middles = np.array([(part.start + part.end) / 2 for part in demo.sections[:-1]])
    assert np.allclose(song.intensity_at(middles), [part.intensity for part in demo.sections[:-1]])
    assert song.intensity.min() >= 0.0
    assert song.intensity.max() <= 1.0


@pytest.mark.parametrize("suffix", [".wav", ".flac", ".mp3"])
def test_files_have_the_same_bytes_twice(tmp_path: Path, suffix: str) -> None:
    demo = demo_song(6.0)
    write(demo, tmp_path / f"song{suffix}")
    assert (tmp_path / f"song{suffix}").read_bytes() == encode(demo, suffix)
    samples, rate = soundfile.read(tmp_path / f"song{suffix}")
    assert rate == RATE
    assert abs(len(samples) - len(demo.samples)) < 3000


def test_shortest_song_is_as_the_message_says() -> None:
    with pytest.raises(AudioError) as caught:
        demo_song(1.0)
    least = float(str(caught.value).split("ask for ")[1].split(" s")[0])
    assert demo_song(least).duration == pytest.approx(least, abs=1e-4)


def test_what_cannot_be_made_is_refused(tmp_path: Path) -> None:
    with pytest.raises(AudioError, match="too short"):
        demo_song(2.0)
    with pytest.raises(AudioError, match="meter"):
        demo_song(20.0, meter=5)
    with pytest.raises(AudioError, match=r"\.flac"):
        write(demo_song(5.0), tmp_path / "song.ogg")


def test_loudness_is_that_of_a_record(demo: DemoSong) -> None:
    """−14 LUFS, with the K weighting of BS.1770 (ungated) as two filters at 44.1 kHz."""
    shelf = ([1.5308412, -2.6509799, 1.1690790], [1.0, -1.6636551, 0.7125954])
    cut = ([1.0, -2.0, 1.0], [1.0, -1.9891696, 0.9891991])
    weighted = np.asarray(lfilter(*cut, np.asarray(lfilter(*shelf, demo.samples, axis=0)), axis=0))
    loudness = -0.691 + 10.0 * np.log10(np.mean(weighted**2, axis=0).sum())
    assert loudness == pytest.approx(-14.0, abs=1.0)
