"""Who is connected to the page's server, and what each still has to be sent: runs on the server's loop alone.

What is sent to a client waits in its buffer until the network takes it. While that is more than a little, the client
gets no poses, so that it later goes on with the newest; events longer. One that stays so far behind is let go.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

ENOUGH = 32_000
"""Bytes that may wait for a client before it gets no more poses."""
TOO_MUCH = 256_000
"""Bytes that may wait before it gets nothing more."""
PATIENCE = 5.0
"""Seconds that it may stay behind."""
MOST = 64
"""Clients at once."""
COMMANDS = 20.0
"""Commands a second that are listened to, of each client; a second of them may come at once."""
WRONG = 10
"""Messages that are no commands, after which a client is let go."""


class Client:
    """One connection.

    Parameters
    ----------
    connection : of websockets.
    clock : seconds, for patience.
    """

    def __init__(self, connection: Any, clock: Callable[[], float] = time.monotonic) -> None:
        self.connection = connection
        self.wrong = 0
        self._clock = clock
        self._behind_since: float | None = None
        self._allowed = COMMANDS
        self._asked_at = clock()

    def takes(self, most: int) -> bool:
        """Whether no more than ``most`` bytes wait for it; who is behind for too long is let go."""
        waiting = self.connection.transport.get_write_buffer_size()
        if waiting <= ENOUGH:
            self._behind_since = None
        elif self._behind_since is None:
            self._behind_since = self._clock()
        elif self._clock() - self._behind_since > PATIENCE:
            self.connection.transport.abort()
            return False
        return waiting <= most

    def may_ask(self) -> bool:
        """Whether one more command is listened to now."""
        now = self._clock()
        self._allowed = min(self._allowed + (now - self._asked_at) * COMMANDS, COMMANDS)
        self._asked_at = now
        if self._allowed < 1.0:
            return False
        self._allowed -= 1.0
        return True


class Clients:
    """All connections.

    Parameters
    ----------
    broadcast : sends a message to connections at once, without waiting.
    """

    def __init__(self, broadcast: Callable[[list[Any], bytes | str], None]) -> None:
        self._broadcast = broadcast
        self._clients: set[Client] = set()

    def __len__(self) -> int:
        return len(self._clients)

    @property
    def full(self) -> bool:
        """Whether no more are let in."""
        return len(self._clients) >= MOST

    def add(self, connection: Any) -> Client:
        """One more."""
        client = Client(connection)
        self._clients.add(client)
        return client

    def remove(self, client: Client) -> None:
        """One less."""
        self._clients.discard(client)

    def pose(self, message: bytes) -> None:
        """Send a pose to all who are not behind."""
        self._send(message, ENOUGH)

    def text(self, message: str) -> None:
        """Send what is said to all who are not far behind."""
        self._send(message, TOO_MUCH)

    def abort(self) -> None:
        """Let all go at once."""
        for client in self._clients:
            client.connection.transport.abort()

    def _send(self, message: bytes | str, most: int) -> None:
        self._broadcast([client.connection for client in self._clients if client.takes(most)], message)
