"""Whether there is music to dance to: beats that are trusted, a break in them, or none."""

from __future__ import annotations

from onbeat.live.protocol import Hearing

AGREED, EVIDENT, ALONE = 4.0, 0.6, -2.0  # weights of the agreement and the evidence, and what is added to them
SMOOTH = 0.4  # [s] time constant of the belief
COME, GO = 0.6, -0.6  # belief from which there is music, and below which there is none
HOLD = 8.0  # [s] of a break through which the tempo is held


class Trust:
    """Follows whether beats are to be trusted.

    Examples
    --------
    >>> trust = Trust()
    >>> [trust.hear(0.9, 2.0, True, 0.1) for _ in range(9)][::8], trust.hear(0.1, -3.0, False, 1.0)
    (['nothing', 'music'], 'held')
    """

    def __init__(self) -> None:
        self.hearing: Hearing = "nothing"
        self._belief = -1.0
        self._held = 0.0

    def hear(self, agreement: float, evidence: float, moving: bool, seconds: float) -> Hearing:
        """Take a tick: share of the readings that agree, evidence for beats, whether the sound moves as music does."""
        said = AGREED * agreement + EVIDENT * min(evidence, 2.0) + ALONE if moving else -1.0
        self._belief += (min(max(said, -1.0), 1.0) - self._belief) * seconds / SMOOTH
        if self._belief > COME:
            self.hearing, self._held = "music", 0.0
        elif self.hearing == "music" and self._belief < GO:
            self.hearing = "held"
        if self.hearing == "held":
            self._held += seconds
            self.hearing = "held" if self._held < HOLD else "nothing"
        return self.hearing

    def believe(self) -> None:
        """Somebody else keeps time."""
        self.hearing, self._held = "music", 0.0
