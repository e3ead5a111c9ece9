"""What the causal tracker hears: bands of sound that streams by, and how much of it begins at each moment.

The same features as the default method's (:mod:`onbeat.music.hearing`, :mod:`onbeat.music.onsets`), with every level
taken from what was heard so far. Frame ``k`` is centred at ``k * hop / rate`` seconds and complete half a window later.
The arithmetic runs frame by frame in one order, so that the size of the blocks changes no bit.
"""

from __future__ import annotations

import numba
import numpy as np

from onbeat._shapes import Array, Float32, Ints
from onbeat.errors import AudioError
from onbeat.music.hearing import BANDS_PER_OCTAVE, ONSET_HOP, ONSET_WINDOW, SILENCE
from onbeat.music.levels import FORGIVING, QUIETEST
from onbeat.music.observation import SOFT
from onbeat.music.onsets import EDGES, LAG
from onbeat.music.spectrum import SpectrumStream, bin_frequencies, log_bands

LOWEST_RATE, HIGHEST_RATE = 4000, 400000  # [Hz]
BANDS = 64  # those up to 10 kHz; lower rates leave the upper ones silent
FLOOR = 4.7  # [log10 power] under the loudest band of the loud passages, below which a sound is as good as none
PAUSE = 1.6  # [s] of silence that end music: no tempo is so slow
PATIENCE = 6.0  # [s] of a pause, after which they are forgotten faster
FORGETTING = 3.0  # [log10 power / s]
BREAK = 4.0  # [log10 power] under the loud passages, below which the music pauses
WEIGHTS = (2.0, 1.5, 1.0, 1.0, 0.7)  # of the groups of bands: what is low tells the beat, what is high its parts
SUM = 6.2  # of the weights
NEARBY, OVERALL = 2.5, 20.0  # [s] time constants over which loudness is adapted to
SHARED = 0.35  # share of the longer one
OUTLIER = 3.0  # times its level, above which a rise does not count for more in the level
SETTLED = 1.0  # [s] after which that holds


class BandStream:
    """Log10 power in bands an eighth of an octave apart, of sound that comes in blocks of any size.

    Parameters
    ----------
    rate : samples per second, 4 to 400 kHz.

    Raises
    ------
    AudioError
        If the rate is out of range.

    Examples
    --------
    >>> BandStream(22050).push(np.zeros(22050, np.float32)).shape
    (98, 64)
    """

    def __init__(self, rate: int) -> None:
        if not LOWEST_RATE <= rate <= HIGHEST_RATE:
            raise AudioError(
                f"a rate of {rate} samples per second; expected {LOWEST_RATE} to {HIGHEST_RATE}: resample the sound"
            )
        self.hop = round(ONSET_HOP * rate)
        self.half = round(ONSET_WINDOW * rate / 2)
        self._spectra = SpectrumStream(2 * self.half, self.hop)
        bands = log_bands(bin_frequencies(2 * self.half, rate), 40.0, min(10000.0, 0.45 * rate), BANDS_PER_OCTAVE)
        self._weights = np.ascontiguousarray(bands.T[:BANDS])
        used = self._weights > 0.0
        self._reach = np.stack([used.argmax(axis=1), used.shape[1] - used[:, ::-1].argmax(axis=1)], axis=1)

    def push(self, samples: Float32) -> Float32:
        """Bands (frames, 64) of all windows that are now complete."""
        return _log_power(self._spectra.push(samples), self._weights, self._reach, BANDS)


@numba.njit(cache=True)
def _log_power(spectra: Float32, weights: Float32, reach: Ints, bands: int) -> Float32:
    """Log10 of the power in each band; bands that the rate does not reach are silent."""
    result = np.full((len(spectra), bands), np.float32(np.log10(SILENCE)), np.float32)
    for frame in range(len(spectra)):
        for band in range(len(weights)):
            power = 0.0
            for bin in range(reach[band, 0], reach[band, 1]):
                power += spectra[frame, bin] * weights[band, bin]
            result[frame, band] = np.log10(max(power, SILENCE))
    return result


