"""What 2007 claims of dancers in faster music (Sec. II), and whether it holds in what was observed."""

from __future__ import annotations

import numpy as np

from onbeat.reproduce.p2.observed import bends_left, coarse_left, detail_left, difference, kept, likeness
from onbeat.reproduce.p2.seen import Seen, faster_of, hands_compared
from onbeat.reproduce.result import Claim
from onbeat.reproduce.shares import counted, most, spread

ALIKE = 0.9
"""Correlation from which on two curves are the same on the whole."""
MORE = 1.1
"""By how much a difference has to be larger to be called so."""
LESS = 0.95
"""What may be left at most of what is called less: curves of few takes differ by a few hundredths by chance."""
SAID = (
    "In faster music a dance stays the same on the whole: means of one layer are alike (Figs. 1 and 3)",
    "The more layers are looked at, the more do the means of the left shoulder differ (Fig. 3)",
    "In faster music the left shoulder's mean is a smoothed version of itself (Fig. 3)",
    "Insight 1: high frequencies are attenuated, the more the faster the music",
    "Insight 2: keyposes are preserved: most valleys that all curves of variance have are keyposes (Fig. 4)",
)


def seen_claims(seen: Seen | None, why: str = "") -> tuple[Claim, ...]:
    """The claims of Sec. II; ``why`` says why they cannot be told where nothing could be observed."""
    if seen is None:
        return tuple(Claim(said, None, f"Not observed: {why}.") for said in SAID)
    return (_whole(seen), _more_with_layers(seen), _smoother(seen), _insight_1(seen), _insight_2(seen))


def _whole(seen: Seen) -> Claim:
    first = seen.first
    alike = min(likeness(first, curves, 1) for curves in first.found.speeds[1:])
    hand = hands_compared(seen.hands[0])
    found = (
        f"The left shoulder's means correlate by {alike:.2f} at least; the hand's path is {hand.length:.0%} as long at "
        f"{faster_of(seen.hands[0]):g}×."
    )
    return Claim(SAID[0], alike > ALIKE, found, ("Fig. 1", "Fig. 3, numbers"))


def _more_with_layers(seen: Seen) -> Claim:
    first, control = seen.first, seen.control
    fast = first.found.speeds[-1]
    ends = [difference(first, fast, layers) for layers in (1, 3)]
    holds = ends[1] / max(ends[0], 1e-9) > MORE
    found = f"At {fast.speed:g}× they differ by {ends[0]:.1f}° of one layer and by {ends[1]:.1f}° of three"
    if control is not None:
        played = [difference(control, control.found.speeds[-1], layers) for layers in (1, 3)]
        holds = holds and ends[1] / max(ends[0], 1e-9) > played[1] / max(played[0], 1e-9)
        found += (
            f", merely played faster by {played[0]:.1f}° and {played[1]:.1f}°. The troupe's moves shrink as a whole in "
            "faster music, which one layer has, too; its ornaments are in its hands, forearms and head, not in its "
            "shoulders"
        )
    return Claim(SAID[1], bool(holds), found + ".", ("Fig. 3, numbers",))


def _smoother(seen: Seen) -> Claim:
    first, control = seen.first, seen.control
    fast = first.found.speeds[-1]
    bends = [bends_left(first, curves, 3) for curves in first.found.speeds]
    holds = bool((np.diff(bends) < 0).all() and bends[-1] < LESS)
    found = f"Of three layers it bends {bends[-1]:.2f} times as strongly at {fast.speed:g}×"
    if control is not None:
        played = bends_left(control, control.found.speeds[-1], 3)
        found += f", merely played faster {played:.2f} times"
        holds = holds and bends[-1] < LESS * played
    return Claim(SAID[2], holds, found + ".", ("Fig. 3, numbers",))


def _insight_1(seen: Seen) -> Claim:
    details = np.stack([detail_left(one) for one in seen.every])
    rest = np.stack([coarse_left(one) for one in seen.every])
    holds = bool((np.diff(details, axis=1) < 0).all() and (details[:, -1] < LESS * np.minimum(rest[:, -1], 1.0)).all())
    speed = seen.first.takes.speeds[-1]
    left = [spread(values[:, -1].tolist()) for values in (details, rest)]
    found = f"At {speed:g}× {left[0]} of the details are left, by dancer, and {left[1]} of the rest"
    if seen.controls:
        control = [float(detail_left(one)[-1]) for one in seen.controls]
        holds = holds and bool((details[:, -1] < LESS * np.array(control)).all())
        found += f"; merely played faster {spread(control)} of the details. The troupe is made so"
    return Claim(SAID[3], holds, found + ".", ("Insight 1",))


def _insight_2(seen: Seen) -> Claim:
    each = [told for one in seen.every if (told := kept(one)) is not None and told.valleys]
    if not each:
        return Claim(SAID[4], None, "The keyposes are not known, or there is no valley.")
    count = sum(told.valleys for told in each)
    right = round(sum(told.precision * told.valleys for told in each))
    recall, chance = (float(np.mean([getattr(told, key) for told in each])) for key in ("recall", "chance"))
    found = f"{counted(right, count)} valleys are keyposes; "
    holds = most(right, count)
    if holds is None:
        found += "so few do not tell it from the toss of a coin, by a sign test. "
    elif holds and recall <= 2 * chance:
        holds = None
        found += "but valleys that lie anywhere would nearly do as well. "
    found += f"{recall:.0%} of the keyposes have a valley, {chance:.0%} by chance."
    return Claim(SAID[4], holds, found, ("Insight 2", "Fig. 4"))
