"""Hearing as published in Sec. III of Shiratori, Nakazawa & Ikeuchi 2006.

"Synthesizing Dance Performance Using Musical and Motion Features", ICRA 2006.

Kept literal, for comparison: one band of linear power, a beat interval from the autocorrelation alone (so halves and
doubles of the tempo occur), beats that follow the onsets and lag behind them a little. The paper stops at the degree of
chord change; downbeats are its Assumption 3 taken at its word: of the four bar phases, the one with most chord change.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from onbeat._shapes import Array, Float32, Times
from onbeat.music.harmony.chords import between_beats
from onbeat.music.hearing import Progress
from onbeat.music.intensity import RATE, normalised
from onbeat.music.song import Song
from onbeat.music.spectrum import SpectrumStream, bin_frequencies
from onbeat.music.tempo import tempo_of

NAME = "shiratori2006"
WINDOW, HOP = 0.046, 0.01  # [s] of the onset component
TONE_WINDOW, TONE_HOP = 0.186, 0.05  # [s] of the histogram of frequencies
SHORTEST_INTERVAL, LONGEST_INTERVAL = 0.3, 1.0  # [s] 200 to 60 BPM; the paper gives no limits
SEARCH = 0.25  # of the interval, on either side of a predicted beat
CHORD_BAND = (0.0, 500.0)  # [Hz] Eq. 6
MELODY_BAND = (250.0, 1000.0)  # [Hz] Eq. 7
METER = 4


def previous_power(power: Array) -> Array:
    """Eq. 4: ``max(p(t−1, f), p(t−1, f±1))`` for t = 1…N−1, as (N − 1, bins)."""
    before = np.pad(power[:-1], ((0, 0), (1, 1)), mode="edge")
    return np.maximum(np.maximum(before[:, :-2], before[:, 2:]), before[:, 1:-1])


def onset_component(power: Array) -> Array:
    """Eq. 3 summed over frequency, ``D(t) = Σ_f d(t, f)``, for t = 1…N−2: (N − 2,) from power (N, bins).

    >>> onset_component(np.array([[0.0], [2.0], [3.0]])).tolist()
    [3.0]
    """
    before = previous_power(power)[:-1]
    now, following = power[1:-1], power[2:]
    grows = np.minimum(now, following) >= before
    return np.where(grows, np.maximum(now, following) - before, 0.0).sum(axis=1, dtype=np.float64)


def beat_interval(onsets: Array, rate: float) -> float:
    """Average beat interval in seconds: the highest peak of the autocorrelation of the onset component."""
    size = 1 << (2 * len(onsets) - 1).bit_length()
    spectrum = np.fft.rfft(onsets - onsets.mean(), size)
    correlation = np.fft.irfft(spectrum.real**2 + spectrum.imag**2, size)
    first, last = round(SHORTEST_INTERVAL * rate), min(round(LONGEST_INTERVAL * rate), len(onsets) - 2)
    lag = first + int(correlation[first : last + 1].argmax())
    left, middle, right = correlation[lag - 1 : lag + 2]
    curve = left - 2.0 * middle + right
    shift = 0.5 * (left - right) / curve if curve < 0.0 and middle >= max(left, right) else 0.0
    return float((lag + shift) / rate)


def beat_phase(onsets: Array, rate: float, interval: float) -> float:
    """Time of the first beat: the highest cross-correlation of the onset component with a pulse train."""
    period = interval * rate
    offsets = np.arange(int(period))
    pulses = np.arange(max(int((len(onsets) - 1) / period), 1)) * period
    frames = np.minimum(np.round(offsets[:, None] + pulses).astype(np.int64), len(onsets) - 1)
    return float(onsets[frames].sum(axis=1).argmax() / rate)


def follow_beats(onsets: Array, rate: float, interval: float, first: float) -> Times:
    """Each beat moves to the local maximum of the onset component near where the one before predicts it."""
    reach = max(round(SEARCH * interval * rate), 1)
    beats: list[float] = []
    expected = first * rate
    while expected < len(onsets):
        low = max(round(expected) - reach, 0)
        window = onsets[low : round(expected) + reach + 1]
        beat = float(low + window.argmax()) if len(window) and window.max() > 0.0 else expected
        beats.append(beat)
        expected = beat + interval * rate
    return np.array(beats) / rate


def dominant(power: Float32) -> Float32:
    """The power where it is a local maximum over frequency, 0 elsewhere: the dominant frequencies of each frame."""
    peaks = np.zeros_like(power)
    inner = power[:, 1:-1]
    peaks[:, 1:-1] = np.where((inner > power[:, :-2]) & (inner >= power[:, 2:]), inner, 0.0)
    return peaks


def histogram_peaks(frames: Float32, rate: float, beats: Times) -> Array:
    """``P_peak(τ, f)``: the peaks of the histogram of dominant frequencies from each beat to the next."""
    return dominant(between_beats(frames, rate, beats).astype(np.float32)).astype(np.float64)


def chord_change_degree(peaks: Array, frequencies: Array) -> Array:
    """Eqs. 5–6: ``Σ_{0–500 Hz} max(P_peak(τ, f) − P_peak(τ−1, f), 0)`` for each beat; 0 for the first.

    >>> chord_change_degree(np.array([[1.0, 0.0], [0.0, 3.0]]), np.array([100.0, 200.0])).tolist()
    [0.0, 3.0]
    """
    band = (frequencies >= CHORD_BAND[0]) & (frequencies <= CHORD_BAND[1])
    rises = np.maximum(np.diff(peaks[:, band], axis=0), 0.0).sum(axis=1)
    return np.concatenate([[0.0], rises])


def melody_intensity(peaks: Array, frequencies: Array) -> Array:
    """Eq. 7: ``Σ_{250 Hz–1 kHz} P_peak(τ, f)`` for each beat."""
    band = (frequencies >= MELODY_BAND[0]) & (frequencies <= MELODY_BAND[1])
    return peaks[:, band].sum(axis=1)


def _spectra(blocks: Iterable[Float32], rate: int, progress: Progress | None) -> tuple[Array, Float32, Array, float]:
    """Onset component (frame t at t · HOP), dominant frequencies up to 1 kHz, their Hz, and the duration."""
    onset_stream = SpectrumStream(2 * round(WINDOW * rate / 2), round(HOP * rate))
    window = 2 * round(TONE_WINDOW * rate / 2)
    tone_stream = SpectrumStream(window, round(TONE_HOP * rate))
    bins = int(MELODY_BAND[1] * window / rate) + 2
    held: Float32 | None = None
    onsets: list[Array] = [np.zeros(1)]
    tones: list[Float32] = []
    samples = 0

    def keep(short: Float32, long: Float32) -> None:
        nonlocal held
        joined = short if held is None else np.concatenate([held, short])
        if len(joined) > 2:
            onsets.append(onset_component(joined.astype(np.float64)))
        held = joined[-2:]
        tones.append(dominant(long[:, :bins]))

    for block in blocks:
        keep(onset_stream.push(block), tone_stream.push(block))
        samples += len(block)
        if progress:
            progress(samples / rate)
    keep(onset_stream.finish(), tone_stream.finish())
    return np.concatenate(onsets), np.concatenate(tones), bin_frequencies(window, rate)[:bins], samples / rate


def listen_shiratori2006(blocks: Iterable[Float32], rate: int, progress: Progress | None = None) -> Song:
    """Hear a song given as mono blocks, as the paper does."""
    onsets, tones, frequencies, duration = _spectra(blocks, rate, progress)
    frame_rate, tone_rate = rate / round(HOP * rate), rate / round(TONE_HOP * rate)
    interval = beat_interval(onsets, frame_rate)
    beats = follow_beats(onsets, frame_rate, interval, beat_phase(onsets, frame_rate, interval))
    beats = beats[beats < duration]
    peaks = histogram_peaks(tones, tone_rate, beats)
    change = chord_change_degree(peaks, frequencies)
    bar = int(np.argmax([change[phase::METER].mean() if phase < len(change) else 0.0 for phase in range(METER)]))
    times = np.arange(int(duration * RATE) + 1) / RATE
    return Song(
        duration=duration,
        tempo=tempo_of(beats),
        meter=METER,
        beats=beats,
        downbeats=beats[bar::METER],
        chord_change=np.clip(change / max(float(np.percentile(change, 95)), 1e-30), 0.0, 1.0),
        intensity_times=times,
        intensity=normalised(np.interp(times, beats, melody_intensity(peaks, frequencies))),
        method=NAME,
        beat_strength=onsets[np.round(beats * frame_rate).astype(np.int64)] / max(float(onsets.max()), 1e-30),
    )
