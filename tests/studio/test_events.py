"""Pages are told what happens, and one that does not listen holds up nobody."""

from __future__ import annotations

import json
from collections.abc import AsyncGenerator

from onbeat.studio.events import WAITING, Events
from onbeat.studio.wire import JobItem
from own_loop import run


def job(share: float) -> JobItem:
    return JobItem("job-1", "listen", "song", "listening", "running", share)


async def heard(lines: AsyncGenerator[bytes]) -> dict[str, object]:
    line = await anext(lines)
    assert line.startswith(b"data: ")
    assert line.endswith(b"\n\n")
    return json.loads(line[6:])


def test_a_page_hears_the_revision_then_what_happens():
    async def listening() -> None:
        events = Events()
        events.revision = 7
        lines = events.listen()
        assert await heard(lines) == {"revision": 7}
        events.went_on(job(0.25))
        events.changed(8)
        assert (await heard(lines))["job"]["share"] == 0.25
        assert await heard(lines) == {"revision": 8}
        events.end()
        assert [line async for line in lines] == []

    run(listening())


def test_a_page_that_does_not_listen_is_told_to_look_anew():
    async def listening() -> None:
        events = Events()
        lines = events.listen()
        await heard(lines)
        for number in range(3 * WAITING):
            events.went_on(job(number / (3 * WAITING)))
        events.changed(9)
        told = []
        while not told or told[-1] != {"revision": 9}:
            told.append(await heard(lines))
        assert len(told) <= WAITING + 1
        await lines.aclose()
        assert not events.full

    run(listening())
