import io
import struct
import time
import tracemalloc
import zipfile
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats.named.arrays import MAX_MEMBERS, NpzArrays, load_arrays


def npy(array: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array)
    return buffer.getvalue()


def zipped(path: Path, members: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(path, "w", method) as file:
        for name, content in members.items():
            file.writestr(name, content)
    return path


def refused_cheaply(path: Path, match: str) -> None:
    tracemalloc.start()
    start = time.process_time()
    with pytest.raises(FormatError, match=match):
        load_arrays(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert time.process_time() - start < 2
    assert peak < 30e6


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_arrays_come_as_numpy_wrote_them(tmp_path, save):
    given = {
        "a": np.arange(12.0).reshape(3, 4),
        "fortran": np.asfortranarray(np.arange(6, dtype=np.float32).reshape(2, 3)),
        "big": np.arange(4, dtype=">i4"),
        "scalar": np.array(120.0),
        "text": np.array(["left", "rechts ä"]),
        "none": np.zeros((0, 3)),
        "flags": np.array([True, False]),
        "long": np.random.default_rng(0).normal(size=(200_000,)),
    }
    save(tmp_path / "a.npz", **given)
    found = load_arrays(tmp_path / "a.npz")
    assert list(found) == list(given)
    for key, array in given.items():
        np.testing.assert_array_equal(found[key], array)
        assert found[key].dtype == array.dtype


def test_only_what_is_asked_for_is_inflated(tmp_path):
    members = {
        "a.npy": npy(np.ones(3)),
        "readme.txt": b"hello",
        "objects.npy": npy(np.zeros(2)).replace(b"<f8", b"|O "),
    }
    zipped(tmp_path / "a.npz", members | {"broken.npy": b"no array"})
    with NpzArrays(tmp_path / "a.npz") as file:
        assert sorted(file) == ["a", "broken", "objects"]
        assert file["a"].tolist() == [1, 1, 1]
        with pytest.raises(FormatError, match="'broken' is no array"):
            file["broken"]


def test_objects_are_refused_and_not_unpickled(tmp_path):
    class Trap:
        def __reduce__(self):
            return (Path(tmp_path / "sprung").touch, ())

    np.savez(tmp_path / "a.npz", trap=np.array([Trap()], dtype=object), rows=np.zeros(2, dtype=[("x", "f8")]))
    with NpzArrays(tmp_path / "a.npz") as file:
        with pytest.raises(FormatError, match="'trap' holds Python objects, which are not read, and nothing was exec"):
            file["trap"]
        with pytest.raises(FormatError, match="'rows' holds structures"):
            file["rows"]
    assert not (tmp_path / "sprung").exists()


def test_bombs_are_refused_before_they_are_inflated(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.npz", "w", zipfile.ZIP_DEFLATED) as file, file.open("a.npy", "w") as member:
        member.write(npy(np.zeros(0)).replace(b"(0,), ", b"(25000000,), ")[: 128 - 7] + b" " * 6 + b"\n")
        for _ in range(200):
            member.write(bytes(1_000_000))
    refused_cheaply(tmp_path / "a.npz", "would be 200,000,128 bytes out of a file of .*; at most 64,000,000")


def test_many_arrays_together_are_a_bomb_too(tmp_path):
    zipped(tmp_path / "a.npz", {f"a{n}.npy": npy(np.zeros(500_000)) for n in range(20)})
    with pytest.raises(FormatError, match="'a15' would be"):
        load_arrays(tmp_path / "a.npz")


def test_headers_that_promise_more_than_there_is(tmp_path):
    for shape in (
        b"(1000000000000,), ",
        b"(-3,), ",
        b"(4,), ",
        b"(" + b"2," * 40 + b"), ",
        b"(99999999999999999999999,), ",
    ):
        content = npy(np.zeros(3))
        zipped(
            tmp_path / "a.npz", {"a.npy": content.replace(b"(3,), ", shape)[:118] + b" " * 9 + b"\n" + content[128:]}
        )
        refused_cheaply(tmp_path / "a.npz", "does not fit its|does not tell")


def test_directories_are_bounded(tmp_path):
    zipped(tmp_path / "a.npz", {f"{n}.npy": b"" for n in range(MAX_MEMBERS + 1)})
    refused_cheaply(tmp_path / "a.npz", "members; a motion has at most")
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as file:
        for n in range(20_000):
            file.writestr(f"{n:040}.npy", b"")
    refused_cheaply(tmp_path / "a.npz", "its directory is of 1,")


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_other_zips_are_refused(tmp_path):
    path, content = tmp_path / "a.npz", npy(np.ones(3))
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("a.npy", content)
        file.writestr("a.npy", content)
    with pytest.raises(FormatError, match="two members have the same name"):
        load_arrays(path)
    zipped(path, {"a.npy": content}, zipfile.ZIP_LZMA)
    with pytest.raises(FormatError, match="packed by method 14; NumPy stores or deflates"):
        load_arrays(path)
    zipped(path, {"a.npy": content})
    locked = path.read_bytes()
    at = locked.index(b"PK\x01\x02") + 8
    path.write_bytes(locked[:at] + struct.pack("<H", 1) + locked[at + 2 :])
    with pytest.raises(FormatError, match="is encrypted; save it without a password"):
        load_arrays(path)
    zipped(path, {"deep/a.npy": content})
    assert list(load_arrays(path)) == ["deep/a"]


def test_damage_is_found(tmp_path):
    path = zipped(tmp_path / "a.npz", {"a.npy": npy(np.arange(1000.0))}, zipfile.ZIP_STORED)
    good = path.read_bytes()
    path.write_bytes(good[:3000] + b"\x55" + good[3001:])
    with pytest.raises(FormatError, match="'a' is damaged: Bad CRC-32"):
        load_arrays(path)
    for content in (good[: len(good) // 2], b"", b"text", good[:-8]):
        path.write_bytes(content)
        with pytest.raises(FormatError, match=r"cannot read .* as an \.npz"):
            load_arrays(path)
    for absent in (tmp_path / "no.npz", tmp_path):
        with pytest.raises(FormatError, match="cannot read"):
            load_arrays(absent)


def test_text_is_text(tmp_path):
    content = npy(np.array(["ab"]))
    zipped(tmp_path / "a.npz", {"a.npy": content[:-8] + b"\xff" * 8})
    with pytest.raises(FormatError, match="characters that do not exist"):
        load_arrays(tmp_path / "a.npz")
