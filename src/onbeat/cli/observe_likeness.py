"""Takes that do not look like one dance: told, for what is then observed means nothing."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np

from onbeat.retime.likeness import ALIKE
from onbeat.retime.takes import Repetitions


def tell_unlike(names: Sequence[str], repeated: Repetitions, likeness: Sequence[float]) -> None:
    """A line on stderr where repetitions are hardly alike: of which takes they are, how alike, and what to look at.

    Parameters
    ----------
    names : of the takes.
    repeated : the repetitions.
    likeness : of each of them; none where it is not known.
    """
    if not likeness:
        return
    every, of = np.array(likeness), repeated.takes
    each = {names[take]: float(every[of == take].mean()) for take in np.unique(of).tolist()}
    unlike = {name: value for name, value in each.items() if value < ALIKE}
    if not unlike:
        return
    told = ", ".join(f"{name} ({value:z.2f})" for name, value in unlike.items())
    do, like = "does" if len(unlike) == 1 else "do", "one dance" if len(unlike) == len(each) else "the others"
    ask = "are all of one dance, and is the first beat of each the same place of it (NAME.beats beside it)?"
    if len(each) == 1:
        told, do, ask = f"the cycles of {told}", "do", f"does the dance repeat after {repeated.period:g} beats?"
    print(  # noqa: T201
        f"onbeat: {told} {do} not look like {like}: likeness under {ALIKE:g}, that of different dances; slopes and "
        f"valleys then say nothing: {ask}",
        file=sys.stderr,
    )
