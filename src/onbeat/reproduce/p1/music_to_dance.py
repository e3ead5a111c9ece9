"""P1: Shiratori, Nakazawa and Ikeuchi 2006, *Synthesizing Dance Performance Using Musical and Motion Features*."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from onbeat.dance.shiratori2006 import BEST_PATHS
from onbeat.motion.features import RATE, HandFeatures, hand_features
from onbeat.moves.library import MoveLibrary
from onbeat.reproduce.data import Data
from onbeat.reproduce.p1.choice import Choice, choice_before
from onbeat.reproduce.p1.claims import claims
from onbeat.reproduce.p1.dances import METHODS, Danced, dance, open_library
from onbeat.reproduce.p1.figures import (
    MATCH,
    WINDOW,
    features_figure,
    intensity_figure,
    matched,
    matching_figure,
)
from onbeat.reproduce.p1.pictures import POSES, choice_figure, dance_figure
from onbeat.reproduce.p1.songs import Tune, check_songs, tunes
from onbeat.reproduce.p1.tables import Dances, beat_table, intensity_table, rhythm_table, shown, tracked
from onbeat.reproduce.result import FigureResult, PaperResult

DANCED, FEW_DANCED = 10, 3
"""Songs that are danced to at most; the paper danced to the ten that it tracked, and shows three."""
SHOWN = 8.0
"""Seconds of a clip whose features are drawn."""
HEARING, DANCING = 0.33, 0.62
"""Shares of the work."""

Step = Callable[[float, str], None]


class MusicToDance:
    """The paper, done again."""

    key = "P1"
    title = "Synthesizing Dance Performance Using Musical and Motion Features"

    def reproduce(self, data: Data, step: Step) -> PaperResult:
        """Hear the songs, dance to them as published and as onbeat does, and draw the paper's figures.

        Raises
        ------
        OnbeatError
            If a song or clip cannot be read, or the clips cannot fill a song.
        """
        check_songs(data)
        step(0.0, "joining clips")
        library = open_library(data)  # before songs are heard, which takes longer: what is wrong is said at once
        songs = tunes(data, lambda share, what: step(HEARING * share, what))
        every = _dances(danced_to(songs, FEW_DANCED if data.quick else DANCED), library, data.seed, step)
        step(HEARING + DANCING, "drawing")
        return PaperResult(
            key=self.key,
            title=self.title,
            citation="T. Shiratori, A. Nakazawa, K. Ikeuchi: Synthesizing Dance Performance Using Musical and Motion "
            "Features. IEEE International Conference on Robotics and Automation (ICRA), 2006. "
            "doi:10.1109/ROBOT.2006.1642260",
            paper_data="26 captured motions of about 5 s from the CMU motion capture database, 19 of ballet and 7 of "
            "simple dance, 32 markers at 120 Hz; 13 songs of about 60 s, of which the 10 whose beats were tracked were "
            "danced to.",
            our_data=_our_data(data, songs, library, len(every["published"])),
            differs=_differs(data, songs),
            claims=claims(songs, every),
            parts=(
                _figure_2(library),
                *_figure_5(every["published"][0], library),
                beat_table(songs, composed=not data.songs),
                _figure_6(every),
                _figure_7(every),
                rhythm_table(every),
                _figure_8(every),
                intensity_table(every),
            ),
        )


PAPER = MusicToDance()


def danced_to(songs: Sequence[Tune], most: int) -> list[Tune]:
    """The songs that are danced to: those whose beats are tracked as published, as in the paper.

    Where nobody knows the beats, or none is tracked, all count.
    """
    good = [tune for tune in songs if tune.known == "heard" or tracked(tune, tune.published)]
    return (good or list(songs))[:most]


def _dances(songs: Sequence[Tune], library: MoveLibrary, seed: int, step: Step) -> Dances:
    every: dict[str, list[Danced]] = {name: [] for name in METHODS}
    total = len(songs) * len(METHODS)
    for number, tune in enumerate(songs):
        for place, (name, method) in enumerate(METHODS.items()):
            done = (number * len(METHODS) + place) / total
            step(HEARING + DANCING * done, f"dancing to {tune.title}: {name}")
            every[name].append(dance(tune, library, method, seed))
    return every


KINDS = {
    "composed": "songs composed by onbeat, whose beats and intensity are known",
    "annotated": "songs from files, with annotated beats",
    "heard": "songs from files, whose true beats are not known",
}
"""How the beats of songs are known, in words."""


def _our_data(data: Data, songs: Sequence[Tune], library: MoveLibrary, danced: int) -> str:
    seconds = sum(clip.seconds for clip in library.clips)
    source = "danced by onbeat's own troupe" if data.embedded else "from the files given"
    kinds = [tune.known for tune in songs]
    heard = " and ".join(f"{kinds.count(kind)} {words}" for kind, words in KINDS.items() if kind in kinds)
    rates = sorted({clip.fps for clip in library.clips})
    good = [tracked(tune, tune.published) for tune in songs if tune.known != "heard"]
    which = "those that are tracked as published, first ones first" if any(good) else "tracked or not"
    first_look = "A first look only, with fewer and shorter songs: " if data.quick else ""
    return (
        f"{first_look}{len(library.clips)} motions {source}, {seconds:.0f} s in all, kept at "
        f"{', '.join(f'{rate:g}' for rate in rates)} Hz; {heard}, of "
        f"{max(tune.truth.duration for tune in songs):.0f} s at most; {danced} of them are danced to, {which}."
    )


def _differs(data: Data, songs: Sequence[Tune]) -> tuple[str, ...]:
    lines: list[str] = []
    if data.embedded:
        lines.append(
            "The dancers are made, not captured: a program moves them, and by construction their hands stop on a "
            "steady pulse. That such stops are found and brought onto beats can be seen here; that people stop so "
            "cannot. With --motions the same is done on captured dance."
        )
    else:
        lines.append("The clips are those given, not the paper's 26: other moves, of other lengths.")
    if data.songs:
        lines.append("The songs are those given, so that none stands beside the paper's three.")
    else:
        lines.append(
            "The songs are composed and played by a program; the first three have the tempi of the paper's Table I. "
            "Their beats are plainer than those of a band, but what is true of them is known. With --songs other songs "
            "are heard."
        )
    if any(tune.known == "heard" for tune in songs):
        lines.append("Where the true beats of a song are not known, dances are judged by those that onbeat hears.")
    lines += [
        "“As published” is our reading of the paper's text. What it leaves open is chosen here, for "
        "all songs alike: the widths σ1 and σ2, the smoothing of the hands, how many paths count as best (16 at most, "
        "within 5 % of the first), and what is a stop (the hand moves on both sides of it).",
        "Eq. 9 as printed prefers fast poses; all dances here use one motion graph, by the distance that it stands "
        "for.",
        "The paper's own program and dances are not public: whether ours do what they did can only be judged by what "
        "the paper says. Figs. 1, 3 and 4 explain the method and show no results; they are not drawn. Times of "
        "computing are left out, for they tell of machines.",
    ]
    return tuple(lines)


def _figure_2(library: MoveLibrary) -> FigureResult:
    features = [hand_features(clip.motion) for clip in library.clips]
    alike = [_likeness(one) for one in features]
    chosen = int(np.argmin(alike))
    found, clip = features[chosen], library.clips[chosen]
    length = min(SHOWN, clip.seconds)
    start = float(np.floor(10 * (clip.seconds - length) / 2) / 10)
    stops = [int(((one >= start) & (one <= start + length)).sum()) for one in found.stops]
    return FigureResult(
        "Fig. 2",
        "Speed of both hands, and the motion features made of it",
        features_figure(found, start, length),
        "The speeds of both hands over time, and under them how the keyframe component rises where hands stop, most "
        "where both stop together, and the intensity component where hands move fast between two stops.",
        f"{length:.1f} s of “{clip.name}”, the clip whose hands move least alike. Dots are stops, minima of a hand's "
        f"speed with movement on both sides: {stops[0]} of the left hand, {stops[1]} of the right. Below are Eq. 1 "
        "with σ1 = 0.1 s and Eq. 2 with σ2 = 0.25 s.",
    )


def _likeness(features: HandFeatures) -> float:
    """The correlation of the hands' speeds; 1 where one of them rests."""
    left, right = features.speeds.T
    still = left.std() < 1e-6 or right.std() < 1e-6 or len(left) < 2 * RATE
    return 1.0 if still else float(np.corrcoef(left, right)[0, 1])


