"""Other beat trackers used live, as ``live_beats.py`` asks them, in any interpreter that has them.

Usage: ``python benchmarks/live_peers.py aubio|librosa SONG…`` prints a line of JSON for each song: when each beat is
said and CPU seconds. It needs nothing of onbeat; a peer that cannot be imported ends the program with status 3.

aubio's ``tempo`` is causal by itself: a beat is said at the end of the block of 512 samples that tells it. librosa's
PLP is not; it is used causally here: twice a second the predominant local pulse of the last 9 s is taken, its last
peaks say when the next beats are, and each is said when its time comes. That favours it twice: the onset
strength is that of the whole song (its range is taken from all of it), and beats are foretold, not waited for.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any

WINDOW = 9.0  # [s] that PLP sees
STEP = 0.5  # [s] between two looks


def aubio_live() -> Callable[[str], list[float]]:
    import aubio
    import numpy as np
    import soundfile

    def said(path: str) -> list[float]:
        samples, rate = soundfile.read(path, dtype="float32", always_2d=True)
        mono = np.ascontiguousarray(samples.mean(axis=1))
        tracker = aubio.tempo("default", 1024, 512, rate)
        blocks = range(0, len(mono) - 511, 512)
        return [(at + 512) / rate for at in blocks if tracker(mono[at : at + 512])[0]]

    return said


def librosa_live() -> Callable[[str], list[float]]:
    import librosa
    import numpy as np

    def said(path: str) -> list[float]:
        samples, rate = librosa.load(path)
        hop, late = 512, 1024 / rate
        strength = librosa.onset.onset_strength(y=samples, sr=rate, hop_length=hop)
        frames, beats, following, period = rate / hop, [], np.inf, 0.5
        for now in np.arange(2.0, len(samples) / rate, STEP):
            end = int((now - late) * frames) + 1
            begin = end - int(WINDOW * frames)
            part = np.concatenate([np.zeros(max(-begin, 0)), strength[max(begin, 0) : end]])
            peaks = (np.flatnonzero(librosa.util.localmax(pulse(part, rate))) + begin) / frames
            if len(peaks) > 2:
                period = float(np.median(np.diff(peaks[-5:])))
                after = float(peaks[-1]) + period
                last = beats[-1] if beats else 0.0
                following = after + max(np.ceil((last + 0.5 * period - after) / period), 0.0) * period
            while following < now + STEP:  # before the next look
                beats.append(max(following, now))
                following += period
        return [float(beat) for beat in beats]

    def pulse(part: Any, rate: float) -> Any:
        return librosa.beat.plp(onset_envelope=part, sr=rate, hop_length=512)

    return said


PEERS = {"aubio": aubio_live, "librosa": librosa_live}


def main() -> None:
    try:
        said = PEERS[sys.argv[1]]()
    except ImportError:
        sys.exit(3)
    for path in sys.argv[2:]:
        started = time.process_time()
        row: dict[str, Any] = {"said": said(path), "cpu": 0.0}
        row["cpu"] = time.process_time() - started
        print(json.dumps(row), flush=True)


if __name__ == "__main__":
    main()
