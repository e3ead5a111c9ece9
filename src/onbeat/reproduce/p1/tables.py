"""Table I of the 2006 paper and what its Sec. VI says in words, beside ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from onbeat.music.song import Song
from onbeat.reproduce.p1.dances import Danced
from onbeat.reproduce.p1.songs import TRACKED, WITHIN, Tune, found, interval
from onbeat.reproduce.result import Row, TableResult

PRINTED = (("La Bamba", "0.598 s (100)"), ("Do Me", "0.447 s (134)"), ("Nutcracker Suite", "0.714 s (84)"))
"""Table I as printed: seconds from beat to beat, and BPM."""

Dances = Mapping[str, Sequence[Danced]]
"""Dances by method (``dances.METHODS``), one a song, in one order."""


def tracked(tune: Tune, heard: Song) -> bool:
    """Whether a song's beats are found."""
    return found(tune, heard) >= TRACKED


def beat_table(tunes: Sequence[Tune], *, composed: bool) -> TableResult:
    """Table I: average intervals of beats, the paper's songs first, and how many songs are tracked."""
    named: list[tuple[str, str | None]] = [(tune.title, None) for tune in tunes]
    if composed:
        named[: len(PRINTED)] = [
            (f"“{name}” in the paper; here {tune.title}", value)
            for (name, value), tune in zip(PRINTED, tunes[: len(PRINTED)], strict=False)
        ]
    rows = [_beat_row(label, paper, tune) for (label, paper), tune in zip(named, tunes, strict=True)]
    if not composed:
        rows = [Row(f"“{name}”", value, "not among these songs", "", ("", "")) for name, value in PRINTED] + rows
    known = [tune for tune in tunes if tune.known != "heard"]
    rows += [_count_row(known)] if known else []
    true = {"composed": "as composed", "annotated": "as annotated"}[known[0].known] if known else "not known"
    return TableResult(
        "Table I",
        "Beat tracking: average interval of the beats",
        tuple(rows),
        ("song", "paper", "ours, heard as published", "ours, heard by onbeat", f"true, {true}", "note"),
        _beat_remark(tunes),
    )


def _beat_row(label: str, paper: str | None, tune: Tune) -> Row:
    told = [_interval(song) for song in (tune.published, tune.ours)]
    if tune.known == "heard":
        return Row(label, paper, told[0], "", (told[1], "–"))
    note = " / ".join(f"F {found(tune, song):.2f}" for song in (tune.published, tune.ours))
    return Row(label, paper, told[0], note, (told[1], _interval(tune.truth)))


def _interval(song: Song) -> str:
    seconds = interval(song.beats)
    return f"{seconds:.3f} s ({60 / seconds:.0f})" if seconds else "no beats"


def _count_row(tunes: Sequence[Tune]) -> Row:
    told = [f"{sum(tracked(t, s(t)) for t in tunes)} of {len(tunes)}" for s in (_published, _ours)]
    return Row("songs tracked", "10 of 13", told[0], f"F ≥ {TRACKED:g} within ±{1000 * WITHIN:.0f} ms", (told[1], "–"))


def _published(tune: Tune) -> Song:
    return tune.published


def _ours(tune: Tune) -> Song:
    return tune.ours


def late(tunes: Sequence[Tune], which: str) -> float:
    """Median seconds by which heard beats are later than the true ones they are nearest to, within 100 ms."""
    every: list[float] = []
    for tune in tunes:
        heard, true = getattr(tune, which).beats, tune.truth.beats
        if len(heard) and len(true):
            apart = heard[:, None] - true
            nearest = apart[np.arange(len(heard)), np.abs(apart).argmin(axis=1)]
            every += nearest[np.abs(nearest) <= 0.1].tolist()
    return float(np.median(every)) if every else 0.0


UNKNOWN = (
    "Where “true” is not told it is not known here: put the beats of NAME.wav into NAME.beats beside it, a second a "
    "line, and the song is judged."
)


def _beat_remark(tunes: Sequence[Tune]) -> str:
    known = [tune for tune in tunes if tune.known != "heard"]
    if not known:
        return UNKNOWN
    lag = " and ".join(f"{1000 * late(known, which):+.0f} ms" for which in ("published", "ours"))
    return (UNKNOWN + " " if len(known) < len(tunes) else "") + (
        "The songs are others than the paper's, so the intervals can only be held against what is true of them. "
        f"Heard as published and by onbeat, beats lie {lag} after the true ones at the median. The note gives F of "
        "the beats by both. The paper does not say when a song counts as tracked; here it is by F, which asks for "
        "the beats' places, not for their interval alone."
    )