def _figure_5(danced: Danced, library: MoveLibrary) -> tuple[FigureResult, ...]:
    moves = danced.dance.plan.moves
    if len(moves) < 2:
        return ()  # one clip lasts for all of the song: nothing was chosen
    choice = choice_before(danced.dance, library, (len(moves) - 1) // 2)
    found = FigureResult(
        "Fig. 5",
        "How the next path is chosen",
        choice_figure(choice, library),
        "A diagram of the synthesis: paths through the motion graph are held against the music's features, and the "
        "best of them is danced.",
        f"A real decision, {choice.second:.2f} s into the dance to {danced.tune.title}. There are {len(choice.paths)} "
        "ways to go on over the next 3 s, each shown with its best completion. Black ticks are joins to other clips, "
        "whose numbers stand below, blue is where the hands stop, red where the music has beats, by chord change. "
        f"{_chosen(choice)}",
        f"The paper says “several” paths; here {BEST_PATHS} at most.",
    )
    return (found,)


def _chosen(choice: Choice) -> str:
    """Among how many paths Eq. 12 chose, and what they reach."""
    reached, others = choice.intensity[choice.chosen], np.delete(choice.intensity[: choice.best], choice.chosen)
    if not len(others):
        return "One path alone is best by rhythm, and is danced."
    span = f"{others.min():.0f} to {others.max():.0f}" if len(others) > 1 else f"{others[0]:.0f}"
    return (
        f"{choice.best} paths are best by rhythm; of these the most intense by Eq. 12 is danced, {reached:.0f}, where "
        f"the rest reach {span}."
    )


def _figure_6(every: Dances) -> FigureResult:
    danced = every["published"][0]
    beats, features = danced.dance.song.beats, danced.features
    first = max(0, min(len(beats) // 2, len(beats) - POSES))
    part = beats[first : first + POSES]
    hits = int(matched(part, features.body_stops).sum())
    return FigureResult(
        "Fig. 6",
        "The dance to the first song",
        dance_figure(danced, first),
        "Pictures of the dance made to “La Bamba”; the paper says that its rhythm matches the music's beat very well.",
        f"The dance to {danced.tune.title}, made as published: the pose on each of {len(part)} beats in a row, the "
        f"sound with the beats as heard, and the speed of the faster hand. {hits} of these {len(part)} beats have a "
        f"stop within {1000 * MATCH:.0f} ms; {shown(danced.scores['recall100'], 'r')} of all in the song.",
    )


def _figure_7(every: Dances) -> FigureResult:
    which = 1 % len(every["published"])
    rows = [(name, every[method][which]) for name, method in (("as published", "published"), ("onbeat", "ours"))]
    start = max(0.0, min(rows[0][1].tune.truth.duration / 2, rows[0][1].tune.truth.duration - WINDOW))
    told = [shown(danced.scores["recall100"], "r") for _, danced in rows]
    return FigureResult(
        "Fig. 7",
        "Beats of the music and stops of the motion",
        matching_figure(rows, float(np.floor(start))),
        "The beat component of “Do Me” in red and the keyframe component of the dance in blue; the paper says that "
        "most peaks of both match.",
        f"The same of {WINDOW:.0f} s of {rows[0][1].tune.title}, danced as published and by onbeat (after its time "
        f"warp). Of all beats of the song, {told[0]} and {told[1]} have a stop within {1000 * MATCH:.0f} ms. The "
        "height of a beat is its degree of chord change, which the search of 2006 counts it by.",
    )


def _figure_8(every: Dances) -> FigureResult:
    which = 2 % len(every["published"])
    columns = [
        (name, every[method][which], every[f"{method} rhythm"][which])
        for name, method in (("as published", "published"), ("onbeat", "ours"))
    ]
    told = [shown(one.scores["intensity_pearson"], "r") for _, *pair in columns for one in pair]
    centred = shown(every["published centred"][which].scores["intensity_pearson"], "r")
    return FigureResult(
        "Fig. 8",
        "With the intensity of the music, and with its rhythm alone",
        intensity_figure(columns),
        "Two dances to “The Nutcracker Suite”, made with rhythm and intensity (top) and with rhythm alone (bottom); "
        "the paper concludes that the first follows rhythm and intensity, and that the intensity component is needed.",
        f"The intensity of {columns[0][1].tune.title} and of the dances to it, in deviations from their means. As "
        f"published they correlate by {told[0]} with both components and {told[1]} with rhythm alone; by onbeat, "
        f"{told[2]} and {told[3]}. One song decides nothing: all of them are in the table below.",
        f"With Eq. 12 counted from the mean of the music's intensity the dance as published reaches {centred}; the "
        "table tells why.",
    )
