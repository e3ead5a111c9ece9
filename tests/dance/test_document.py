"""``dance.json``: read back as it was written, and refused clearly where it is something else."""

from __future__ import annotations

import json

import pytest

from onbeat.dance.document import VERSION, DanceDocument, JoinDocument, MoveDocument
from onbeat.errors import PlanError


@pytest.fixture
def document() -> DanceDocument:
    moves = [MoveDocument("walk", 1.0, 3.0, 0.0), MoveDocument("</script> “turn”", 0.5, 2.5, 2.0)]
    metrics = {"beats": {"f50": 0.8, "null": None}}
    return DanceDocument(
        VERSION, 60.0, 4.0, 2**63 - 1, "optimal", [0.5, 1.0], [0.49], moves, metrics, "a song",
        [JoinDocument(1.8, 2.2, 11.5)],
    )  # fmt: skip


def test_round_trip(document: DanceDocument) -> None:
    assert DanceDocument.from_json(document.to_json()) == document


def test_it_is_plain_json(document: DanceDocument) -> None:
    plain = json.loads(document.to_json())
    assert list(plain)[:9] == [
        "version", "fps", "duration", "seed", "method", "beats", "stops", "moves", "metrics",
    ]  # fmt: skip
    assert plain["moves"][1] == {"clip": "</script> “turn”", "from_s": 0.5, "to_s": 2.5, "at_s": 2.0}
    assert document.to_json().endswith(b"}\n")


def test_what_came_later_may_be_missing(document: DanceDocument) -> None:
    plain = json.loads(document.to_json())
    del plain["title"], plain["joins"]
    found = DanceDocument.from_json(json.dumps(plain).encode())
    assert (found.title, found.joins) == ("", [])


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "not a dance document"),
        (b"[1, 2]", "not a dance document"),
        (b'{"fps": 60}', "not a dance document"),
        (b'{"version": 1, "fps": "fast"}', "not a dance document"),
        (b'{"version": 2}', "version 2; this onbeat reads version 1"),
        (b"\xff\xfe", "not a dance document"),
        (b'{"version": 1, "metrics": ' + b"[" * 100_000, "not a dance document"),
    ],
)
def test_other_things_are_refused(data: bytes, message: str) -> None:
    with pytest.raises(PlanError, match=message) as refused:
        DanceDocument.from_json(data, "my.json")
    assert str(refused.value).startswith("my.json")
