"""The sections of a song: where the music becomes another (novelty), and of what kind each part is (intensity)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.signal import find_peaks

from onbeat._shapes import Array, Float32, Ints, Times
from onbeat.music.harmony.chords import between_beats
from onbeat.music.loudness import short_term_loudness
from onbeat.music.profile import Profile
from onbeat.music.song import Section, Song

KINDS = ("intro", "build-up", "break", "main", "ending")
REACH = 16  # beats on either side that are compared: four bars of four
NEW = 0.08  # novelty at which a section begins
STANDS_OUT = 0.05  # that its peak has to rise over the valleys beside it
SHORTEST = 8  # beats
GRID = 0.5  # [s] that stands for beats where a song has none
STEP, SLOPE = 0.12, 0.3  # of intensity: what sets a section off from others; what it climbs in a build-up
EDGE = 0.3  # share of the song within which an introduction ends, or an ending begins
# Of harmony, colour, loudness and new sound: how much each counts, and the least spread taken for a change.
SHARES = (1.0, 1.0, 1.0, 0.5)
SPREADS = (0.05, 0.02, 0.01, 0.02)
DECIBELS = 20.0  # of loudness that count as 1
FAINTEST = -1.5  # loudness under the song's loud passages, in those units, below which all is silence


def novelty(features: Array, reach: int = REACH) -> Array:
    """How different the music after each row is from that before it: (B,), the squared distance of the two means.

    Foote's (2000) checkerboard kernel along the diagonal of the self-similarity matrix. With similarity as the product
    ``S(i, j) = f_i · f_j`` and a kernel ``sgn(i) g(i) sgn(j) g(j)`` with Gaussian g, that is the squared length of
    ``Σ g f`` after minus ``Σ g f`` before, so that the matrix is never made. Beyond its ends the song goes on as there.

    >>> novelty(np.repeat([[0.0], [1.0]], 20, axis=0))[[2, 20, 37]].round(3).tolist()
    [0.0, 1.0, 0.0]
    """
    if not len(features):
        return np.zeros(0)
    weight = np.exp(-0.5 * ((np.arange(reach) + 0.5) / (0.5 * reach)) ** 2)
    weight /= weight.sum()
    padded = np.pad(features, ((reach, reach), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach, axis=0)[: len(features)]
    return ((windows @ np.concatenate([-weight[::-1], weight])) ** 2).sum(axis=1)


def section_features(profile: Profile, beats: Times) -> Array:
    """What a section is told by, from each beat to the next: harmony, colour, loudness, new sound; (B, 22).

    Each group is scaled so that its spread over the song is its share: what never changes in a song says nothing.
    """
    chroma = profile.chroma(beats).sum(axis=1)
    loud = short_term_loudness(profile.power, profile.rate, 1.0) / DECIBELS
    floor = float(np.percentile(loud, 95)) + FAINTEST
    groups = (
        chroma / np.maximum(np.linalg.norm(chroma, axis=1, keepdims=True), 1e-9),
        _sliced(profile.colours, profile, beats),
        between_beats(np.maximum(loud, floor)[:, None], profile.rate, beats),
        _sliced(profile.news[:, None], profile, beats),
    )
    scaled: list[Array] = []
    for values, share, least in zip(groups, SHARES, SPREADS, strict=True):
        rest = values - values.mean(axis=0)
        scaled.append(rest * np.sqrt(share / max(float((rest**2).sum(axis=1).mean()), least)))
    return np.concatenate(scaled, axis=1) / (2.0 * np.sqrt(sum(SHARES)))  # the clearest step there is has novelty 1


def _sliced(frames: Array | Float32, profile: Profile, beats: Times) -> Array:
    """Means between beats, of frames whose loud passages are brought to 1 whatever the volume."""
    return between_beats(frames / max(float(np.percentile(frames.sum(axis=1), 95)), 1e-9), profile.rate, beats)


def find_sections(song: Song, profile: Profile) -> list[Section]:
    """The sections of a song, one after the other from 0 to its end; they begin at downbeats where there are any."""
    enough = len(song.beats) >= 2 * SHORTEST
    beats = song.beats if enough else np.arange(0.0, song.duration, GRID)
    if len(beats) < 2 * SHORTEST:
        return [Section(0.0, song.duration, "main")]
    change = novelty(section_features(profile, beats))
    found = find_peaks(change, height=NEW, prominence=STANDS_OUT, distance=SHORTEST)[0]
    starts = _at_downbeats(found, change, np.isin(beats, song.downbeats) if enough else np.zeros(len(beats), np.bool_))
    starts = starts[(starts >= SHORTEST) & (starts <= len(beats) - SHORTEST)]
    edges = [0.0, *beats[starts].tolist(), song.duration]
    news = [0.0, *np.clip(change[starts], 0.0, 1.0).tolist()]
    kinds = name_sections(*_levels(song, edges), np.diff(edges))
    return [Section(*part) for part in zip(edges[:-1], edges[1:], kinds, news, strict=True)]


def _at_downbeats(peaks: Ints, change: Array, downbeats: np.ndarray) -> Ints:
    """Each peak moved to the downbeat within two beats at which most changes, if there is one."""
    moved: list[int] = []
    for peak in peaks.tolist():
        near = [beat for beat in range(max(peak - 2, 0), min(peak + 3, len(change))) if downbeats[beat]]
        moved.append(max(near, key=change.__getitem__) if near else peak)
    return np.unique(np.array(moved, dtype=np.int64))


def _levels(song: Song, edges: Sequence[float]) -> tuple[Array, Array]:
    """Mean intensity of each section, and how much it climbs from its first third to its last."""
    means: list[float] = []
    climbs: list[float] = []
    for start, end in pairwise(edges):
        values = song.intensity_at(np.linspace(start, end, 30, endpoint=False))
        means.append(float(values.mean()))
        climbs.append(float(values[20:].mean() - values[:10].mean()))
    return np.array(means), np.array(climbs)


def name_sections(levels: Array, climbs: Array, lengths: Array) -> list[str]:
    """Names of sections by their mean intensity, how much it climbs within them, and their length in seconds.

    >>> name_sections(np.array([0.2, 0.8, 0.4, 0.9, 0.3]), np.zeros(5), np.array([10.0, 30.0, 10.0, 30.0, 10.0]))
    ['intro', 'main', 'break', 'main', 'ending']
    """
    last = len(levels) - 1
    usual = float(np.average(levels, weights=lengths))
    ends = np.cumsum(lengths) / lengths.sum()
    kinds: list[str] = []
    for part, (level, climb) in enumerate(zip(levels, climbs, strict=True)):
        low = level < usual - STEP
        before, after = levels[max(part - 1, 0)], levels[min(part + 1, last)]
        if part < last and climb > SLOPE and after > level + STEP:
            kinds.append("build-up")
        elif low and ends[part] <= EDGE and all(kind == "intro" for kind in kinds) and after >= level:
            kinds.append("intro")
        elif part == last and part > 0 and low and ends[part - 1] >= 1.0 - EDGE:
            kinds.append("ending")
        elif 0 < part < last and low and level < before - 0.5 * STEP:
            kinds.append("break")
        else:
            kinds.append("main")
    return kinds
