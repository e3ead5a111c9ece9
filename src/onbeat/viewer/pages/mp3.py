"""The song's sound inside the page: an MP3 as a data URI, and its waveform."""

from __future__ import annotations

import base64
import io

import numpy as np
import soundfile
import soxr

from onbeat._shapes import Array, Float32
from onbeat.errors import AudioError
from onbeat.viewer.contract import AudioData, CurveData, pack_curve

MP3_RATES = (8000, 11025, 12000, 16000, 22050, 24000, 32000, 44100, 48000)
"""Hz that an MP3 can hold."""
WAVEFORM_RATE = 50.0
"""Values of the waveform per second."""


def encode(samples: Float32, rate: int) -> AudioData:
    """Samples (N, channels) or (N,) in -1…1 as an MP3 of a steady bit rate; the same bytes for the same samples.

    Other rates than an MP3 can hold are resampled to 48 kHz, more than two channels are mixed to one.

    Raises
    ------
    AudioError
        If there are no samples, or one of them is not a finite number.
    """
    sound = _checked(samples, rate)
    if rate not in MP3_RATES:
        sound, rate = soxr.resample(sound, rate, 48000), 48000
    file = io.BytesIO()
    soundfile.write(
        file,
        np.clip(sound, -1.0, 1.0),
        rate,
        format="MP3",
        subtype="MPEG_LAYER_III",
        compression_level=0.6,
        bitrate_mode="CONSTANT",
    )
    uri = "data:audio/mpeg;base64," + base64.b64encode(file.getvalue()).decode("ascii")
    return AudioData(uri, len(sound) / rate, rate)


def waveform(samples: Float32, rate: int) -> CurveData:
    """Root mean square of each 20 ms, the loudest being 1."""
    sound = _checked(samples, rate)
    power = np.square(sound, dtype=np.float64).mean(axis=1)
    edges = np.unique((np.arange(0, len(sound) / rate * WAVEFORM_RATE) * rate / WAVEFORM_RATE).astype(np.int64))
    lengths = np.diff(np.append(edges, len(sound)))
    level: Array = np.sqrt(np.add.reduceat(power, edges) / lengths)
    return pack_curve(level / max(float(level.max()), 1e-9), WAVEFORM_RATE)


def _checked(samples: Float32, rate: int) -> Float32:
    """Samples (N, 1 or 2), float32."""
    sound = np.asarray(samples, np.float32)
    sound = sound[:, None] if sound.ndim == 1 else sound
    if sound.ndim != 2 or 0 in sound.shape or rate <= 0:
        raise AudioError(
            f"the page got samples of shape {np.shape(samples)} at {rate} Hz; (samples, channels) at a positive "
            "rate is needed; leave the audio out for a page without sound"
        )
    if not np.isfinite(sound).all():
        raise AudioError(f"sample {int(np.argmin(np.isfinite(sound).all(1)))} of the audio is not a finite number")
    return sound if sound.shape[1] <= 2 else sound.mean(axis=1, keepdims=True)
