"""Jobs: so many at a time, ended when they are cancelled, none lost and none done twice when the studio is killed."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import msgspec

from onbeat.studio.jobs import TRIES
from onbeat.studio.records import JobRecord, read_document
from onbeat.studio.studio import Studio
from own_loop import run
from studio_house import command, house, logged, project, settled

LONG = 30.0
"""Seconds after which a test gives up."""


def until(found: Callable[[], object]) -> None:
    end = time.monotonic() + LONG
    while not found():
        assert time.monotonic() < end, "waited for too long"
        time.sleep(0.02)


@contextmanager
def server(folder: Path) -> Iterator[tuple[subprocess.Popen[str], httpx.Client]]:
    """A studio in a process of its own."""
    code = (
        "import sys; from pathlib import Path; from onbeat.studio.serve import serve\n"
        "serve(Path(sys.argv[1]), port=0, said=lambda a: print(a, flush=True), command=sys.argv[2:])"
    )
    line = [sys.executable, "-c", code, str(folder / "project"), *command(folder)]
    with subprocess.Popen(line, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            with httpx.Client(base_url=process.stdout.readline().strip(), timeout=LONG) as client:
                until(lambda: answers(client))
                yield process, client
        finally:
            process.kill()


def answers(client: httpx.Client) -> bool:
    try:
        return client.get("/api/project").status_code == 200
    except httpx.TransportError:
        return False


def states(client: httpx.Client) -> dict[str, str]:
    return {job["title"].removeprefix("listening to "): job["state"] for job in project(client)["jobs"]}


def test_a_studio_that_is_killed_loses_no_job_and_does_none_twice(tmp_path: Path):
    (tmp_path / "hold").touch()
    names = [f"song {number}" for number in range(5)]
    with server(tmp_path) as (process, client):
        for name in names:
            assert client.post("/api/songs", params={"name": name}, content=b"sound").status_code == 201
        until(lambda: len(logged(tmp_path, "begin")) == 2)
        assert sorted(states(client).values()) == ["running"] * 2 + ["waiting"] * 5
        gone = next(song for song in project(client)["songs"] if song["name"] == "song 4")
        assert client.post(f"/api/jobs/{gone['job']}/cancel").json()["state"] == "cancelled"
        os.kill(process.pid, signal.SIGKILL)
    until(lambda: len(logged(tmp_path, "orphan")) == 2)  # they do not outlive it
    assert not logged(tmp_path, "done")
    with server(tmp_path) as (process, client):
        until(lambda: len(logged(tmp_path, "begin")) == 4)
        (tmp_path / "hold").unlink()
        found = settled(client)
        assert sorted(logged(tmp_path, "done")) == sorted(
            ["build", "the embedded song", *(n for n in names if n != "song 4")]
        )
        assert {song["name"]: song["state"] for song in found["songs"]} == {
            "the embedded song": "ready",
            **dict.fromkeys(names, "ready"),
            "song 4": "cancelled",
        }
        assert all((tmp_path / "project" / "songs" / s["id"] / "made.txt").is_file() for s in found["songs"][1:4])
        assert not list((tmp_path / "project" / "work").iterdir())
        process.send_signal(signal.SIGTERM)
        process.wait(LONG)
    document = read_document((tmp_path / "project" / "project.json").read_bytes(), "project.json")
    kept = {record.item.title.removeprefix("listening to "): record.item.state for record in document.jobs.values()}
    assert kept == {**dict.fromkeys(kept, "done"), "song 4": "cancelled"}  # so that nothing is done again
    assert len(kept) == 7


def test_a_job_is_ended_where_it_is_when_it_is_cancelled_and_the_next_begins(tmp_path: Path):
    (tmp_path / "hold").touch()
    with house(tmp_path) as client:
        until(lambda: len(logged(tmp_path, "begin")) == 2)
        song = client.post("/api/songs?name=later", content=b"sound").json()
        first = next(job for job in project(client)["jobs"] if job["state"] == "running")
        said = client.post(f"/api/jobs/{first['id']}/cancel").json()
        assert said["state"] == "cancelled"
        assert client.post(f"/api/jobs/{first['id']}/cancel").json()["state"] == "cancelled"
        until(lambda: "later" in logged(tmp_path, "begin"))
        (tmp_path / "hold").unlink()
        found = settled(client)
        assert next(one for one in found["songs"] if one["id"] == song["id"])["state"] == "ready"
        assert len(logged(tmp_path, "done")) == 2
        assert client.post("/api/jobs/job-99/cancel").status_code == 404


def test_what_was_cancelled_or_failed_is_tried_again(tmp_path: Path):
    (tmp_path / "hold").touch()
    with house(tmp_path) as client:
        for job in project(client)["jobs"]:
            client.post(f"/api/jobs/{job['id']}/cancel")
        (tmp_path / "hold").unlink()
        bad = client.post("/api/songs?name=bad", content=b"sound").json()["id"]
        found = settled(client)
        assert (found["songs"][1]["state"], found["libraries"][0]["state"]) == ("failed", "cancelled")
        assert client.post("/api/libraries/troupe/again").json()["state"] == "waiting"
        assert client.post(f"/api/songs/{bad}/again").json()["error"] is None
        found = settled(client)
        assert (found["songs"][1]["state"], found["libraries"][0]["state"]) == ("failed", "ready")
        assert client.post("/api/libraries/troupe/again").status_code == 409
        assert client.post("/api/jobs/troupe/again").status_code == 404


def test_a_process_that_dies_is_a_failure_that_is_told(tmp_path: Path):
    with house(tmp_path) as client:
        client.post("/api/songs?name=crash", content=b"sound")
        client.post("/api/songs?name=after", content=b"sound")
        found = {song["name"]: song for song in settled(client)["songs"]}
        assert found["crash"]["state"] == "failed"
        assert "SIGABRT" in found["crash"]["error"]
        assert found["after"]["state"] == "ready"


def test_a_job_waits_for_what_it_needs_and_fails_with_it(tmp_path: Path):
    with house(tmp_path) as client:
        (tmp_path / "hold").touch()
        song = client.post("/api/songs?name=bad", content=b"sound").json()
        dance = client.post("/api/dances", json={"song": song["id"], "seconds": 5}).json()
        assert client.delete(f"/api/songs/{song['id']}").status_code == 409
        (tmp_path / "hold").unlink()
        made = next(one for one in settled(client)["dances"] if one["id"] == dance["id"])
        assert made["state"] == "failed"
        assert "bad cannot be" in made["error"]
        assert client.delete(f"/api/dances/{dance['id']}").status_code == 204
        assert client.delete(f"/api/songs/{song['id']}").status_code == 204


def test_the_time_left_is_told_from_what_is_done(tmp_path: Path):
    (tmp_path / "hold").touch()
    with house(tmp_path) as client:
        until(lambda: any(job["share"] == 0.5 for job in project(client)["jobs"]))
        job = next(job for job in project(client)["jobs"] if job["share"] == 0.5)
        assert job["message"] == "half"
        assert job["left_s"] is not None
        (tmp_path / "hold").unlink()


def test_a_studio_ends_its_processes_when_it_ends(tmp_path: Path):
    (tmp_path / "hold").touch()
    with house(tmp_path):
        until(lambda: len(logged(tmp_path, "begin")) == 2)
    (tmp_path / "hold").unlink()
    time.sleep(0.1)
    assert not logged(tmp_path, "done")


def test_a_job_with_which_the_studio_ends_again_and_again_fails(tmp_path: Path):
    (tmp_path / "hold").touch()
    with house(tmp_path):
        until(lambda: len(logged(tmp_path, "begin")) == 2)
    (tmp_path / "hold").unlink()
    path = tmp_path / "project" / "project.json"
    document = read_document(path.read_bytes(), "project.json")
    first, second = list(document.jobs.values())
    assert (first.item.state, first.begun) == ("waiting", 0)  # it was told to end: that is nobody's fault
    for record, begun in ((first, TRIES), (second, TRIES - 1)):
        running = msgspec.structs.replace(record.item, state="running")
        document.jobs[running.id] = JobRecord(running, [], begun)
    path.write_bytes(msgspec.json.encode(document))
    with house(tmp_path) as client:
        found = settled(client)
        assert "3 times" in found["songs"][0]["error"]
        assert found["libraries"][0]["state"] == "ready"


def test_a_job_that_is_cancelled_in_the_moment_it_begins_does_not_begin(tmp_path: Path):
    async def begun() -> str:
        studio = Studio.open(tmp_path / "project", 2, command=command(tmp_path))
        studio.jobs.look()
        first = next(iter(studio.folder.document.jobs))
        studio.jobs.cancel(first)
        while studio.folder.document.libraries["troupe"].state == "waiting":
            await asyncio.sleep(0.01)
        state = studio.job(first).state
        await studio.close()
        return state

    assert run(begun()) == "cancelled"
    assert logged(tmp_path, "begin") == ["build"]


def test_what_the_user_wants_is_done_before_what_every_project_has(tmp_path: Path):
    (tmp_path / "hold").touch()
    with house(tmp_path, workers=1) as client:
        until(lambda: logged(tmp_path, "begin"))
        client.post("/api/motions?name=walk.bvh", content=b"HIERARCHY\n")
        (tmp_path / "hold").unlink()
        settled(client)
    assert logged(tmp_path, "begin") == ["the embedded song", "look", "build"]
