from pathlib import Path

import pytest

from onbeat.errors import LimitError
from onbeat.limits import plain_xml
from onbeat.limits.plain_xml import as_number, parse_xml, read_xml


def parse(text: str | bytes):
    return parse_xml(text.encode() if isinstance(text, str) else text, "a.urdf", "a URDF")


def test_elements_and_attributes():
    root = parse('<?xml version="1.0"?><!-- no --><robot name="a"><joint name="b"/>text</robot>')
    assert (root.tag, root.get("name"), root[0].get("name")) == ("robot", "a", "b")


def test_prefixes_are_kept_and_namespaces_passed_over():
    root = parse('<robot xmlns="http://somewhere" xmlns:x="y"><x:macro/><joint/><unbound:joint/></robot>')
    assert [root.tag, *(child.tag for child in root)] == ["robot", "x:macro", "joint", "unbound:joint"]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_encodings(encoding: str):
    head = '<?xml version="1.0" encoding="latin-1"?>' if encoding == "latin-1" else ""
    assert parse(f'{head}<robot name="Ärmchen"/>'.encode(encoding)).get("name") == "Ärmchen"


BOMB = '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;">]><r>&b;</r>'


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", r"is no XML \(no element found at line 1\); a URDF is expected"),
        ("<robot>\n<joint></robot>", r"is no XML \(mismatched tag at line 2\)"),
        ("solid a mesh", "is no XML"),
        ("<a/><b/>", "junk after document element"),
        ("<a>&b;</a>", "undefined entity"),
        ('<a b="1" b="2"/>', "duplicate attribute"),
        (BOMB, "a document type .* found; take it out"),
        ('<!DOCTYPE r SYSTEM "file:///etc/passwd"><r/>', "a document type"),
        ('<?xml version="1.0" encoding="nonsense"?><r/>', "is no XML"),
        ("<r>" * 2000 + "</r>" * 2000, "nested over 1000 deep"),
    ],
)
def test_what_is_refused(text: str, told: str):
    with pytest.raises(LimitError, match=rf"^a\.urdf.*{told}"):
        parse(text)


def test_files_that_cannot_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    with pytest.raises(LimitError, match=r"cannot read .*: No such file"):
        read_xml(tmp_path / "a.urdf", "a URDF")
    with pytest.raises(LimitError, match=r"cannot read .*: Is a directory"):
        read_xml(tmp_path, "a URDF")
    with pytest.raises(LimitError, match="cannot read"):
        read_xml(tmp_path / "a\x00b", "a URDF")
    (tmp_path / "a.urdf").write_text("<robot/>")
    assert read_xml(tmp_path / "a.urdf", "a URDF").tag == "robot"
    monkeypatch.setattr(plain_xml, "LARGEST", 7)
    with pytest.raises(LimitError, match="more than 7 bytes"):
        read_xml(tmp_path / "a.urdf", "a URDF")


@pytest.mark.parametrize("text", ["", "1_0", "nan", "1,5", "0x1p3", "one"])
def test_what_is_no_number(text: str):
    with pytest.raises(LimitError, match="elbow: a number is expected"):
        as_number(text, "elbow")
    assert as_number("-INF", "elbow") == -float("inf")
