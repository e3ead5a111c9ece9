"""``retime.json`` says what was done."""

from __future__ import annotations

import msgspec
import numpy as np

from onbeat.limits.limits import Limits
from onbeat.motion.joint_angles import JointAngles
from onbeat.retime.document import RetimeDocument, retime_document
from onbeat.retime.lock import TimeMap
from onbeat.retime.retime import retime
from onbeat.retime.sources import Table


def retimed(speed: float = 1.2, limit: float = 30.0):
    seconds = np.arange(0, 6, 1 / 60)
    table = Table(JointAngles(("elbow", "wrist"), np.stack((np.sin(6 * seconds), 0 * seconds), axis=1), 60, "swing"))
    limits = Limits("an arm", ("elbow", "wrist"), [-2, -2], [2, 2], [limit, limit])
    return retime(table, TimeMap.steady(speed), limits, np.arange(0, 6, 0.5), np.arange(0.25, 5.5, 0.5))


def test_it_is_read_back_as_it_was_written():
    document = retime_document(retimed())
    assert msgspec.json.decode(document.to_json(), type=RetimeDocument) == document


def test_a_dance_inside_its_limits_is_as_it_was():
    document = retime_document(retimed())
    assert (document.version, document.method, document.joints) == (1, "qp", ["elbow", "wrist"])
    assert document.speed == 1.2
    assert document.feasible
    assert document.missed == []
    assert (document.violations.position, document.violations.velocity) == (0, 0)
    assert document.rms_deg == document.keypose_error_deg == 0.0
    assert document.beats[:3] == [0.0, round(0.5 / 1.2, 6), round(1 / 1.2, 6)]


def test_what_is_missed_is_told_by_joint_and_second_with_a_speed_that_would_do():
    document = retime_document(retimed(limit=2.0))
    assert not document.feasible
    assert {one.joint for one in document.missed} == {"elbow"}
    assert {one.why for one in document.missed} == {"speed"}
    assert document.speed_that_would_do is None or document.speed_that_would_do < 1.2
    assert document.joint_rms_deg[1] == 0.0 < document.joint_rms_deg[0]


def test_two_runs_differ_in_the_seconds_they_took_alone():
    one, other = (msgspec.structs.replace(retime_document(retimed(limit=4.0)), solve_s=0.0) for _ in range(2))
    assert one.to_json() == other.to_json()
