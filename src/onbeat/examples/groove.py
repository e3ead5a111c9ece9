"""The drummer of the embedded song: patterns, fills, and how they are struck."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Float32
from onbeat.examples.arrangement import Part
from onbeat.examples.drums import drum_kit
from onbeat.examples.mixing import Desk
from onbeat.examples.score import Score

# Patterns of a bar by meter and section: drum → (beat, strength)…; kicks stand on whole beats only.
Pattern = dict[str, tuple[tuple[float, float], ...]]
_EIGHTHS = {4: tuple(i / 2 for i in range(8)), 3: tuple(i / 2 for i in range(6))}


def _steady(meter: int, strong: float, weak: float) -> tuple[tuple[float, float], ...]:
    return tuple((beat, strong if beat % 1 == 0 else weak) for beat in _EIGHTHS[meter])


_PATTERNS: dict[int, dict[str, Pattern]] = {
    4: {
        "intro": {"kick": ((0, 0.7), (2, 0.5)), "shaker": _steady(4, 0.8, 0.5), "frame drum": ((1, 0.4), (3, 0.5))},
        "verse": {
            "kick": ((0, 1.0), (2, 0.9)),
            "snare": ((1, 0.65), (3, 0.75), (2.75, 0.12), (3.5, 0.14)),
            "hat": _steady(4, 0.8, 0.45),
            "frame drum": ((1.5, 0.3), (3.5, 0.4)),
        },
        "chorus": {
            "kick": ((0, 1.0), (1, 0.8), (2, 1.0), (3, 0.8)),
            "snare": ((1, 0.9), (3, 1.0), (1.75, 0.13), (2.75, 0.15)),
            "clap": ((1, 0.6), (3, 0.7)),
            "hat": _steady(4, 0.7, 0.4),
            "open hat": ((0.5, 0.4), (1.5, 0.45), (2.5, 0.4), (3.5, 0.45)),
            "tambourine": ((0, 0.4), (1, 0.8), (2, 0.4), (3, 0.9), (3.5, 0.3)),
            "frame drum": ((1.5, 0.4), (2.5, 0.3), (3.5, 0.5)),
        },
        "break": {"kick": ((0, 0.6),), "shaker": _steady(4, 0.55, 0.3)},
        "outro": {"kick": ((0, 0.8), (2, 0.7)), "shaker": _steady(4, 0.8, 0.5), "snare": ((1, 0.4), (3, 0.5))},
    },
    3: {
        "intro": {"kick": ((0, 0.7),), "shaker": _steady(3, 0.8, 0.45)},
        "verse": {
            "kick": ((0, 1.0),),
            "snare": ((1, 0.45), (2, 0.55), (2.5, 0.12)),
            "hat": _steady(3, 0.75, 0.35),
            "frame drum": ((2, 0.3), (2.5, 0.35)),
        },
        "chorus": {
            "kick": ((0, 1.0), (2, 0.5)),
            "snare": ((1, 0.7), (2, 0.8), (1.5, 0.13)),
            "clap": ((1, 0.5), (2, 0.6)),
            "hat": _steady(3, 0.7, 0.4),
            "open hat": ((0.5, 0.4), (1.5, 0.35), (2.5, 0.45)),
            "tambourine": ((0, 0.5), (1, 0.8), (2, 0.9)),
            "frame drum": ((1.5, 0.4), (2.5, 0.5)),
        },
        "break": {"kick": ((0, 0.6),), "shaker": _steady(3, 0.55, 0.3)},
        "outro": {"kick": ((0, 0.8),), "shaker": _steady(3, 0.8, 0.45), "snare": ((1, 0.35), (2, 0.4))},
    },
}
_DRUMS = {  # level, pan, room
    "kick": (0.85, 0.0, 0.02),
    "snare": (0.95, 0.08, 0.16),
    "frame drum": (0.65, -0.4, 0.2),
    "hat": (1.0, 0.35, 0.05),
    "open hat": (0.8, 0.35, 0.08),
    "shaker": (1.0, -0.3, 0.1),
    "tambourine": (0.95, 0.5, 0.15),
    "clap": (0.8, -0.12, 0.25),
    "tom": (0.5, -0.25, 0.18),
    "cymbal": (0.55, 0.2, 0.2),
}


def play_drums(desk: Desk, score: Score, rng: np.random.Generator) -> None:
    """Play the drums: on the grid to the sample where a beat is struck, eighths swung, strengths a little uneven."""
    kit = drum_kit(rng)
    for name, (level, pan, room) in _DRUMS.items():
        desk.track(name, level, pan, room)
    for index, part in enumerate(score.parts):
        if part.name == "chorus":
            desk.play("cymbal", kit["cymbal"], score.swung(part.first * score.meter))
        _play_part(desk, score, part, kit, rng, fill=index < len(score.parts) - 1)
    last = len(score.grid.beats) - 1
    for name, strength in (("kick", 1.0), ("cymbal", 0.9), ("tambourine", 0.8)):
        desk.play(name, kit[name], score.swung(last), strength)


def _play_part(
    desk: Desk, score: Score, part: Part, kit: dict[str, Float32], rng: np.random.Generator, fill: bool
) -> None:
    pattern = _PATTERNS[score.meter][part.name]
    for bar in range(part.first, part.first + part.bars):
        filling = fill and bar == part.first + part.bars - 1
        for name, strokes in pattern.items():
            for beat, strength in strokes:
                if filling and name in ("snare", "frame drum", "clap", "open hat") and beat >= score.meter - 1:
                    continue
                uneven = strength * float(np.exp(rng.normal(0.0, 0.09)))
                desk.play(name, kit[name], score.swung(bar * score.meter + beat), uneven)
        if filling:
            _fill(desk, score, bar, kit, rng, long=part.name in ("verse", "break"))


def _fill(desk: Desk, score: Score, bar: int, kit: dict[str, Float32], rng: np.random.Generator, long: bool) -> None:
    """Lead over to the next section: sixteenths that grow on the last beat, or the last two."""
    beats = 2 if long else 1
    end = (bar + 1) * score.meter
    for sixteenth in range(4 * beats):
        beat = end - beats + sixteenth / 4.0
        name = "tom" if sixteenth >= 4 * beats - 3 else "snare"
        strength = (0.3 + 0.6 * sixteenth / (4 * beats)) * float(np.exp(rng.normal(0.0, 0.08)))
        if sixteenth % 2 == 0 or rng.random() < 0.75:
            desk.play(name, kit[name], float(score.grid.time(beat)), strength)
