"""What is to be known of a dance beside its figures: a tempo that is not the song's, and moves that are too few."""

from __future__ import annotations

import numpy as np

from onbeat.dance.document import DanceDocument
from onbeat.moves.library import MoveLibrary
from onbeat.music.tempo import DANCE_FASTEST, DANCE_SLOWEST, fold_of, tempo_of

REPEATED = 0.2
"""Share of a dance that shows what it has shown before from which on people will see it."""


def remarks(document: DanceDocument, library: MoveLibrary) -> list[str]:
    """A line for each thing that is to be known of a dance of a library's moves; none where all is as one expects."""
    return [line for line in (_tempo(document), _repeats(document, library)) if line]


def _tempo(document: DanceDocument) -> str:
    heard = document.heard_bpm
    if not heard:
        return ""
    danced = tempo_of(np.array(document.beats))
    return (
        f"{heard:.0f} BPM are heard, danced to at {fold_of(heard, danced)} of it ({danced:.0f}): "
        f"dances are at {DANCE_SLOWEST:.0f} to {DANCE_FASTEST:.0f} BPM"
    )


def _repeats(document: DanceDocument, library: MoveLibrary) -> str:
    again = document.metrics["variety"]["repeated_s"]
    if again < REPEATED * document.duration:
        return ""
    shown = f"{again:.0f} s of the dance ({again / document.duration:.0%}) show again what was shown before"
    if library.seconds < 2 * document.duration or document.method == "optimal":
        return (
            f"{shown}: {library.seconds:.0f} s of motion are little for {document.duration:.0f} s of song; "
            "add clips, or choose a shorter stretch of the song with --start and --seconds"
        )
    return f"{shown}: the method {document.method} does not keep from it as optimal does"
