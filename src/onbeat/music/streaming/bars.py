"""Where in the bar a live tracker is: a forward filter over meter and position, one step a beat.

What tells a downbeat is known only when its beat is over, so each beat is weighed when the next one is said.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.music.bars import BREAK, METER_PRIOR, METERS

SHAPE_BANDS = slice(10, 42)  # 95 Hz to 1.4 kHz, where harmony is
OCTAVE = 8  # bands
MEMORY = 1.0 / 24.0  # share of the newest beat in the running mean and deviation of a cue
WEIGHTS = np.array([1.05, 0.9])  # of the cues: change of harmony, accent in the lowest group
LEAST = np.array([0.1, 0.5])  # deviation taken for a signal
BIAS = -0.4  # log odds of a beat with mean cues, over those of any beat
LEARNED = 0.6  # weight of the learned activation's say
BOUND = 2.5  # of the log odds from one beat
MIDDLE = 0.3  # how often the middle of a bar of four or six sounds like a downbeat: kick and bass are there, too
PRIOR_BEATS = 40.0  # after so many the prior on meters counts once more: chance agreements do not add up to a meter


def _chances() -> tuple[Array, Array, Array]:
    """Position in the bar of each state (meter, position), its prior, and the chance from row to column."""
    positions = np.array([position for meter in METERS for position in range(meter)])
    prior = np.array([share / meter for meter, share in zip(METERS, METER_PRIOR, strict=True) for _ in range(meter)])
    starts = np.flatnonzero(positions == 0)
    chance = BREAK * np.tile(prior, (len(prior), 1))
    for state in range(len(positions)):
        last = state + 1 == len(positions) or positions[state + 1] == 0
        chance[state, starts[starts <= state][-1] if last else state + 1] += 1.0 - BREAK
    return positions, prior, chance


class BarFilter:
    """How likely each meter and position in the bar is.

    Attributes
    ----------
    position : 0 at a downbeat, of the newest beat.
    meter : beats in a bar.

    Examples
    --------
    >>> bars = BarFilter()
    >>> for beat in range(13):
    ...     bars.step(2.0 if beat % 3 == 1 else -1.0)
    >>> bars.meter, bars.position
    (3, 0)

    A kick on one and three, the harder one on one, is no bar of two:

    >>> for beat in range(41):
    ...     bars.step((2.5, -1.0, 1.2, -1.0)[(beat - 1) % 4])
    >>> bars.meter, bars.position
    (4, 0)
    """

    def __init__(self) -> None:
        self._positions, self._prior, self._chance = _chances()
        self._meters = np.repeat(METERS, METERS)
        middle = (self._meters > 2) & (2 * self._positions == self._meters)
        self._downbeat = np.where(self._positions == 0, 1.0, np.where(middle, MIDDLE, 0.0))
        self._usual = np.repeat(METER_PRIOR, METERS) ** (1.0 / PRIOR_BEATS)
        self._share = self._prior.copy()
        self.position, self.meter = 0, 4

    def step(self, log_odds: float) -> None:
        """Go on by a beat; ``log_odds`` is how much the beat before sounded like a downbeat."""
        heard = 1.0 + self._downbeat * (np.exp(log_odds) - 1.0)
        weighed = self._share * heard * self._usual
        self._share = (weighed / weighed.sum()) @ self._chance
        state = int(self._share.argmax())
        self.position, self.meter = int(self._positions[state]), int(self._meters[state])

    def doubt(self) -> None:
        """The reading of the beats has changed: half of the knowledge is gone."""
        self._share = 0.5 * (self._share + self._prior)


class BarCues:
    """What was heard since the last beat, and what it tells of that beat."""

    def __init__(self) -> None:
        self._shape = np.zeros(SHAPE_BANDS.stop - SHAPE_BANDS.start)
        self._harmony = np.zeros((2, OCTAVE))  # after the last beat, before it
        self._bass, self._beat, self._downbeat = 0.0, 0.0, 0.0
        self._mean, self._square, self._beats = np.zeros(2), np.zeros(2), 0

    def hear(self, bands: Float32, bass: float, since: float, learned: Float32 | None) -> None:
        """Take one frame: its bands, its lowest accent, the frames since the beat, the learned probabilities."""
        self._shape += np.maximum(bands[SHAPE_BANDS] + 8.0, 0.0)
        if abs(since) <= 3.0:
            self._bass = max(self._bass, bass)
            if learned is not None:
                self._beat, self._downbeat = max(self._beat, learned[0]), max(self._downbeat, learned[1])

    def log_odds(self, learned: bool) -> float:
        """How much the beat whose time is over sounded like a downbeat; the next one's begins."""
        peaks = self._shape - np.convolve(self._shape, np.full(5, 0.2), "same")
        octave = np.maximum(peaks, 0.0).reshape(-1, OCTAVE).sum(axis=0)
        octave /= max(float(np.linalg.norm(octave)), 1e-9)
        cues = np.array([1.0 - float(octave @ self._harmony.mean(axis=0)), self._bass])
        self._harmony = np.stack([octave, self._harmony[0]])
        said = self._scaled(cues) @ WEIGHTS + BIAS
        if learned:
            other = max(self._beat - self._downbeat, 0.0)
            said += LEARNED * np.log((self._downbeat + 0.02) / (other + 0.02))
        self._shape[:] = 0.0
        self._bass = self._beat = self._downbeat = 0.0
        return float(np.clip(said, -BOUND, BOUND))

    def _scaled(self, cues: Array) -> Array:
        self._beats += 1
        share = max(MEMORY, 1.0 / self._beats)
        self._mean += share * (cues - self._mean)
        self._square += share * (cues**2 - self._square)
        deviation = np.sqrt(np.maximum(self._square - self._mean**2, 0.0))
        return np.clip((cues - self._mean) / np.maximum(deviation, LEAST), -2.0, 2.0)
