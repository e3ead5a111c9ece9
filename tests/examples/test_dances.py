"""The dances put together from figures: so many keyposes a cycle, and the new figure dances as a body can."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.examples.choreography import LEAD
from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import CLAP_AND_BOW, DANCES, keyposes_of, perform_dance
from onbeat.examples.performer import Performance, perform
from onbeat.motion import Body
from onbeat.motion.features import hand_features


@pytest.fixture(scope="module")
def bows() -> list[Performance]:
    """The new figure by all dancers at the extreme speeds."""
    rng = np.random.default_rng(0)
    return [perform(dancer, [CLAP_AND_BOW], speed, 2, rng) for dancer in DANCERS for speed in (1.0, 1.5)]


@pytest.mark.parametrize(
    ("dance", "keyposes", "beats"),
    [("folk dance", 8, 12), ("harvest dance", 12, 20), ("river dance", 10, 16), ("festival dance", 33, 44)],
)
def test_every_cycle_has_the_keyposes_of_the_dance(dance: str, keyposes: int, beats: int) -> None:
    clip = perform_dance(DANCERS[1], dance, 1.2, 2, np.random.default_rng(0))
    period = clip.beats[1]
    at = clip.keyposes / period - LEAD
    assert keyposes_of(dance) == keyposes
    assert clip.task == dance
    assert clip.cycles == 2
    assert clip.motion.name == f"Bruno {dance} 1.2x"
    assert np.allclose(at[:keyposes] + beats, at[keyposes:])
    assert np.allclose(at, np.round(at))
    assert at[keyposes - 1] < beats


def test_there_are_beats_without_a_keypose_in_every_dance() -> None:
    for name, figures in DANCES.items():
        assert keyposes_of(name) <= 0.75 * sum(figure.beats for figure in figures)


def test_an_unknown_dance_is_said_to_be_unknown() -> None:
    with pytest.raises(PlanError, match=r"no dance 'polka'; there are folk dance, harvest dance"):
        perform_dance(DANCERS[0], "polka", 1.0, 1, np.random.default_rng(0))


def test_same_generator_same_dance() -> None:
    first, second = (perform_dance(DANCERS[3], "river dance", 1.0, 1, np.random.default_rng(5)) for _ in range(2))
    assert first.motion.rotations.tobytes() == second.motion.rotations.tobytes()


def test_hands_stop_on_the_keyposes_of_the_new_figure_and_on_no_other_beat(bows: list[Performance]) -> None:
    for clip in bows:
        stops = np.concatenate(hand_features(clip.motion).stops)
        inner = stops[(stops > clip.keyposes[0] - 0.15) & (stops < clip.keyposes[-1] + 0.15)]
        away = np.abs(inner[:, None] - clip.keyposes[None])
        assert away.min(1).max() < 0.15, clip.motion.name
        assert away.min(0).max() < 0.15, clip.motion.name


def test_feet_of_the_new_figure_stand_still_and_do_not_meet(bows: list[Performance]) -> None:
    for clip in bows:
        skeleton, positions = clip.motion.skeleton, clip.motion.positions
        for side, stands in zip(("Left", "Right"), clip.contacts.T, strict=True):
            foot = positions[:, [skeleton.index(side + part) for part in ("Foot", "ToeBase")]]
            assert np.abs(np.diff(foot, axis=0)[stands[1:] & stands[:-1]]).max() < 1e-9
        left, right = (positions[:, [skeleton.index(s + p) for p in ("Foot", "ToeEnd")]] for s in ("Left", "Right"))
        assert np.linalg.norm(left[:, :, None] - right[:, None], axis=-1).min() > 0.07, clip.motion.name


def test_hands_of_the_new_figure_stay_out_of_the_body(bows: list[Performance]) -> None:
    shares = np.linspace(0.0, 1.0, 9)[:, None]
    for clip in bows:
        body, positions = Body.of(clip.motion.skeleton), clip.motion.positions
        hips, neck = positions[:, None, body["hips"]], positions[:, None, body["neck"]]
        trunk = hips + shares * (neck - hips)
        for role in ("left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_hand", "right_hand"):
            apart = np.linalg.norm(positions[:, None, body[role]] - trunk, axis=-1).min()
            assert apart > 0.14 * positions[0, :, 2].max() / 1.7, (clip.motion.name, role)
