import msgspec
import pytest

from onbeat.errors import MetricError, PlanError
from onbeat.keyposes.decoding import decoded


class Document(msgspec.Struct):
    version: int
    name: str = ""


def test_a_document_of_the_version_is_decoded():
    assert decoded(b'{"version": 3, "name": "Aiko"}', Document, 3, "x.json", "a test").name == "Aiko"


@pytest.mark.parametrize(
    "data",
    [
        b"", b"{}", b"[1]", b"\xff", b'{"version": 1, "name": "\xff"}', b'{"version": 1, "name": 2}', b"[" * 100000,
        b'{"version": 1, "name": ' + b"[" * 100000,
    ],
)  # fmt: skip
def test_what_is_no_document_is_told(data):
    with pytest.raises(MetricError, match=r"x\.json is not a test: "):
        decoded(data, Document, 1, "x.json", "a test")


def test_another_version_is_told_before_what_else_is_wrong_by_the_error_that_was_asked_for():
    with pytest.raises(PlanError, match=r"x\.json: version 2; this onbeat reads version 1"):
        decoded(b'{"version": 2, "name": []}', Document, 1, "x.json", "a test", PlanError)
