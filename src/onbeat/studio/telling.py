"""How far a job is: its stages, each with its part of the whole, as one share that only grows."""

from __future__ import annotations

from collections.abc import Callable, Mapping


class Tell:
    """Told a stage and its share, says the share of the whole.

    Parameters
    ----------
    say : is told the share of the whole, 0…1, and what is done now.
    parts : of each stage how much of the whole it is, in their order; stages that are not named count as nothing.

    Examples
    --------
    >>> tell = Tell(lambda share, what: print(f"{share:.2f} {what}"), {"listening": 1, "dancing": 3})
    >>> tell("dancing", 0.5)
    0.62 dancing
    """

    def __init__(self, say: Callable[[float, str], None], parts: Mapping[str, float] | None = None) -> None:
        self._say, self._before = say, 0.0
        self._begin: dict[str, tuple[float, float]] = {}
        total = sum((parts or {}).values())
        passed = 0.0
        for stage, part in (parts or {}).items():
            self._begin[stage] = passed / total, part / total
            passed += part

    def __call__(self, stage: str, share: float, detail: str = "") -> None:
        """Say that ``share`` of ``stage`` is done, and what of it is done now."""
        begin, part = self._begin.get(stage, (self._before, 0.0))
        self._before = begin
        self._say(begin + part * min(max(share, 0.0), 1.0), detail or stage)

    def of(self, parts: Mapping[str, float]) -> Tell:
        """One that knows these stages."""
        return Tell(self._say, parts)
