"""Answers of a study's people: files of one or of many, put together, each person once."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import msgspec

from onbeat.errors import OnbeatError
from onbeat.keyposes.decoding import decoded
from onbeat.keyposes.judging import SPACES, Answer, AnswersDocument
from onbeat.reproduce.study.plans import PAGE

VERSION = 1
LARGEST = 16 << 20
"""Bytes of a file of answers: thousands of people."""
MOST_ANSWERS = 1000
"""Of one person."""
WHAT = f"a file of answers that {PAGE} saved"
_ID = re.compile(r"[0-9a-f]{16}")

Said = msgspec.Meta


class PersonAnswers(msgspec.Struct, frozen=True):
    """What one person chose."""

    id: Annotated[str, Said(description="drawn by chance, so that a person counts once; says nothing about who it is")]
    answers: Annotated[list[Answer], Said(description="in the order of the trials")]


class StudyDocument(msgspec.Struct, frozen=True):
    """``answers.json`` of a study: what some people chose; the study's page writes it."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    study: Annotated[str, Said(description="which page asked; answers of others are not put together with these")]
    dims: Annotated[int, Said(description="dimensions of the motions that were shown")]
    people: Annotated[list[PersonAnswers], Said(description="who answered, in order")]

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"

    @classmethod
    def from_json(cls, data: bytes, source: str = "answers.json") -> StudyDocument:
        """Read answers; an ``OnbeatError`` says what is wrong with them.

        Examples
        --------
        >>> StudyDocument.from_json(b'{"version": 7}')
        Traceback (most recent call last):
        onbeat.errors.OnbeatError: answers.json: version 7; this onbeat reads version 1
        """
        found = decoded(data, cls, VERSION, source, WHAT, OnbeatError)
        for person in found.people:
            _check(person, source)
        return found


def _check(person: PersonAnswers, source: str) -> None:
    if not _ID.fullmatch(person.id) or not 1 <= len(person.answers) <= MOST_ANSWERS:
        raise OnbeatError(
            f"{source}: {len(person.answers)} answers of {person.id[:40]!r}; 1 to {MOST_ANSWERS} of an id of sixteen "
            f"hexadecimal digits are expected: save them from {PAGE}"
        )
    for number, answer in enumerate(person.answers):
        if sorted((answer.a, answer.b)) != sorted(SPACES) or answer.chosen not in ("a", "b"):
            raise OnbeatError(
                f"{source}: answer {number} of {person.id} chose {answer.chosen[:40]!r} of {answer.a[:40]!r} and "
                f"{answer.b[:40]!r}; 'a' or 'b' of {' and '.join(SPACES)} is expected"
            )


def read_answers(paths: Iterable[Path]) -> StudyDocument:
    """Answers from files, put together: a person in several of them counts once.

    Files of ``judge.html``, which hold one person each and no study's name, are read too, and may not be mixed with a
    study's.

    Raises
    ------
    OnbeatError
        If a file cannot be read or is no such file, answers are of several studies, or two files have different answers
        by the same person.
    """
    people: dict[str, tuple[PersonAnswers, Path]] = {}
    first: tuple[Path, StudyDocument] | None = None
    for path in paths:
        found = _read(path)
        first = first or (path, found)
        if (found.study, found.dims) != (first[1].study, first[1].dims):
            raise OnbeatError(
                f"{path} has answers of another study than {first[0]} (other motions or dimensions); look at each by "
                "itself"
            )
        for person in found.people:
            known = people.setdefault(person.id, (person, path))
            if known[0] != person:
                raise OnbeatError(f"{path} and {known[1]} have different answers by {person.id}; leave one out")
    if first is None or not people:
        raise OnbeatError(f"no answers; give files that {PAGE} saved, or the folder in which they lie")
    return StudyDocument(VERSION, first[1].study, first[1].dims, [person for person, _ in people.values()])


def _read(path: Path) -> StudyDocument:
    try:
        if path.exists() and not path.is_file():  # a pipe would be waited for
            raise OnbeatError(f"{path} is no file; give files that {PAGE} saved")
        if path.stat().st_size > LARGEST:
            raise OnbeatError(f"{path} is larger than {LARGEST >> 20} MB and no file of answers")
        data = path.read_bytes()
    except OSError as error:
        raise OnbeatError(f"cannot read {path}: {error.strerror or error}; save it from {PAGE}") from None
    if not _of_one(data):
        return StudyDocument.from_json(data, str(path))
    # Saved from judge.html: nothing tells who it was, so that each file is somebody else.
    alone = AnswersDocument.from_json(data, str(path), f"{PAGE} or judge.html")
    return StudyDocument(VERSION, "", alone.dims, [PersonAnswers(str(path), alone.answers)])


class _Kind(msgspec.Struct):
    people: msgspec.Raw | msgspec.UnsetType = msgspec.UNSET


def _of_one(data: bytes) -> bool:
    """Whether something is no study's document: nobody is listed in it."""
    try:
        return msgspec.json.decode(data, type=_Kind).people is msgspec.UNSET
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return False