RHYTHM = (
    ("beats with a stop within 100 ms", "recall100", "most"),
    ("stops within 100 ms of a beat", "precision100", None),
    ("F within 50 ms", "f50", None),
    ("F within 100 ms", "f100", None),
    ("… of the beats as heard", "heard_f100", None),
    ("deviations above jittered beats", "f50_jitter_z", None),
)
"""What is measured of the rhythm: in words, by its name, and what the paper says."""


def median(dances: Sequence[Danced], name: str, *, before: bool = False) -> float | None:
    """The median of a score over the songs; None where no song has it."""
    values = [(one.before if before else one.scores)[name] for one in dances]
    known = [value for value in values if value is not None]
    return float(np.median(known)) if known else None


def rhythm_table(dances: Dances) -> TableResult:
    """Of how many beats have their stop: by the search as published, by onbeat and by chance."""
    columns = (("published", False), ("ours", True), ("ours", False), ("walk", True), ("walk", False))
    rows: list[Row] = []
    for label, name, paper in RHYTHM:
        told = [shown(median(dances[method], name, before=before), name) for method, before in columns]
        rows.append(Row(label, paper, told[0], "", tuple(told[1:])))
    heads = ("", "paper", "ours, as published", "onbeat, before its time warp", "onbeat", "random walk")
    count = len(dances["published"])
    return TableResult(
        "Sec. VI, rhythm",
        "Beats matched by stops of the hands",
        tuple(rows),
        (*heads, "random walk, warped", "note"),
        f"Medians over {count} song{'s' if count != 1 else ''}, with stops found again on the finished joints. The "
        "time warp moves the stops of any dance onto beats, those of a random walk too: a dance is as good as it is "
        "above that. Deviations are above what the same stops score with every beat moved at random by up to half an "
        "interval.",
    )


INTENSITY_HEADS = (
    "song", "paper", "ours, as published", "… rhythm alone", "… Eq. 12 from the mean", "onbeat", "… rhythm alone",
    "random walk", "note",
)  # fmt: skip


def intensity_table(dances: Dances) -> TableResult:
    """The ablation of Fig. 8: the correlation of motion and music with the intensity component and without it."""
    methods = ("published", "published rhythm", "published centred", "ours", "ours rhythm", "walk")
    rows = [
        Row(
            danced.tune.title,
            None,
            shown(danced.scores["intensity_pearson"], "r"),
            f"{danced.tune.truth.tempo:.0f} BPM",
            tuple(shown(dances[method][k].scores["intensity_pearson"], "r") for method in methods[1:]),
        )
        for k, danced in enumerate(dances["published"])
    ]
    measured: tuple[tuple[str, str, str | None, str], ...] = (
        ("median", "intensity_pearson", "matched", ""),
        ("median by Eq. 2", "intensity_eq2_pearson", None, "motion is the paper's own component"),
        ("median, as heard", "heard_pearson", None, "with the intensity that the dance was made by"),
        ("mean speed of the hands", "hand_speed", None, "m/s"),
        ("F within 100 ms", "f100", "matched", "the rhythm, for comparison"),
    )
    for label, name, paper, note in measured:
        told = [shown(median(dances[method], name), name) for method in methods]
        rows.append(Row(label, paper, told[0], note, tuple(told[1:])))
    return TableResult(
        "Sec. VI, intensity",
        "Correlation of the motion’s intensity with the music’s, with both components and with rhythm alone",
        tuple(rows),
        INTENSITY_HEADS,
        _intensity_remark(dances),
    )


def _intensity_remark(dances: Dances) -> str:
    speeds = [shown(median(dances[name], "hand_speed"), "") for name in ("published", "published rhythm")]
    return (
        "The paper shows this by pictures and gives no number. Motion is the mean speed of the hands, music the "
        "intensity that is true of the song, both smoothed over 1.4 s. Eq. 12 as printed multiplies two components "
        "that are never negative, so that of two paths the one of more movement wins in loud music and in soft: with "
        f"it the hands move at {speeds[0]} m/s, without it at {speeds[1]}. The paper's words call it a correlation: "
        "“from the mean” is the same search with the music's intensity counted from its mean, so that soft music asks "
        "for little movement. onbeat compares ranks of both."
    )


def shown(value: float | None, name: str) -> str:
    """A score as it is printed: shares and correlations with two digits, deviations with one.

    >>> shown(-0.001, "r"), shown(-0.25, "f50_jitter_z"), shown(None, "r")
    ('0.00', '−0.2', '–')
    """
    if value is None:
        return "–"
    digits = 1 if name.endswith("_z") else 2
    return f"{round(value, digits) + 0.0:.{digits}f}".replace("-", "−")  # adding 0 makes −0 a 0
