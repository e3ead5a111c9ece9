"""Progress on the terminal."""

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
