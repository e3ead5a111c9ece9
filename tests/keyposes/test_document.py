"""keyposes.json goes out and comes back."""

import msgspec
import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.keyposes.document import KeyposesDocument, keyposes_document
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.segments import segments


def test_the_document_holds_what_was_found() -> None:
    clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0))
    found = find_keyposes(clip.motion, clip.beats)
    document = keyposes_document(found, "folk")
    plain = msgspec.json.decode(document.to_json())
    assert set(plain) >= {"version", "fps", "thresholds", "keyposes"}
    assert set(plain["thresholds"]) == {"t1", "t2"}
    assert set(plain["keyposes"][0]) == {"time", "frame", "beat", "source"}
    assert KeyposesDocument.from_json(document.to_json()) == document
    for row, time in zip(document.keyposes, found.times, strict=True):
        assert row.time == pytest.approx(time, abs=1e-6)
        assert abs(row.frame / document.fps - time) <= 0.5 / document.fps + 1e-9


@pytest.mark.parametrize("damaged", [b"", b"[]", b'{"version": 1}', b'{"version": "x"}', b"\xff"])
def test_what_is_no_document_is_refused(damaged: bytes) -> None:
    with pytest.raises(PlanError, match=r"k\.json is not a document of keyposes"):
        KeyposesDocument.from_json(damaged, "k.json")


def test_segments_lie_end_to_end() -> None:
    clip = perform(DANCERS[1], [FOLK_DANCE], 1.2, 2, np.random.default_rng(0))
    found = find_keyposes(clip.motion, clip.beats)
    parts = segments(found)
    assert [part.end for part in parts[:-1]] == [part.start for part in parts[1:]]
    assert len(segments(found, 8)) == len(found) - 8
    assert segments(found, len(found) + 3) == []
    assert all(part.duration > 0 for part in parts)
