"""Makes ``beats.json``: scores of three pairs of stops and beats. Run it only when a score is meant to change.

F, precision and recall are checked against mir_eval as they are written; the rest is what the module gives.
"""

import json
from pathlib import Path

import mir_eval
import numpy as np

from onbeat.metrics import beats


def cases() -> list[tuple[str, np.ndarray, np.ndarray]]:
    draw = np.random.default_rng(2006)
    music = np.cumsum(0.5 * 1.001 ** np.arange(56))  # a tempo that slows down
    close = music[draw.random(len(music)) < 0.7]
    return [
        ("random", np.sort(draw.uniform(0, 30, 40)), music),
        ("good", np.sort(close + draw.normal(0, 0.03, len(close))), music),
        ("late", close + 0.07, music),
    ]


def main() -> None:
    made = []
    for name, stops, music in cases():
        stops, music = np.round(stops, 4), np.round(music, 4)
        scores = beats.evaluate(stops, music, 30.0, np.random.default_rng(7))
        for label, tolerance in beats.TOLERANCES.items():
            assert abs(scores[f"f{label}"] - mir_eval.beat.f_measure(music, stops, tolerance)) < 1e-12
        made.append(
            {"name": name, "stops": stops.tolist(), "beats": music.tolist(), "duration": 30.0, "scores": scores}
        )
    Path(__file__).with_name("beats.json").write_text(json.dumps(made, indent=1) + "\n")


if __name__ == "__main__":
    main()
