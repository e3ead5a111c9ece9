"""The default tracker's causal form: beats as they happen, from blocks of samples of any size.

Each frame of 10 ms is weighed once (onsets and a learned activation, as log odds), taken by the forward filter of the
bar-pointer model, and forgotten: memory and cost do not grow. Times are on the clock of the samples: second 0 is the
first sample pushed. A frame is complete half a window after its centre, and ``emitted_at`` counts that.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from onbeat._shapes import Array, Float32, Times
from onbeat.errors import AudioError
from onbeat.music.activation import CausalActivation
from onbeat.music.streaming.announcing import Announcer
from onbeat.music.streaming.bars import BarCues, BarFilter
from onbeat.music.streaming.features import BANDS, BandStream, OnsetStream
from onbeat.music.streaming.forward import ForwardFilter
from onbeat.music.streaming.presence import MOVING, Presence

EMPTY = 0.4  # onset activation at which a moment is as likely a beat as not
GAIN = 5.0  # log odds per unit of onset activation
LEARNED_GAIN = 1.06  # log odds per log odds of the learned activation
LEARNED_BIAS = 0.3  # log odds added to them: a beat is rare
ONSET_SHARE = 0.5  # of the onsets' log odds, beside the learned ones
EAGER, SHARPER = 0.8, 0.25  # log odds, and share of them, by which an unsure tracker listens harder
DELAY = 0.0  # [s] that the filter is early
CONFIDENCE = np.array([0.38, 0.26, 0.47])  # log odds of a right beat, per log odds of the share, evidence, alone
EVIDENCE = 3.0  # [s] time constant of the evidence
FAMILIAR = 1.0  # [s] of music until it is trusted
HOLD = 8.0  # [s] without music, through which beats are still said
PIECE = 4.0  # [s] of sound worked on at a time
LOUDEST = 1e2  # times full scale, to which samples are clipped


@dataclass(frozen=True)
class Beat:
    """A beat that a live tracker says.

    Parameters
    ----------
    time : seconds on the samples' clock.
    position : in the bar, 1 at the downbeat.
    confidence : 0…1, how likely it is right.
    emitted_at : seconds on the samples' clock when it was said, before or after its time.
    """

    time: float
    position: int
    confidence: float
    emitted_at: float

    @property
    def downbeat(self) -> bool:
        """Whether it begins a bar."""
        return self.position == 1


class CausalTracker:
    """Hears beats in sound that streams by.

    Parameters
    ----------
    rate : samples per second, 4 to 400 kHz.
    ahead : seconds that a beat is said before its time; negative waits to hear it first.
    learned : whether the learned activation is used beside the onsets.

    Raises
    ------
    AudioError
        If the rate is out of range.

    Examples
    --------
    >>> clicks = np.zeros(22050 * 6 + 2000, np.float32)
    >>> clicks[::11025] = 1.0
    >>> tracker = CausalTracker(22050)
    >>> beats = tracker.push(clicks)
    >>> round(tracker.tempo), tracker.next_beats(2).round(1).tolist()
    (120, [6.5, 7.0])
    """

    def __init__(self, rate: int, ahead: float = 0.0, learned: bool = True) -> None:
        self._rate = rate
        self._ahead = ahead
        self._learned = learned
        self.reset()

    def reset(self) -> None:
        """Forget all that was heard; the clock begins at 0."""
        self._bands = BandStream(self._rate)
        self._frame_rate = self._rate / self._bands.hop
        self._late = self._bands.half / self._rate
        self._onsets = OnsetStream(self._frame_rate)
        self._presence = Presence(self._frame_rate, BANDS)
        self._activation = CausalActivation() if self._learned else None
        self._filter = ForwardFilter(self._frame_rate)
        self._announcer = Announcer((self._late + self._ahead + DELAY) * self._frame_rate + 0.5)
        self._bars = BarFilter()
        self._cues = BarCues()
        self._samples = 0
        self._moved = 0.0
        self._evidence = 0.0  # [1/s] that there are beats
        self._paused, self._music = HOLD, 0.0  # [s] since music was heard, and of it
        self._last = float("-inf")

    def push(self, samples: Float32) -> list[Beat]:
        """Take the next samples (n,), mono, any number of them; the beats that are said meanwhile.

        Raises
        ------
        AudioError
            If the samples are not one row of numbers; none of them is taken then.
        """
        block = self._checked(samples)
        self._samples += len(block)
        piece = round(PIECE * self._rate)
        parts = (block[at : at + piece] for at in range(0, len(block), piece))
        return [beat for part in parts for beat in self._frames(self._bands.push(part)) if beat]

    def _checked(self, samples: Any) -> Float32:
        block = np.asarray(samples)
        if block.ndim != 1 or block.dtype.kind != "f":
            raise AudioError(
                f"samples of shape {block.shape} and kind {block.dtype}; expected floats (n,) of ±1: mix to mono"
            )
        finite = np.isfinite(block)
        if not finite.all():
            at = int(finite.argmin())
            raise AudioError(
                f"sample {at} of the block ({(self._samples + at) / self._rate:.3f} s) is {block[at]}; "
                "expected numbers, full scale ±1: check the input, push the block without it"
            )
        return np.clip(block, -LOUDEST, LOUDEST).astype(np.float32)

    def _frames(self, bands: Float32) -> Iterable[Beat | None]:
        onsets, sounding = self._onsets.push(bands)
        moved = self._presence.push(bands, sounding)
        heard = self._activation.push(bands) if self._activation else None
        odds = _log_odds(onsets, heard)
        for frame in range(len(bands)):
            unsure = 1.0 - min(self._announcer.share, 1.0)
            weight = (1.0 + SHARPER * unsure) * float(sounding[frame])
            gained = self._filter.step(weight * (float(odds[frame]) + EAGER * unsure), float(sounding[frame]))
            self._evidence += (gained * self._frame_rate - self._evidence) / (EVIDENCE * self._frame_rate)
            self._moved = float(moved[frame])
            self._keep_time()
            since = self._filter.frames - 1 - self._last
            self._cues.hear(
                bands[frame], float(self._onsets.accents[frame, 0]), since, None if heard is None else heard[frame]
            )
            yield self._say(self._announcer.follow(self._filter))

    def _keep_time(self) -> None:
        """Seconds of music so far, and of what is none since."""
        if self.is_music:
            self._paused = 0.0
            self._music += 1.0 / self._frame_rate
        else:
            self._paused += 1.0 / self._frame_rate
            self._music = self._music if self._paused < HOLD else 0.0

    def _say(self, frame: float | None) -> Beat | None:
        if frame is None:
            return None
        self._last = frame
        self._bars.step(self._cues.log_odds(self._learned))
        if self._paused >= HOLD:
            return None
        emitted = (self._filter.frames - 1) / self._frame_rate + self._late
        return Beat(self._time(frame), self._bars.position + 1, self.confidence, emitted)

    def _time(self, frame: float) -> float:
        return frame / self._frame_rate + DELAY

    @property
    def time(self) -> float:
        """Seconds of sound pushed so far."""
        return self._samples / self._rate

    @property
    def is_music(self) -> bool:
        """Whether what sounds moves as music does; silence, a hum and noise do not."""
        return self._moved > MOVING

    @property
    def agreement(self) -> float:
        """Share 0…1 of all readings of the music that agree with the one that is followed."""
        return float(min(max(self._announcer.share, 0.0), 1.0))

    @property
    def evidence(self) -> float:
        """How much likelier the last seconds are with beats than without, as a logarithm per second."""
        return float(self._evidence)

    @property
    def tempo(self) -> float:
        """Beats per minute; 0 before there are any."""
        return 60.0 * self._frame_rate / self._announcer.period if self._announcer.period else 0.0

    @property
    def confidence(self) -> float:
        """How likely the next beat is right, 0…1."""
        if not self._announcer.period:
            return 0.0
        share = min(max(self._announcer.share, 1e-6), 0.999)
        odds = CONFIDENCE @ np.array([np.log(share / (1.0 - share)), self._evidence, 1.0])
        known = (1.0 - np.exp(-self._music / FAMILIAR)) * np.exp(-self._paused)
        return float(known / (1.0 + np.exp(-odds)))

    @property
    def meter(self) -> int:
        """Beats in a bar."""
        return self._bars.meter

    @property
    def position(self) -> float:
        """Beats since the downbeat, 0 up to the meter, at the end of the samples pushed so far."""
        return (self._bars.position + self._beats_since_said(self.time)) % self._bars.meter

    def phase(self, time: float) -> float:
        """Share of a beat, 0…1, that has passed at a time since the beat before; 0 before there are any."""
        return self._beats_since_said(time) % 1.0

    def _beats_since_said(self, time: float) -> float:
        period = self._announcer.period
        return (time - self._time(self._announcer.next_at)) * self._frame_rate / period + 1.0 if period else 0.0

    def next_beats(self, count: int) -> Times:
        """Times in seconds of the next beats after the samples pushed so far; none before there are any."""
        period = self._announcer.period / self._frame_rate
        if not period:
            return np.zeros(0)
        first = self._time(self._announcer.next_at)
        first -= np.ceil((first - self.time) / period - 1.0) * period
        return first + period * np.arange(count)


def _log_odds(onsets: Array, heard: Float32 | None) -> Array:
    """Log odds of a beat at each frame."""
    by_onsets = GAIN * (onsets - EMPTY)
    if heard is None:
        return by_onsets
    chance = np.clip(heard[:, 0].astype(np.float64), 0.005, 0.995)
    return ONSET_SHARE * by_onsets + LEARNED_GAIN * (np.log(chance / (1.0 - chance)) + LEARNED_BIAS)
