import io

import numpy as np
import pytest

from awkward import CASES
from onbeat.errors import FormatError
from onbeat.formats import read_motion, text
from onbeat.formats.bvh.read import parse_bvh
from onbeat.formats.bvh.write import bvh_text
from onbeat.formats.conventions import Convention
from onbeat.formats.text import decoded, numbers, pieces, small_text
from persons import AMC, ASF, person, swinging


def read(data: bytes, rest: bytes = b"") -> list[bytes]:
    return list(pieces(io.BytesIO(data), "a.txt", rest))


@pytest.mark.parametrize("chunk", [1, 2, 7, 16, 100])
@pytest.mark.parametrize("rest", [b"", b"12", b"  1 2"])
def test_pieces_are_whole_words_however_they_fall(chunk, rest, monkeypatch):
    monkeypatch.setattr(text, "CHUNK", chunk)
    data = b"345 6.7e8\t\r\n  -9\n\n\n" + b" " * 50 + b"abc"
    found = read(data, rest)
    assert b"".join(found).split() == (rest + data).split()
    assert all(piece[-1:].isspace() for piece in found[:-1])
    assert b"".join(found).count(b"\n") == (rest + data).count(b"\n")


@pytest.mark.parametrize("chunk", [5, 64, 333])
def test_files_are_the_same_motion_in_pieces_of_any_size(chunk, monkeypatch, tmp_path):
    motion = swinging(person(), 20)
    for name, content in (("a.bvh", bvh_text(motion, Convention())), ("a.asf", ASF), ("a.amc", AMC)):
        (tmp_path / name).write_text(content)
    whole = [read_motion(tmp_path / name, fps=60) for name in ("a.bvh", "a.amc")]
    monkeypatch.setattr(text, "CHUNK", chunk)
    for name, motion in zip(("a.bvh", "a.amc"), whole, strict=True):
        again = read_motion(tmp_path / name, fps=60)
        np.testing.assert_array_equal(again.rotations, motion.rotations)
        np.testing.assert_array_equal(again.root_positions, motion.root_positions)


@pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
def test_awkward_files_are_the_same_in_small_pieces(case, monkeypatch):
    def outcome() -> object:
        try:
            return parse_bvh(decoded(case.data), "a.bvh").positions.tobytes()
        except FormatError as error:
            return str(error)

    whole = outcome()
    monkeypatch.setattr(text, "CHUNK", 11)
    assert outcome() == whole


def test_white_space_and_words_without_end_are_refused(monkeypatch):
    monkeypatch.setattr(text, "CHUNK", 1000)
    monkeypatch.setattr(text, "BLANK", 5000)
    monkeypatch.setattr(text, "LONGEST_WORD", 3000)
    with pytest.raises(FormatError, match=r"a\.txt: more than 0 MB of white space in a row"):
        read(b"1 " + b" " * 9000 + b"2")
    with pytest.raises(FormatError, match=r"a\.txt: a word of more than 3000 letters found \(b'77777"):
        read(b"1 " + b"7" * 9000)
    assert b"".join(read(b"1 " + b" \n" * 2000 + b"2")).split() == [b"1", b"2"]


def test_what_follows_the_last_word_is_no_word():
    assert read(b"1 2\r\n\x1a") == [b"1 2\r\n"]
    assert b"".join(read(b"1 2\x00\x00")).strip() == b"1 2"
    assert read(b"") == []


def test_encodings_are_recognised():
    assert decoded("Fuß\r\nx\ry".encode()) == "Fuß\nx\ny"
    assert decoded("\ufeffFuß".encode()) == "Fuß"
    assert decoded("Fuß".encode("latin-1")) == "Fuß"
    assert decoded("Fuß".encode("utf-16")) == "Fuß"


def test_numbers_are_read_to_the_last_bit():
    values = np.random.default_rng(0).normal(size=5000) * 10.0 ** np.random.default_rng(1).integers(-9, 9, 5000)
    plain = " ".join(repr(float(v)) for v in values)
    assert numbers(plain.encode(), 1, "a.txt").tolist() == values.tolist()
    assert numbers(plain.replace(" ", " \t ").encode(), 1, "a.txt").tolist() == values.tolist()
    assert numbers(b" \n", 1, "a.txt").size == 0


@pytest.mark.parametrize("word", ["1,5", "x", "--1", "1e", "1_000", "0x10", "１"])
def test_what_is_no_number_is_named_with_its_line(word):
    with pytest.raises(FormatError, match=r"a\.txt:6: a number is expected"):
        numbers(f"1 2\n3 {word} 4\n".encode(), 5, "a.txt")


def test_small_texts_are_small(tmp_path):
    (tmp_path / "a").write_text("x" * 100)
    assert len(small_text(tmp_path / "a", 100, "a skeleton")) == 100
    with pytest.raises(FormatError, match="a skeleton is expected"):
        small_text(tmp_path / "a", 99, "a skeleton")
    with pytest.raises(FormatError, match="cannot read"):
        small_text(tmp_path / "b", 99, "a skeleton")
