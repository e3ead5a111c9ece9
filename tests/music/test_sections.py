"""Sections of music made of known parts."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.examples.song import demo_song
from onbeat.music import Song, listen_samples
from onbeat.music.audio import Audio
from onbeat.music.sections import KINDS, name_sections, novelty
from sounds import hat, kick, mix, piano, snare


def test_novelty_is_the_checkerboard_of_the_self_similarity() -> None:
    """Against Foote's own form: the kernel laid on the matrix of products, at each place of the diagonal."""
    rng = np.random.default_rng(0)
    features, reach = rng.standard_normal((30, 3)), 4
    gauss = np.exp(-0.5 * ((np.arange(reach) + 0.5) / (0.5 * reach)) ** 2)
    signed = np.concatenate([-gauss[::-1], gauss]) / gauss.sum()
    padded = np.pad(features, ((reach, reach), (0, 0)), mode="edge")
    similarity = padded @ padded.T
    kernel = np.outer(signed, signed)
    literal = [(kernel * similarity[at : at + 2 * reach, at : at + 2 * reach]).sum() for at in range(30)]
    np.testing.assert_allclose(novelty(features, reach), literal, atol=1e-12)


def test_novelty_peaks_where_the_music_changes() -> None:
    features = np.repeat([[0.0, 1.0], [1.0, 0.0], [0.0, 1.0]], 24, axis=0)
    change = novelty(features)
    assert change[24] == pytest.approx(2.0)
    assert change.argmax() in (24, 48)
    assert change[12] < 0.2 * change[24]
    assert novelty(np.zeros((0, 4))).shape == (0,)


@pytest.mark.parametrize(
    ("levels", "climbs", "names"),
    [
        ([0.2, 0.8, 0.3, 0.9, 0.2], [0, 0, 0, 0, 0], ["intro", "main", "break", "main", "ending"]),
        ([0.5, 0.8, 0.5, 0.9], [0, 0, 0.5, 0], ["intro", "main", "build-up", "main"]),
        ([0.5], [0.0], ["main"]),
        ([0.5, 0.5], [0.0, 0.0], ["main", "main"]),
        ([0.1, 0.2, 0.9, 0.9], [0, 0, 0, 0], ["intro", "main", "main", "main"]),
    ],
)
def test_names_follow_intensity(levels: list[float], climbs: list[float], names: list[str]) -> None:
    lengths = np.full(len(levels), 20.0)
    lengths[0] = 10.0
    assert name_sections(np.array(levels), np.array(climbs, dtype=float), lengths) == names


def test_a_break_between_two_choruses_is_found_to_the_bar() -> None:
    rng = np.random.default_rng(0)
    beats = 0.2 + 0.5 * np.arange(120)
    events = []
    for index, at in enumerate(beats):
        root = 110.0 * 2.0 ** ((0, 5, 7, 9)[index // 4 % 4] / 12)
        events += [(at, piano(root * ratio, 0.45, 0.1)) for ratio in (1.0, 2.0, 2.52, 3.0)]
        if not 48 <= index < 72:
            events += [(at, kick() if index % 2 == 0 else snare(rng)), (at + 0.25, hat(rng))]
    song = listen_samples(mix(61.0, events))
    middle = [part for part in song.sections if part.kind == "break"]
    assert len(middle) == 1
    assert middle[0].start == pytest.approx(beats[48], abs=0.55)
    assert middle[0].end == pytest.approx(beats[72], abs=0.55)
    assert middle[0].novelty > 0.3


@pytest.fixture(scope="module")
def demo() -> tuple[list[float], Song]:
    composed = demo_song(100.0, seed=1)
    mono = composed.samples.mean(axis=1).astype(np.float32)
    return [part.start for part in composed.sections], listen_samples(Audio(mono, composed.rate))


def test_most_sections_of_a_composed_song_are_found(demo: tuple[list[float], Song]) -> None:
    true, song = demo
    found = np.array([part.start for part in song.sections])
    assert sum(np.abs(found - start).min() < 1.5 for start in true) >= len(true) - 2
    assert sum(np.abs(np.array(true) - start).min() < 1.5 for start in found) >= len(found) - 2


def test_sections_cover_the_song_without_gaps(demo: tuple[list[float], Song]) -> None:
    _, song = demo
    assert song.sections[0].start == 0.0
    assert song.sections[-1].end == song.duration
    for before, after in zip(song.sections[:-1], song.sections[1:], strict=True):
        assert before.end == after.start
        assert after.start in song.beats
    assert {part.kind for part in song.sections} <= set(KINDS)


def test_a_short_song_is_one_section() -> None:
    song = listen_samples(Audio(demo_song(6.0).samples.mean(axis=1).astype(np.float32), 44100))
    assert [(part.start, part.end, part.kind) for part in song.sections] == [(0.0, song.duration, "main")]
