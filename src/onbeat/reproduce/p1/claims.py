"""What the 2006 paper claims, and whether it holds here."""

from __future__ import annotations

from collections.abc import Sequence

from onbeat.reproduce.p1.dances import Danced
from onbeat.reproduce.p1.songs import Tune
from onbeat.reproduce.p1.tables import Dances, median, shown, tracked
from onbeat.reproduce.result import Claim
from onbeat.reproduce.shares import by_chance, counted, most

CLEAR = 3.0
"""Deviations above chance from which on stops follow the beats."""


def claims(tunes: Sequence[Tune], dances: Dances) -> tuple[Claim, ...]:
    """The claims of Sec. VI, in order."""
    return (_tracking(tunes), _matching(dances), _following(dances), _needed(dances))


def _tracking(tunes: Sequence[Tune]) -> Claim:
    said = "The beats of most songs are tracked (10 of 13)."
    known = [tune for tune in tunes if tune.known != "heard"]
    if not known:
        return Claim(said, None, "The true beats of these songs are not known.")
    published = sum(tracked(tune, tune.published) for tune in known)
    ours = sum(tracked(tune, tune.ours) for tune in known)
    others = f" The true beats of {len(tunes) - len(known)} more are not known." if len(known) < len(tunes) else ""
    return Claim(
        said,
        most(published, len(known)),
        f"Heard as published, {counted(published, len(known))} are tracked; by onbeat, {ours}.{others}",
        ("Table I",),
    )


def _matching(dances: Dances) -> Claim:
    recall, above = (median(dances["published"], name) for name in ("recall100", "f50_jitter_z"))
    chance = shown(median(dances["walk"], "recall100", before=True), "r")
    return Claim(
        "Most beats of the music meet a stop of the hands.",
        (recall or 0.0) > 0.5 and (above or 0.0) > CLEAR,
        f"As published, {shown(recall, 'r')} of the beats have a stop within 100 ms, {shown(above, '_z')} deviations "
        f"above beats moved at random; of a random walk's, {chance} have. By onbeat, "
        f"{shown(median(dances['ours'], 'recall100'), 'r')}.",
        ("Sec. VI, rhythm",),
    )


def _following(dances: Dances) -> Claim:
    r, by_chance, centred = (
        median(dances[name], "intensity_pearson") for name in ("published", "walk", "published centred")
    )
    return Claim(
        "The dance follows the intensity of the music.",
        r is not None and r > 0.3 and r > (by_chance or 0.0),
        f"As published, motion and music correlate by {shown(r, 'r')} at the median; a random walk by "
        f"{shown(by_chance, 'r')}; onbeat by {shown(median(dances['ours'], 'intensity_pearson'), 'r')}. Under 0.3 "
        "little of it would be seen. Eq. 12 as printed sums products of what is never negative, so that of two paths "
        "the one of more movement wins in soft music, too; with the music's intensity counted from its mean, a "
        f"correlation as the text calls it, the same search reaches {shown(centred, 'r')}.",
        ("Sec. VI, intensity",),
    )


def _needed(dances: Dances) -> Claim:
    pairs = list(zip(dances["published"], dances["published rhythm"], strict=True))
    more, ours_more = _more(pairs), _more(list(zip(dances["ours"], dances["ours rhythm"], strict=True)))
    centred = _more(list(zip(dances["published centred"], dances["published rhythm"], strict=True)))
    return Claim(
        "With the intensity component it is followed better than with rhythm alone.",
        most(more, len(pairs)),
        f"As published, in {more} of {len(pairs)} songs; by the toss of a coin so many or more are with "
        f"{by_chance(more, len(pairs)):.0%}. With Eq. 12 counted from the mean, in {centred}; by onbeat, in "
        f"{ours_more}.",
        ("Sec. VI, intensity",),
    )


def _more(pairs: Sequence[tuple[Danced, Danced]]) -> int:
    """Songs in which the first dance correlates more with the music than the second."""
    values = [[one.scores["intensity_pearson"] or 0.0 for one in pair] for pair in pairs]
    return sum(both > rhythm for both, rhythm in values)
