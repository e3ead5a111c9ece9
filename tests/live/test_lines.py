"""Poses as lines: what is in them, and readers that go or stand still."""

from __future__ import annotations

import io
import json
import os
import time

import numpy as np
import pytest

from live_poses import ROBOT, dancer, pose
from onbeat.errors import OnbeatError
from onbeat.live.mouths.lines import Lines
from onbeat.live.mouths.outputs import Outputs


def written(lines: Lines, stream: io.BytesIO, who, count: int) -> list[str]:
    lines.open(who)
    for number in range(count):
        lines.pose(pose(number, who))
    lines.close()
    return stream.getvalue().decode().splitlines()


@pytest.mark.parametrize("who", [ROBOT, dancer()], ids=["robot", "character"])
def test_csv_has_as_many_numbers_as_names(who):
    stream = io.BytesIO()
    head, *rows = written(Lines(stream), stream, who, 3)
    turning = ["root"] if who.kind == "robot" else list(who.joints)
    turns = [f"{name}.{axis}" for name in turning for axis in ("qw", "qx", "qy", "qz")]
    assert head.split(",") == ["time", "root.x", "root.y", "root.z", *turns, *who.hinges]
    third = np.array(rows[2].split(","), float)
    asked = pose(2, who)
    np.testing.assert_allclose(third, [0.02, *asked.root, *asked.rotations.ravel(), *asked.angles], atol=1e-5)


def test_a_trajectory_is_ten_poses_a_line_and_the_rest_at_the_end():
    stream = io.BytesIO()
    lines = [json.loads(line) for line in written(Lines(stream, "trajectory"), stream, ROBOT, 23)]
    assert [len(line["points"]) for line in lines] == [10, 10, 3]
    second = lines[1]
    assert second["joint_names"] == ["shoulder", "elbow"]
    assert second["header"]["stamp"] == {"sec": 1_700_000_000, "nanosec": 350_000_000}
    assert second["points"][2] == {"positions": [0.012, 1.012], "time_from_start": {"sec": 0, "nanosec": 20_000_000}}


def test_a_trajectory_of_who_has_no_hinges_is_refused():
    with pytest.raises(OnbeatError, match="no hinges"):
        Lines(io.BytesIO(), "trajectory").open(dancer())


def test_a_reader_that_goes_away_ends_it_quietly():
    reader, writer = os.pipe()
    with os.fdopen(writer, "wb") as stream:
        lines = Lines(stream)
        lines.open(ROBOT)
        os.close(reader)
        lines.pose(pose(0))
        lines.pose(pose(1))
        assert lines.ended


def test_a_reader_that_stands_still_harms_nobody():
    reader, writer = os.pipe()
    memory = io.BytesIO()
    with os.fdopen(writer, "wb") as stream:
        outputs = Outputs([Lines(stream), Lines(memory)])
        outputs.open(dancer(40))
        for number in range(300):
            outputs.pose(pose(number, dancer(40)))
            time.sleep(0.001)
        begun = time.monotonic()
        outputs.close()
        assert time.monotonic() - begun < 3.0
        stood, read = outputs.passed()
        assert stood.dropped > 0
        assert (read.sent, len(memory.getvalue().splitlines())) == (300, 301)
        os.close(reader)
