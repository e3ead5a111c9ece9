"""P2 done again: takes, what is observed of them, methods on a robot's limits, and the page's parts."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import MetricError, OnbeatError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import perform_dance
from onbeat.formats.write import write_motion
from onbeat.motion.joint_angles import JointAngles
from onbeat.reproduce.data import Data
from onbeat.reproduce.p2.curves import lowered, stretches
from onbeat.reproduce.p2.hand import compared, hand_paths
from onbeat.reproduce.p2.methods import OURS, PRINTED, PUBLISHED, ROBOT, ask, detail_kept
from onbeat.reproduce.p2.observed import Kept, detail_left, kept, observed
from onbeat.reproduce.p2.seen import Seen
from onbeat.reproduce.p2.seen_claims import seen_claims
from onbeat.reproduce.p2.takes import Solo, real_takes, troupe_takes
from onbeat.reproduce.p2.temporal_scaling import PAPER
from onbeat.reproduce.p2.tried import FOUND, Tried, angles_of
from onbeat.reproduce.p2.tried_claims import tried_claims
from onbeat.reproduce.result import FigureResult
from onbeat.retime.bspline import Spline
from onbeat.retime.sources import Table
from onbeat.robots.model import robot_named

PERIOD = 0.5


@pytest.fixture(scope="module")
def danced():
    return observed(troupe_takes(2, (1.0, 1.5), 3))


@pytest.fixture(scope="module")
def played():
    return observed(troupe_takes(2, (1.0, 1.5), 3, played=True))


@pytest.fixture(scope="module")
def asked():
    """Two joints of the robot that swing too fast in the middle of a dance, with a tremble of 6 Hz."""
    times = np.arange(0, 12, 1 / 60)
    fast = np.exp(-np.square((times - 6) / 0.8))
    swing = 0.5 * np.sin(2 * np.pi * times / (4 * PERIOD)) + 0.7 * fast * np.sin(2 * np.pi * 1.8 * times)
    angles = np.stack((swing + 0.01 * np.sin(2 * np.pi * 6 * times), 0.5 * swing), axis=1)
    table = Table(JointAngles(("L_SHOULDER_Y", "L_SHOULDER_R"), angles, 60.0, "swing"))
    beats = np.arange(0, 12, PERIOD)
    return ask(table, Solo(None, beats, beats[1::2]), 1.2)


def test_details_fade_where_the_dance_is_danced_faster_and_stay_where_it_is_merely_played(danced, played):
    assert detail_left(danced)[-1] < 0.75
    assert abs(detail_left(played)[-1] - 1) < 0.06


def test_valleys_are_keyposes_far_more_often_than_by_chance(danced):
    told = kept(danced)
    assert told.precision > 0.5
    assert told.recall > 2 * told.chance


def test_a_hand_goes_a_shorter_way_in_faster_music_but_not_where_it_is_merely_played(danced, played):
    lengths = [
        compared(*(hand_paths(one.takes, speed) for speed in (1.0, 1.5)), one.takes.keyposes).length
        for one in (danced, played)
    ]
    assert lengths[0] < 0.93
    assert abs(lengths[1] - 1) < 0.03


def test_claims_turn_where_the_dance_is_merely_played(danced, played):
    of_danced, of_played = (seen_claims(Seen((one,), (), (one.takes,))) for one in (danced, played))
    insight = 3
    assert of_danced[insight].holds
    assert not of_played[insight].holds
    assert len(of_danced) == len(seen_claims(None, "no takes"))
    assert {claim.holds for claim in seen_claims(None, "no takes")} == {None}


def test_so_few_valleys_that_a_coin_would_do_as_well_decide_nothing(danced, monkeypatch):
    def holds(valleys: int, right: int, recall: float = 0.6) -> bool | None:
        told = Kept(valleys, 8, right / valleys, recall, 0.2, 0.1)
        monkeypatch.setattr("onbeat.reproduce.p2.seen_claims.kept", lambda _: told)
        return seen_claims(Seen((danced,), (), (danced.takes,)))[4].holds

    assert holds(5, 3) is None
    assert holds(40, 36) is True
    assert holds(40, 36, recall=0.3) is None
    assert holds(40, 4) is False


def test_methods_keep_the_limits_and_ours_the_keyposes(asked):
    assert asked.past == 2
    assert asked.scaled[PUBLISHED].measures.violations == asked.scaled[OURS].measures.violations == (0, 0)
    assert np.degrees(asked.scaled[OURS].measures.worst_keypose) < 0.5
    assert PRINTED in asked.scaled
    assert asked.scaled["uniform"].done < 0.9


def test_detail_is_all_there_in_the_wish_and_gone_in_its_mean(asked):
    demand = asked.scaled[OURS].result.demand
    assert detail_kept(demand, demand.wish) == 1.0
    still = Spline.through(np.zeros_like(demand.wish.samples), 60.0)
    assert abs(detail_kept(demand, demand.wish.with_controls(still.controls))) < 1e-9
    assert asked.slack < asked.scaled["pollard2002"].detail


def test_a_claim_that_the_filters_gain_decides_is_left_open(asked):
    def holds(gained: float, slack: float) -> bool | None:
        own = asked.scaled[PUBLISHED].detail
        loose = replace(asked.scaled["pollard2002"], detail=own + gained)
        one = replace(asked, slack=own + slack, scaled={**asked.scaled, "pollard2002": loose})
        every = {(captured, speed): one for captured in (True, False) for speed in (1.0, 1.2)}
        return tried_claims(Tried(None, None, every, {}, {}, "no engine"))[1].holds

    assert holds(0.1, -0.1) is None
    assert holds(-0.1, -0.1) is True
    assert holds(0.1, 0.1) is False


def test_layers_are_lowered_the_finest_first_and_the_limit_is_where_it_is_enlarged(asked):
    result = asked.scaled[PUBLISHED].result
    share, broken = lowered(result)
    assert 0 < share < 1
    assert broken == 0
    away, at_limit = stretches([asked.scaled[name].result for name in ("pollard2002", OURS)])
    assert at_limit.start < 6 / 1.2 < at_limit.end
    assert not away.start < 6 / 1.2 < away.end


def test_real_takes_are_observed_and_danced_where_nothing_can_be_simulated(tmp_path, monkeypatch):
    monkeypatch.setattr("onbeat.reproduce.p2.tried.why_not", lambda: "no engine")
    monkeypatch.setattr("onbeat.reproduce.p2.wish.why_not", lambda: "no engine")
    monkeypatch.setattr("onbeat.reproduce.p2.takes.LONGEST", 3.0)
    for number, take in enumerate(troupe_takes(0, (1.0, 1.5), 1).takes):
        path = tmp_path / f"take_{number}.bvh"
        write_motion(take.motion, path)
        path.with_suffix(".beats").write_text("".join(f"{beat:.4f}\n" for beat in take.beats if beat > 0))
    told = list[float]()
    found = PAPER.reproduce(Data(motions=(tmp_path,)), lambda share, what: told.append(share))
    assert told == sorted(told)
    assert max(told) < 1.0
    numbers = [part.number for part in found.parts]
    assert {"Fig. 1", "Fig. 3", "Fig. 4", "Fig. 6", "Fig. 8"} <= set(numbers)
    assert "Fig. 7" not in numbers
    assert all(part.svg.startswith(b"<?xml") for part in found.parts if isinstance(part, FigureResult))
    assert any("no engine" in line for line in found.differs)
    assert [claim.holds for claim in found.claims[-2:]] == [None, None]


def test_how_far_the_robots_angles_are_found_is_told_all_the_way(monkeypatch):
    def slow(solo, robot, *, captured, progress):
        progress(0.5)
        return captured

    monkeypatch.setattr("onbeat.reproduce.p2.tried.on_robot", slow)
    told = list[tuple[float, str]]()
    assert angles_of(None, robot_named(ROBOT), lambda *step: told.append(step)) == {True: True, False: False}
    assert [share / FOUND for share, _ in told] == pytest.approx([0.0, 0.25, 0.5, 0.75])
    assert [what.split(", ")[1] for _, what in told] == ["as captured"] * 2 + ["as planned"] * 2


def test_takes_without_beats_are_refused_with_what_to_write(tmp_path):
    clip = perform_dance(DANCERS[0], "folk dance", 1.0, 1, np.random.default_rng(0))
    paths = [tmp_path / "a.bvh", tmp_path / "b.bvh"]
    for path in paths:
        write_motion(clip.motion[:60], path)
    with pytest.raises(MetricError, match=r"write a\.beats, a second a line"):
        real_takes(paths)
    with pytest.raises(MetricError, match="at several speeds"):
        real_takes(paths[:1])


def test_one_real_dance_that_nothing_can_be_made_of_says_both_reasons(tmp_path, monkeypatch):
    path = tmp_path / "short.bvh"
    write_motion(perform_dance(DANCERS[0], "folk dance", 1.0, 1, np.random.default_rng(0)).motion[:5], path)
    with pytest.raises(Exception, match=r"nothing can be observed .* no robot can dance it"):
        PAPER.reproduce(Data(motions=(path,)), lambda share, what: None)


def test_songs_are_refused_and_what_is_not_there_is_said_once(tmp_path):
    with pytest.raises(OnbeatError, match=r"P2 hears no songs: leave out song\.wav"):
        PAPER.reproduce(Data(songs=(Path("song.wav"),)), lambda share, what: None)
    with pytest.raises(OnbeatError, match=r"^no file or folder"):
        PAPER.reproduce(Data(motions=(tmp_path / "none",)), lambda share, what: None)
