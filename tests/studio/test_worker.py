"""The process of a job: a task comes in on stdin, what becomes of it goes out on stdout."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import msgspec

from onbeat.studio.crew import COMMAND
from onbeat.studio.tasks import ListenTask, SoundSource, Task


def run(task: Task | None, folder: Path) -> list[dict[str, object]]:
    line = b"" if task is None else msgspec.json.encode(task) + b"\n"
    with subprocess.Popen(COMMAND, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=folder) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(line)
        process.stdin.flush()
        if task is None:
            process.stdin.close()
        return [json.loads(said) for said in process.stdout]


def test_a_task_that_fails_says_why_as_its_last_word(tmp_path: Path):
    (tmp_path / "original.wav").write_bytes(b"RIFF and nothing else")
    (tmp_path / "numpy.py").write_text("raise SystemExit")  # what lies in its folder is not run
    said = run(ListenTask(str(tmp_path), SoundSource("tune.wav", str(tmp_path / "original.wav"))), tmp_path)
    assert said[-1]["type"] == "failed"
    assert str(said[-1]["error"]).startswith("tune.wav")
    assert all(line["type"] == "progress" for line in said[:-1])


def test_a_process_whose_studio_is_gone_already_ends_without_a_word(tmp_path: Path):
    assert run(None, tmp_path) == []