class OnsetStream:
    """How much new sound begins at each frame, against what was heard so far.

    Parameters
    ----------
    frame_rate : frames per second.

    Examples
    --------
    >>> levels = np.full((300, 64), -6.0, np.float32)
    >>> levels[50::50] = -2.0
    >>> onsets, sounding = OnsetStream(100.0).push(levels)
    >>> onsets[[60, 100, 110]].round(1).tolist()
    [0.0, 1.0, 0.0]
    """

    def __init__(self, frame_rate: float) -> None:
        self._lag = max(round(LAG * frame_rate), 1)
        frequencies = 40.0 * 2.0 ** (np.arange(BANDS) / BANDS_PER_OCTAVE)
        self._group = np.clip(np.searchsorted(EDGES, frequencies, side="right") - 1, 0, len(EDGES) - 2).astype(np.int64)
        self._constants = np.array([1.0 / frame_rate, 1.0 / (NEARBY * frame_rate), 1.0 / (OVERALL * frame_rate)])
        self._before = np.full((self._lag + 1, BANDS), np.log10(SILENCE), np.float32)
        self._levels = np.zeros((len(EDGES), 2))  # mean square nearby and overall of each group; of the strength
        # Frames so far, level of the loud passages, frames of music, seconds since the last sound.
        self._state = np.array([0.0, -np.inf, 0.0, 0.0])
        self.accents: Array = np.zeros((0, len(EDGES) - 1))

    def push(self, bands: Float32) -> tuple[Array, Array]:
        """Onset activation 0…1 (frames,) and how surely music sounds, 1…0; ``accents`` are the groups' (frames, 5)."""
        onsets, sounding = np.zeros(len(bands)), np.zeros(len(bands))
        self.accents = np.zeros((len(bands), len(EDGES) - 1))
        _onsets(
            bands, self._group, self._constants, self._before, self._levels, self._state, onsets, sounding, self.accents
        )
        return onsets, sounding


@numba.njit(cache=True)
def _onsets(
    bands: Float32,
    group: Ints,
    constants: Array,
    before: Float32,
    levels: Array,
    state: Array,
    onsets: Array,
    sounding: Array,
    accents: Array,
) -> None:
    """Run the levels over the frames: ``before``, ``levels`` and ``state`` go on, the last three are filled."""
    lag, count = len(before) - 1, bands.shape[1]
    soft, old = np.empty(count), np.empty(count)
    for frame in range(len(bands)):
        time = int(state[0])
        state[0] += 1.0
        top = bands[frame].max()
        forgiving = FORGIVING if state[3] < PATIENCE else FORGETTING
        state[1] = max(top, state[1] - forgiving * constants[0])
        floor = max(state[1], QUIETEST) - FLOOR
        before[time % (lag + 1)] = bands[frame]
        past = before[(time + 1) % (lag + 1)]
        for band in range(count):
            soft[band] = np.log10(1.0 + 0.1 * 10.0 ** (bands[frame, band] - floor))
            old[band] = np.log10(1.0 + 0.1 * 10.0 ** (past[band] - floor))
        flux = accents[frame]
        strength = 0.0
        for band in range(count):
            highest = max(old[max(band - 1, 0)], old[band], old[min(band + 1, count - 1)])
            flux[group[band]] += max(soft[band] - highest, 0.0)
        state[3] = 0.0 if top > max(QUIETEST, state[1] - BREAK) else state[3] + constants[0]
        sounding[frame] = max(1.0 - state[3] / PAUSE, 0.0) if state[1] > QUIETEST else 0.0
        for index in range(len(flux)):
            flux[index] = _adapted(flux[index], levels[index], constants, state[2], sounding[frame])
            strength += flux[index] * WEIGHTS[index] / SUM
        strength = _adapted(strength, levels[len(flux)], constants, state[2], sounding[frame])
        state[2] += np.ceil(sounding[frame])
        onsets[frame] = strength**2 / (strength**2 + SOFT**2)


@numba.njit(cache=True)
def _adapted(value: float, levels: Array, constants: Array, time: float, sounding: float) -> float:
    """A value over its root mean square so far, which is taken along; levels rest while nothing sounds."""
    level = np.sqrt((1.0 - SHARED) * levels[0] + SHARED * levels[1])
    counted = min(value, OUTLIER * level) if level > 0.0 and time * constants[0] > SETTLED else value
    if sounding > 0.0:
        for index in range(2):
            levels[index] += (counted**2 - levels[index]) * max(constants[1 + index], 1.0 / (time + 1.0))
    level = np.sqrt((1.0 - SHARED) * levels[0] + SHARED * levels[1])
    return value / max(level, 1e-9) if level > 1e-6 else 0.0
