"""What it is worth to show a frame of the library at a moment of the song.

Rhythm: each stop of the hands earns what the beat nearby is worth, less a constant ``OFF_BEAT``. With the constant at
half the F-measure that is reached, the best sum of these is also the best F-measure (Dinkelbach's form of the ratio
``F = 2 hits / (stops + beats)``), so that stops off the beat cost what they should. Intensity: the product of the
song's and the frame's, each as a z-scored rank, so that no scale has to be set. Both are sums over the frames
shown (Eqs. 11 and 12 of Shiratori et al. 2006 summed over the whole song), which is what makes the best path exact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.stats import rankdata

from onbeat._shapes import Array, Float32, Ints
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID
from onbeat.music.song import Song

FINE = 8  # beat table entries per graph frame: 240 Hz
HIT_WIDTH = 0.06
"""Seconds; a stop this far from its beat earns exp(−1/2) of it."""
OFF_BEAT = 0.42
"""What every stop costs; a stop on a beat earns 1 less this."""
INTENSITY = 0.78
"""λ: what a second costs or earns at one standard deviation of both intensities."""
MOST_INTENSE = 100.0
"""The highest λ that is taken."""
STANDING = 0.5
"""What a second costs in which the hands do not dance: quiet music asks for small movements, not for none."""
PHRASE = 0.75
"""Seconds, the smoothing of the song's intensity before it is ranked."""


@dataclass(frozen=True)
class Music:
    """A song as the search sees it: T graph frames.

    Parameters
    ----------
    beat_worth : ((T + 2 pad) · FINE,) worth of a stop at each instant, from ``pad`` frames before the song.
    intensity : (T,) z-scored rank of the intensity, times λ / GRID; zeros for rhythm only.
    """

    beat_worth: Float32
    intensity: Float32
    frames: int

    PAD = 4

    def part(self, begin: int, end: int) -> Music:
        """The song frames from ``begin`` up to ``end``."""
        worth = self.beat_worth[begin * FINE : (end + 2 * self.PAD) * FINE]
        return Music(worth, self.intensity[begin:end], end - begin)


def score_music(
    song: Song, *, rhythm_only: bool = False, beat_weights: Array | None = None, weight: float | None = None
) -> Music:
    """The song's side of the score: ``beat_weights`` (B,) 0…1 says what each beat is worth (all 1 by default).

    ``weight`` is λ, by default ``INTENSITY``; a ``PlanError`` says if it cannot be.
    """
    if weight is not None and not 0.0 <= weight <= MOST_INTENSE:
        raise PlanError(
            f"a weight {weight:g} of intensity cannot be; give 0 to {MOST_INTENSE:g} ({INTENSITY:g} is usual)"
        )
    frames = max(1, round(song.duration * GRID))
    times = (np.arange((frames + 2 * Music.PAD) * FINE) / FINE - Music.PAD) / GRID
    worth = np.zeros(len(times))
    weights = np.ones(len(song.beats)) if beat_weights is None else beat_weights
    for beat, worthy in zip(song.beats, weights, strict=True):
        low, high = np.searchsorted(times, (beat - 5 * HIT_WIDTH, beat + 5 * HIT_WIDTH))
        bump = worthy * np.exp(-0.5 * ((times[low:high] - beat) / HIT_WIDTH) ** 2)
        worth[low:high] = np.maximum(worth[low:high], bump)
    intensity = np.zeros(frames)
    if not rhythm_only and len(song.intensity):
        values = song.intensity_at((np.arange(frames, dtype=np.float64) + 0.5) / GRID)
        weighed = INTENSITY if weight is None else weight
        intensity = z_rank(gaussian_filter1d(values, PHRASE * GRID, mode="nearest")) * weighed / GRID
    return Music((worth - OFF_BEAT).astype(np.float32), intensity.astype(np.float32), frames)


def z_rank(values: Array) -> Array:
    """Ranks, made to have mean 0 and variance 1; constant values give zeros.

    Examples
    --------
    >>> z_rank(np.array([3.0, 1.0, 100.0])).round(2).tolist()
    [0.0, -1.22, 1.22]
    """
    ranks = rankdata(values)
    spread = float(np.std(ranks))
    return (ranks - np.mean(ranks)) / spread if spread > 0 else np.zeros(len(values))


@dataclass(frozen=True)
class Frames:
    """Library frames at all playback rates, as the search sees them: M virtual frames.

    Virtual frames of one clip at one rate lie in a row. A base frame is a frame of the motion graph.

    Parameters
    ----------
    base : (M,) the base frame shown (the nearest).
    rate : (M,) playback rate.
    second : (M,) second of its clip.
    left : (M,) frames of the same clip and rate that follow.
    entry : (R, N) for each rate and base frame, its virtual frame.
    stop_worth : (M,) weight of a stop shown at this frame, else 0.
    stop_shift : (M,) when in units of 1 / (GRID · FINE) s after the frame.
    intensity : (M,) z-scored rank of the motion's intensity.
    idle : (M,) what showing the frame costs because the body only stands there.
    block : (M,) which stretch of the source is shown, for variety.
    blocks : how many stretches there are.
    """

    base: Ints
    rate: Array
    second: Array
    left: Ints
    entry: Ints
    stop_worth: Float32
    stop_shift: Ints
    intensity: Float32
    idle: Float32
    block: Ints
    blocks: int

    def __len__(self) -> int:
        return len(self.base)
