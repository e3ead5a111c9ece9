"""What happens, told to all pages that listen: server-sent events, one short queue for each of them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator

import msgspec

from onbeat.studio.wire import EventData, JobItem

QUIET = 10.0
"""Seconds without news after which a line is sent all the same, so that ends are noticed."""
WAITING = 256
"""Events that a page may be behind; one that is further behind is told to look at everything anew."""
LISTENERS = 64
"""Pages that may listen."""


class Events:
    """Who listens, and what is yet to be told to each."""

    def __init__(self) -> None:
        self._queues: set[asyncio.Queue[EventData | None]] = set()
        self.revision = 0

    @property
    def full(self) -> bool:
        """Whether as many listen as may."""
        return len(self._queues) >= LISTENERS

    def changed(self, revision: int) -> None:
        """The project has another revision."""
        self.revision = revision
        self._tell(EventData(revision=revision))

    def went_on(self, job: JobItem) -> None:
        """A job went on."""
        self._tell(EventData(job=job))

    def end(self) -> None:
        """Let all who listen go."""
        for queue in self._queues:
            _put(queue, None)

    def _tell(self, event: EventData) -> None:
        for queue in self._queues:
            if queue.qsize() >= WAITING:  # it does not read: only that there is news is kept for it
                while not queue.empty():
                    queue.get_nowait()
                event = EventData(revision=self.revision)
            _put(queue, event)

    async def listen(self) -> AsyncGenerator[bytes]:
        """The events from now on as lines of ``text/event-stream``; the revision first."""
        queue: asyncio.Queue[EventData | None] = asyncio.Queue()
        self._queues.add(queue)
        try:
            yield told(EventData(revision=self.revision))
            while True:
                try:
                    event = await asyncio.wait_for(queue.get(), QUIET)
                except TimeoutError:
                    yield b": still here\n\n"
                    continue
                if event is None:
                    return
                yield told(event)
        finally:
            self._queues.discard(queue)


def _put(queue: asyncio.Queue[EventData | None], event: EventData | None) -> None:
    queue.put_nowait(event)


def told(event: EventData) -> bytes:
    r"""An event as it is sent.

    Examples
    --------
    >>> told(EventData(revision=3))
    b'data: {"revision":3}\n\n'
    """
    return b"data: " + msgspec.json.encode(event) + b"\n\n"
