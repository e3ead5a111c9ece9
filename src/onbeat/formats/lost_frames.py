"""What a file promised and does not hold: a warning, never silence."""

from __future__ import annotations

import warnings
from pathlib import Path


class LostFramesWarning(UserWarning):
    """A file holds fewer frames than it promises; those that are whole were read."""


def warn_of_lost_frames(path: Path, promised: int, whole: int) -> None:
    """Warn that only ``whole`` of the ``promised`` frames of a file are there."""
    warnings.warn(
        f"{path} promises {promised} frames and holds {whole} whole ones: these are read; is the file cut off?",
        LostFramesWarning,
        stacklevel=4,
    )
