"""The errors onbeat raises for what a user can put right.

Every message says what was found, where, what was expected and what to do. The command line prints the
message alone, without a traceback, and exits with status 1.
"""

from __future__ import annotations


class OnbeatError(Exception):
    """Base of all errors that a user can put right."""


class FormatError(OnbeatError):
    """A motion file that cannot be read, or a motion that a format cannot hold."""


class AudioError(OnbeatError):
    """An audio file that cannot be read, or holds nothing to dance to."""


class BodyError(OnbeatError):
    """A skeleton on which a needed body part (a joint role) is not found."""


class LibraryError(OnbeatError):
    """A motion library that is empty, damaged, of another version or busy."""


class PlanError(OnbeatError):
    """No dance can be planned from this library and song."""


class MissingExtraError(OnbeatError):
    """An optional dependency is not installed."""


class MetricError(OnbeatError):
    """Something that cannot be measured: times out of order, shapes that disagree."""


class LimitError(OnbeatError):
    """Limits of joints that cannot be, cannot be read, or are missing for a joint."""


class FetchError(OnbeatError):
    """Data that cannot be fetched: no network, not there, not what was expected, no room for it."""
