"""What 2007 claims of dancers in faster music (Sec. II), and whether it holds in what was observed."""

from __future__ import annotations

import numpy as np

from onbeat.reproduce.p2_observed import bends_left, coarse_left, detail_left, difference, kept, likeness
from onbeat.reproduce.p2_seen import Seen, faster_of, hands_compared, spread
from onbeat.reproduce.result import Claim

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
        return tuple(Claim(said, None, f"not observed: {why}") for said in SAID)
    return (_whole(seen), _more_with_layers(seen), _smoother(seen), _insight_1(seen), _insight_2(seen))


def _whole(seen: Seen) -> Claim:
    first = seen.first
    alike = [likeness(first, curves, 1) for curves in first.found.speeds[1:]]
    hand = hands_compared(seen.hands[0])
    told = ", ".join(f"{value:.2f}" for value in alike)
    found = f"correlation of the left shoulder's means {told}; the hand's path is {hand.length:.0%} as long at "
    return Claim(SAID[0], min(alike) > ALIKE, f"{found}{faster_of(seen.hands[0]):g}×")


def _more_with_layers(seen: Seen) -> Claim:
    first, control = seen.first, seen.control
    fast = first.found.speeds[-1]
    grown = difference(first, fast, 3) / max(difference(first, fast, 1), 1e-9)
    found = (
        f"at {fast.speed:g}× {difference(first, fast, 1):.1f}° of one layer, {difference(first, fast, 3):.1f}° of three"
    )
    holds = grown > MORE
    if control is not None:
        played = control.found.speeds[-1]
        ends = [difference(control, played, layers) for layers in (1, 3)]
        holds = holds and grown > ends[1] / max(ends[0], 1e-9)
        found += f"; merely played faster {ends[0]:.1f}° and {ends[1]:.1f}°"
        found += (
            ". The troupe's moves shrink as a whole in faster music, which one layer has, too; its ornaments are in "
        )
        found += "its hands, forearms and head, not in its shoulders"
    return Claim(SAID[1], bool(holds), found)


def _smoother(seen: Seen) -> Claim:
    first, control = seen.first, seen.control
    bends = [bends_left(first, curves, 3) for curves in first.found.speeds]
    found = "bends left, of three layers: " + ", ".join(
        f"{value:.2f} at {curves.speed:g}×" for value, curves in zip(bends[1:], first.found.speeds[1:], strict=True)
    )
    holds = bool((np.diff(bends) < 0).all() and bends[-1] < LESS)
    if control is not None:
        played = [bends_left(control, curves, 3) for curves in control.found.speeds[1:]]
        found += "; merely played faster " + ", ".join(f"{value:.2f}" for value in played)
        holds = holds and bends[-1] < LESS * played[-1]
    return Claim(SAID[2], holds, found)


def _insight_1(seen: Seen) -> Claim:
    details = np.stack([detail_left(one) for one in seen.every])
    rest = np.stack([coarse_left(one) for one in seen.every])
    holds = bool((np.diff(details, axis=1) < 0).all() and (details[:, -1] < LESS * np.minimum(rest[:, -1], 1.0)).all())
    speed = seen.first.takes.speeds[-1]
    left = [spread(values[:, -1].tolist()) for values in (details, rest)]
    found = f"at {speed:g}× {left[0]} of the details are left and {left[1]} of the rest"
    if seen.controls:
        control = [float(detail_left(one)[-1]) for one in seen.controls]
        holds = holds and bool((details[:, -1] < LESS * np.array(control)).all())
        found += f" ({len(seen.every)} dancers); merely played faster {spread(control)} of the details"
        found += ". The troupe is made so"
    return Claim(SAID[3], holds, found)


def _insight_2(seen: Seen) -> Claim:
    each = [told for one in seen.every if (told := kept(one)) is not None and told.valleys]
    if not each:
        return Claim(SAID[4], None, "the keyposes are not known, or there is no valley")
    count = sum(told.valleys for told in each)
    right = sum(told.precision * told.valleys for told in each) / count
    recall, chance = (float(np.mean([getattr(told, key) for told in each])) for key in ("recall", "chance"))
    found = f"{right:.0%} of the {count} valleys are keyposes; {recall:.0%} of the keyposes have one, "
    found += f"{chance:.0%} by chance"
    return Claim(SAID[4], right > 0.5 and recall > 2 * chance, found + f" ({len(each)} dancers)" * (len(each) > 1))
