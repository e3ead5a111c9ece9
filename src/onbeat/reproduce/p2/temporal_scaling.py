"""P2: Shiratori, Kudoh, Nakaoka and Ikeuchi 2007, *Temporal Scaling of Upper Body Motion …*."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from onbeat.errors import OnbeatError
from onbeat.examples.performer import FADING, SHRINKING, TEMPO
from onbeat.reproduce.data import Data
from onbeat.reproduce.p2.seen import Seen, see, seen_parts
from onbeat.reproduce.p2.seen_claims import seen_claims
from onbeat.reproduce.p2.tried import Tried, tried, tried_parts
from onbeat.reproduce.p2.tried_claims import tried_claims
from onbeat.reproduce.result import PaperResult
from onbeat.retime.pollard2002 import STIFFNESS

SEEING = 0.3
"""Share of the work that is observing."""

Step = Callable[[float, str], None]
T = TypeVar("T")


class TemporalScaling:
    """The paper, done again."""

    key = "P2"
    title = "Temporal Scaling of Upper Body Motion for Sound Feedback System of a Dancing Humanoid Robot"

    def reproduce(self, data: Data, step: Step) -> PaperResult:
        """Observe takes at several speeds, put a dance on a robot by all methods, and let it dance in simulation.

        Raises
        ------
        OnbeatError
            If songs are given, of which nothing is heard here, or real files can neither be observed nor be danced by
            the robot.
        """
        if data.songs:
            raise OnbeatError(f"P2 hears no songs: leave out {data.songs[0]}; beats lie beside a take, NAME.beats")
        data.motion_files()  # says what is wrong with the paths
        seen, unseen = _or_why(lambda: see(data, lambda share, what: step(SEEING * share, what)))
        found, untried = _or_why(lambda: tried(data, lambda share, what: step(SEEING + (0.95 - SEEING) * share, what)))
        if seen is None and found is None:
            raise OnbeatError(f"nothing can be observed ({unseen}), and no robot can dance it ({untried})")
        step(0.95, "drawing")
        return PaperResult(
            key=self.key,
            title=self.title,
            citation="T. Shiratori, S. Kudoh, S. Nakaoka, K. Ikeuchi: Temporal Scaling of Upper Body Motion for Sound "
            "Feedback System of a Dancing Humanoid Robot. IEEE/RSJ International Conference on Intelligent Robots and "
            "Systems (IROS), 2007",
            paper_data="The Aizu-bandaisan dance, a Japanese folk dance, captured at 120 Hz at its original speed, at "
            "1.2× and at 1.5×, five times each; keyposes named by dance masters. The robot is HRP-2: the machine "
            "itself at 1.0×, in simulation at 1.2×.",
            our_data=("A first look only, with fewer dancers and takes. " if data.quick and data.embedded else "")
            + _our_data(seen, found),
            differs=_differs(data, unseen, untried, found),
            claims=(*seen_claims(seen, unseen), *tried_claims(found, untried)),
            parts=(
                *(() if seen is None else seen_parts(seen)),
                *(() if found is None else tried_parts(found)),
            ),
        )


PAPER = TemporalScaling()


def _or_why(work: Callable[[], T]) -> tuple[T | None, str]:
    """What comes out, or why it does not."""
    try:
        return work(), ""
    except OnbeatError as error:
        return None, str(error)


def _our_data(seen: Seen | None, found: Tried | None) -> str:
    lines = list[str]()
    if seen is not None:
        speeds = ", ".join(f"{len(seen.first.takes.at(speed))} at {speed:g}×" for speed in seen.first.takes.speeds)
        dancers = f"{len(seen.every)} dancers, takes of each {speeds}" if len(seen.every) > 1 else f"takes {speeds}"
        lines.append(f"Observed: {seen.first.takes.title}; {dancers}; {seen.first.takes.takes[0].motion.fps:g} Hz.")
    if found is not None:
        motion = found.solo.motion
        where = "in simulation" if found.danced else "its angles alone"
        lines.append(
            f"On the robot: {motion.name}, {motion.duration:.1f} s with {len(found.solo.keyposes)} keyposes, on "
            f"{found.robot.body.name}, {where}."
        )
    return " ".join(lines)


def _differs(data: Data, unseen: str, untried: str, found: Tried | None) -> tuple[str, ...]:
    lines = list[str]()
    if data.embedded:
        lines += [
            "The dancers are made, not captured. Their motor model says that ornaments fade in faster music as "
            f"exp(−{FADING:g} (speed − 1)) and moves shrink as 1 − {SHRINKING:g} (speed − 1), that they rest on "
            "keyposes, and that they come up to 60 ms early or late to each. What is seen here is that the paper's "
            "analysis finds what was put in, and far less in the control that is merely played faster, where only who "
            "is early or late changes it. That people dance so is the paper's finding, and for takes of people to "
            "tell: --motions.",
            f"The dance is a folk dance of the troupe's, eight keyposes in twelve beats at {TEMPO:g} beats a minute; "
            "keyposes are the choreography's, not dance masters'.",
        ]
    if unseen:
        lines.append(f"Figs. 1, 3 and 4 are not drawn: {unseen}.")
    if untried:
        lines.append(f"Figs. 6 to 9 are not drawn: {untried}.")
    if found is not None and found.why:
        lines.append(
            f"Nothing is simulated, and Figs. 7 and 9 are not drawn: {found.why}. The robot's angles are found without "
            "regard to collisions."
        )
    if found is not None and found.danced:
        lines.append(
            "HRP-4C's torques are not public, those of the simulation are assumed; balance is onbeat's own; legs "
            "follow the tasks of Nakaoka et al., whose method the paper uses. No real robot was moved."
        )
    if found is None:
        return tuple(lines)
    return (
        *lines,
        "The robot is AIST's HRP-4C: the limits of speed of HRP-2, the paper's, are not public.",
        "“layers2007” is the paper's method, guarded: its layers go on to knots four beats apart and count from the "
        "joint's mean, for as printed they draw joints towards 0 radians. It stands beside, “as printed”.",
        "“qp” is onbeat's own method: of all motions inside the limits the one nearest to the dance. “pollard2002” is "
        "Pollard's filter; “uniform” plays all of the dance more slowly until nothing is past a limit.",
        f"The gains of Pollard's filter are not in the paper; {STIFFNESS:.0f} 1/s² is what errs least on arms of real "
        "dances (benchmarks/retime.py).",
        "Figs. 2 and 5 are drawings of the method without results, and are not drawn again.",
    )
