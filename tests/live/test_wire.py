"""What goes over the WebSocket comes out as it went in, and the page's view of it is Python's."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest

from live_poses import dancer, pose, status
from onbeat.errors import OnbeatError
from onbeat.live.page import wire
from onbeat.live.protocol import BeatSaid, Command, Note, Status

CONTRACT = Path(__file__).resolve().parents[2] / "viewer-js" / "src" / "live" / "contract.ts"


def test_the_pages_contract_is_written_from_these_classes():
    written = CONTRACT.read_text(encoding="utf-8")
    assert written == wire.typescript(), "python -m onbeat.live.page.wire > viewer-js/src/live/contract.ts"
    for part in ('type: "status";', 'hearing: "music" | "held" | "nothing";', "capsules: CapsuleData[];"):
        assert part in written


def test_a_pose_is_twelve_bytes_and_twelve_for_each_point():
    sent = pose(123, dancer(5))
    message = wire.packed(sent)
    assert len(message) == 12 + 12 * 5
    time, number, points = wire.unpacked(message)
    assert (time, number) == (1.23, 123)
    np.testing.assert_array_equal(points, sent.points)
    with pytest.raises(OnbeatError, match="71 bytes"):
        wire.unpacked(message[:-1])


def test_what_is_said_names_its_type_and_is_read_again():
    said = [BeatSaid(1.0, 3, 0.9, 0.8), status(2.0, [2.5, 3.0]), Note(3.0, "the input is back <b>")]
    decoder = msgspec.json.Decoder(BeatSaid | Status | Note)
    assert [decoder.decode(wire.text(one)) for one in said] == said


@pytest.mark.parametrize(
    "message",
    [
        "",
        "{}",
        "null",
        '{"type":"command"}',
        '{"type":"command","do":"quit"}',
        b"\xff\xfe",
        "[" * 2000,
        '{"x":' + "[" * 4000,
        '"next"',
    ],
)
def test_what_is_no_command_is_refused_with_a_message(message):
    with pytest.raises(OnbeatError, match="not a command"):
        wire.read_command(message)


def test_a_command_may_lack_its_value():
    assert wire.read_command('{"type":"command","do":"next"}') == Command("next")
