import builtins
import collections
import os
import pickle
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats.named.pickled import load_pickled_arrays

PROTOCOLS = range(pickle.HIGHEST_PROTOCOL + 1)


def kept(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path


def refusal(path: Path, content: bytes) -> str:
    """The message with which bytes are refused, in little time."""
    kept(path, content)
    start = time.process_time()
    with pytest.raises(FormatError) as caught:
        load_pickled_arrays(path)
    assert time.process_time() - start < 2
    return str(caught.value)


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_dictionaries_of_arrays(tmp_path, protocol):
    given = {
        "smpl_poses": np.random.default_rng(0).normal(size=(7, 72)),
        "fortran": np.asfortranarray(np.arange(6, dtype=np.float32).reshape(2, 3)),
        "strided": np.arange(10)[::3],
        "big": np.arange(3, dtype=">f8"),
        "empty": np.zeros((0, 3)),
        "bytes_": np.arange(256, dtype=np.uint8),
        "scalar": np.float32(2.5),
        "flag": np.bool_(True),
        "fps": 30,
        "rate": 29.97,
        "gender": "male",
        "numpy_text": np.str_("female"),
        "names": ["pelvis", "left_hip", "ä"],
        "nested": [[1, 2], (3, 4.5)],
        "frames": [np.zeros(3), np.ones(3)],
    }
    left_out = {"nothing": None, "ragged": [[1], [2, 3]], "more": {"a": 1}, "mixed": ["a", 1], "raw": b"x"}
    found = load_pickled_arrays(kept(tmp_path / "a.pkl", pickle.dumps(given | left_out, protocol)))
    assert list(found) == list(given)
    for key, value in given.items():
        np.testing.assert_array_equal(found[key], np.asarray(value))
    assert found["smpl_poses"].dtype == np.float64
    assert found["fortran"].dtype == np.float32


@pytest.mark.parametrize("core", [b"numpy.core", b"numpy._core"])
def test_names_of_both_numpys(tmp_path, core):
    content = pickle.dumps({"a": np.arange(3.0), "s": np.float64(1)}, 2)
    other = content.replace(b"numpy._core", core).replace(b"numpy.core", core)
    assert load_pickled_arrays(kept(tmp_path / "a.pkl", other))["a"].tolist() == [0, 1, 2]


def test_what_python_2_wrote(tmp_path):
    content = (
        b"\x80\x02}q\x00U\x01aq\x01cnumpy.core.multiarray\n_reconstruct\nq\x02cnumpy\nndarray\nq\x03K\x00\x85q\x04"
        b"U\x01bq\x05\x87q\x06Rq\x07(K\x01K\x02\x85q\x08cnumpy\ndtype\nq\tU\x02f8q\nK\x00K\x01\x87q\x0bRq\x0c(K\x03"
        b"U\x01<q\rNNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00tq\x0eb\x89U\x10"
        + np.array([1.5, -2]).tobytes()
        + b"q\x0f"
        b"tq\x10bs."
    )
    assert load_pickled_arrays(kept(tmp_path / "a.pkl", content))["a"].tolist() == [1.5, -2]


def test_one_dictionary_in_another(tmp_path):
    one = pickle.dumps({"walk": {"fps": 30, "a": np.ones(2)}})
    assert load_pickled_arrays(kept(tmp_path / "a.pkl", one))["fps"] == 30
    two = pickle.dumps({"walk": {"fps": 30}, "run": {"fps": 30}})
    assert "holds 2 motions ('walk', 'run', …); save each as a file" in refusal(tmp_path / "a.pkl", two)


class Caller:
    def __init__(self, call, *arguments):
        self.call, self.arguments = call, arguments

    def __reduce__(self):
        return self.call, self.arguments


@pytest.mark.parametrize("protocol", PROTOCOLS)
@pytest.mark.parametrize(
    ("call", "arguments", "name"),
    [
        (os.system, ("touch {}",), "posix.system|nt.system"),
        (subprocess.check_call, (["touch", "{}"],), "check_call"),
        (builtins.eval, ("open('{}', 'w')",), "eval"),
        (builtins.exec, ("open('{}', 'w')",), "exec"),
        (builtins.open, ("{}", "w"), "open"),
        (builtins.getattr, ("", "join"), "getattr"),
        (np.load, ("{}",), "numpy"),
        (collections.OrderedDict, (), "OrderedDict"),
    ],
)
def test_nothing_that_is_named_is_called(tmp_path, protocol, call, arguments, name):
    made = tmp_path / "made"
    filled = [[str(made) if w == "{}" else w for w in a] if isinstance(a, list) else a.format(made) for a in arguments]
    content = pickle.dumps({"smpl_poses": np.zeros((2, 72)), "x": Caller(call, *filled)}, protocol)
    message = refusal(tmp_path / "a.pkl", content)
    assert any(word in message for word in name.split("|"))
    assert "nothing was executed" in message
    assert "np.savez" in message
    assert not made.exists()


@pytest.mark.parametrize(
    ("content", "found"),
    [
        (b"cos\nsystem\n(S'touch made'\ntR.", "os.system"),
        (b"(S'touch made'\nios\nsystem\n.", "instruction INST"),
        (b"(cos\nsystem\nS'touch made'\no.", "os.system"),
        (b"\x80\x02cnumpy\nndarray\n)\x81.", "instruction NEWOBJ"),
        (b"cnumpy\nndarray\n(K\x09tR.", "calls numpy's ndarray in a way"),
        (b"cnumpy\ndtype\nN(K\x01tbR.", "sets the state of something that is no array"),
        (b"cbuiltins\n__import__\n(S'os'\ntR.", "builtins.__import__"),
        (b"Pid\n.", "instruction PERSID"),
        (b"K\x01Q.", "instruction BINPERSID"),
        (b"\x82\x01.", "instruction EXT1"),
        (b"\x80\x05\x97.", "instruction NEXT_BUFFER"),
        (b"\x80\x04\x8f.", "instruction EMPTY_SET"),
        (b"K\x01K\x02R.", "calls something that is no known name"),
        (b"K\x01K\x02b.", "sets the state"),
        (b"K\x01K\x02a.", "appends to something that is no list"),
        (b"}N)s.", "NoneType as a key"),
        (b"}.}.", "2 bytes follow the end"),
        (b"].", "holds a list; a dictionary"),
        (b"I" + b"9" * 300 + b"\n.", "more than 64 bits"),
        (b"K\x01p99999999999\n.", "numbers that are too large"),
        (b"\x1f\x8b\x08\x00", "packed by gzip"),
        (b"PK\x03\x04", "a zip"),
        (b"", "not a whole pickle"),
        (b"\x80\x04}", "not a whole pickle"),
        (b"h\x05.", "not a whole pickle"),
        (b"u.", "not a whole pickle"),
        (b"\xff", "not a whole pickle"),
        (b"\x80\x05B\xff\xff\xff\x7fabc.", "not a whole pickle"),
        (b"\x80\x05\x8e" + b"\xff" * 6 + b"\x00\x00abc.", "not a whole pickle"),
        (b"X\x01\x00\x00\x00\xff.", "not a whole pickle"),
    ],
)
def test_other_instructions_are_refused(tmp_path, content, found):
    message = refusal(tmp_path / "a.pkl", content)
    assert any(words in message for words in found.split("|")), message


def test_items_that_are_not_plain_are_refused(tmp_path):
    for array, words in (
        (np.array([None]), "Python objects"),
        (np.zeros(2, dtype=[("x", "f8")]), "numbers and text|structures"),
        (np.zeros(2, complex), "items of type 'c16'"),
        (np.zeros(2, "M8[s]"), "items of type 'M8'"),
    ):
        message = refusal(tmp_path / "a.pkl", pickle.dumps({"a": array}))
        assert any(part in message for part in words.split("|")), message


def test_arrays_have_the_bytes_of_their_shape(tmp_path):
    content = pickle.dumps({"a": np.arange(300.0)}, 4)
    assert "as many bytes as its shape needs" in refusal(
        tmp_path / "a.pkl", content.replace(b"M\x2c\x01", b"M\x2d\x01")
    )


def test_bombs_do_not_hang(tmp_path):
    path = tmp_path / "a.pkl"
    nested = b"]" * 10**6 + b"a" * (10**6 - 1) + b"."
    assert "more than 300,000 instructions" in refusal(path, nested)
    refusal(path, b"]" * 30_000 + b"a" * 29_999 + b".")
    refusal(path, b"(" * 30_000 + b"t" * 30_000 + b".")
    refusal(path, b"}" + b"S'a'\n}" * 30_000 + b"s" * 30_000 + b"s.")
    for empty, end in ((b"]", b"e"), (b"", b"t")):
        laughs = b"\x80\x04}\x8c\x01a(" + (b"]" if end == b"e" else b")") + b"\x94"
        for level in range(40):
            laughs += b"0" + (empty + b"(") + b"h" + bytes([level]) + b"h" + bytes([level]) + end + b"\x94"
        kept(path, laughs[: laughs.index(b"(")] + laughs[laughs.index(b"(") + 1 :] + b"s.")
        start = time.process_time()
        with pytest.raises(FormatError, match="nested deeper than"):
            load_pickled_arrays(path)
        assert time.process_time() - start < 2
    again = b"\x80\x02c_codecs\nencode\nq\x01X\x40\x42\x0f\x00" + b"x" * 10**6 + b"q\x02X\x06\x00\x00\x00latin1q\x03"
    assert "more bytes than it has" in refusal(path, again + b"h\x01h\x02h\x03\x86R" * 10**4 + b".")
    many = pickle.dumps(dict.fromkeys(range(20000), 0))
    assert "more than 10,000 keys" in refusal(path, many)


def test_lists_that_hold_themselves(tmp_path):
    loop: list = []
    loop += [loop, loop]
    assert "nested deeper" in refusal(tmp_path / "a.pkl", pickle.dumps({"a": loop}))
    ring: dict = {}
    ring["a"] = ring
    assert load_pickled_arrays(kept(tmp_path / "a.pkl", pickle.dumps(ring))) == {}
