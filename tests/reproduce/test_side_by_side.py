"""Papers in processes of their own: results, progress, warnings and errors arrive as if they were done here."""

from __future__ import annotations

from functools import partial

import pytest

from made_results import worked
from onbeat.errors import OnbeatError
from onbeat.music.audio import AudioWarning
from onbeat.reproduce.side_by_side import side_by_side


def test_results_progress_and_warnings_arrive():
    told: list[tuple[str, float, str]] = []
    jobs = {name: partial(worked, number) for number, name in enumerate("ab")}
    with pytest.warns(AudioWarning, match="[01] was not kept"):
        results = side_by_side(jobs, lambda *step: told.append(step), workers=2)
    assert {name: one.our_data for name, one in results.items()} == {"a": "0", "b": "1"}
    assert sorted(told) == [(name, 0.5, f"half of {number}") for number, name in enumerate("ab")]


@pytest.mark.parametrize(("number", "match"), [(13, "13 does not work"), (14, "odd: its process ended")])
def test_what_goes_wrong_there_is_told_here(number: int, match: str):
    with pytest.raises(OnbeatError, match=match):
        side_by_side({"odd": partial(worked, number)}, lambda *step: None, workers=2)
