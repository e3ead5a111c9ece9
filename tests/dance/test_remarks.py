"""What is told of a dance beside its figures."""

from types import SimpleNamespace

import numpy as np
import pytest
from msgspec import UNSET

from onbeat.dance.document import DanceDocument
from onbeat.dance.remarks import remarks


def told(again: float = 0.0, heard: float | None = None, method: str = "optimal", library: float = 40.0) -> list[str]:
    beats = np.arange(0.0, 60.0, 2 / 3).tolist()
    metrics = {"variety": {"repeated_s": again}}
    document = DanceDocument(1, 60, 60.0, 0, method, beats, [], [], metrics, heard_bpm=heard or UNSET)
    return remarks(document, SimpleNamespace(seconds=library))


def test_a_dance_as_one_expects_it_is_not_remarked_on() -> None:
    assert told(again=11.0) == []


@pytest.mark.parametrize(("heard", "fold"), [(180.0, "half"), (45.0, "double")])
def test_another_tempo_than_is_heard(heard: float, fold: str) -> None:
    (line,) = told(heard=heard)
    assert line.startswith(f"{heard:.0f} BPM are heard, danced to at {fold} of it (90)")


def test_moves_that_are_too_few() -> None:
    assert told(again=30.0) == [
        "30 s of the dance (50%) show again what was shown before: 40 s of motion are little for 60 s of song; add "
        "clips, or choose a shorter stretch of the song with --start and --seconds"
    ]


def test_a_method_that_repeats_itself_whatever_there_is() -> None:
    (line,) = told(again=30.0, method="walk", library=3600.0)
    assert line.endswith("the method walk does not keep from it as optimal does")
