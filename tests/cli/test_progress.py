"""Progress on the terminal."""

import time

import pytest

from onbeat.cli.heartbeat import Heartbeat
from onbeat.cli.progress import Stages


def test_all_of_a_job_goes_on_with_its_stages() -> None:
    stages = Stages({"hearing": 1.0, "dancing": 3.0})
    seen: list[float] = []
    for stage, share in (("hearing", 0.5), ("dancing", 0.0), ("filming", 0.5), ("dancing", 1.0)):
        stages(stage, share)
        seen.append(stages._progress.tasks[0].completed)
    assert seen == [0.125, 0.25, 0.25, 1.0]
    assert [task.description for task in stages._progress.tasks] == [
        "in all",
        "hearing",
        "dancing",
        "filming",
        "dancing",
    ]


def test_long_work_is_told_in_lines_where_stderr_is_no_screen(capsys: pytest.CaptureFixture[str]) -> None:
    beat = Heartbeat(every=0.02)
    beat.start()
    time.sleep(0.1)  # nothing is said as long as nothing is done
    beat.say("moves", 0.25, "reading a.bvh")
    time.sleep(0.3)
    beat.stop()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) > 1
    assert {line.split(" after ")[0] for line in lines} == {"onbeat: moves, reading a.bvh: 25%"}
    time.sleep(0.1)
    assert capsys.readouterr().err == ""


def test_stages_are_told_so_and_short_work_is_not(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for every, told in ((0.05, True), (60.0, False)):
        monkeypatch.setattr("onbeat.cli.heartbeat.EVERY", every)
        with Stages() as stages:
            stages("searching", 1.5)
            time.sleep(0.2)
        assert ("onbeat: searching: 100% after 0 s" in capsys.readouterr().err) == told
