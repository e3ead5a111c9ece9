"""Recognisers as files: the same answers back, the same bytes, and clear words for what is none."""

from __future__ import annotations

import io
import json
import zipfile
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import FormatError, OnbeatError
from onbeat.recognition.model_file import load_recogniser, save_recogniser
from onbeat.recognition.recogniser import Recogniser
from recognition_takes import takes


@pytest.fixture(scope="module")
def recogniser() -> Recogniser:
    return Recogniser.train(takes(2), np.random.default_rng(0), newcomers=True)


@pytest.fixture
def stored(recogniser: Recogniser, tmp_path: Path) -> Path:
    save_recogniser(recogniser, tmp_path / "model.npz")
    return tmp_path / "model.npz"


def changed(path: Path, **arrays: np.ndarray) -> Path:
    with np.load(path) as old:
        kept = {name: old[name] for name in old.files}
    np.savez(path, **{**kept, **arrays})
    return path


def header(path: Path) -> dict[str, object]:
    with np.load(path) as stored:
        return json.loads(stored["header"].tobytes())


def with_header(path: Path, **fields: object) -> Path:
    return changed(path, header=np.frombuffer(json.dumps({**header(path), **fields}).encode(), np.uint8))


def test_what_is_read_answers_as_what_was_written(recogniser: Recogniser, stored: Path):
    probes = takes(1, seed=3)
    assert load_recogniser(stored).predict(probes) == recogniser.predict(probes)


def test_the_same_recogniser_makes_the_same_bytes(recogniser: Recogniser, stored: Path):
    first = stored.read_bytes()
    save_recogniser(load_recogniser(stored), stored)
    assert stored.read_bytes() == first


@pytest.mark.parametrize(("tasks", "people", "count"), [(1, 1, 1), (4, 1, 1), (1, 4, 2)])
def test_a_recogniser_that_had_little_to_learn_from_is_kept_too(tmp_path: Path, tasks: int, people: int, count: int):
    model = Recogniser.train(takes(count, tasks=tasks, people=people), np.random.default_rng(0))
    save_recogniser(model, tmp_path / "one.npz")
    assert load_recogniser(tmp_path / "one.npz").predict(takes(1)) == model.predict(takes(1))


def test_a_missing_file_and_a_missing_folder_are_said(recogniser: Recogniser, tmp_path: Path):
    with pytest.raises(FormatError, match=r"no recogniser .*none\.npz"):
        load_recogniser(tmp_path / "none.npz")
    with pytest.raises(FormatError, match="cannot read"):
        load_recogniser(tmp_path)
    with pytest.raises(OnbeatError, match="cannot write"):
        save_recogniser(recogniser, tmp_path / "none" / "model.npz")


def test_another_version_is_refused(stored: Path):
    with pytest.raises(FormatError, match="version 3, this program reads 1 and 2"):
        load_recogniser(with_header(stored, version=3))


def test_a_file_of_the_version_before_guesses_nothing(recogniser: Recogniser, stored: Path):
    old = load_recogniser(with_header(stored, version=1, task_across=None, person_across=None))
    assert recogniser.across.task is not None
    assert old.across == (None, None)
    for one, before in zip(recogniser.predict(takes(1)), old.predict(takes(1)), strict=True):
        assert before == one._replace(task_across=(), person_across=())


def test_another_programs_archive_is_refused(tmp_path: Path, stored: Path):
    np.savez(tmp_path / "other.npz", weights=np.zeros(3))
    with pytest.raises(FormatError, match="another program"):
        load_recogniser(tmp_path / "other.npz")
    with pytest.raises(FormatError, match="'song'"):
        load_recogniser(with_header(stored, format="song"))


@pytest.mark.parametrize("data", [b"", b"PK", b"not a zip at all", b"\x93NUMPY"])
def test_bytes_that_are_no_archive_are_refused(tmp_path: Path, data: bytes):
    (tmp_path / "bad.npz").write_bytes(data)
    with pytest.raises(FormatError, match="no whole recogniser"):
        load_recogniser(tmp_path / "bad.npz")


def test_a_cut_or_flipped_file_never_raises_another_error(stored: Path):
    data, probe = stored.read_bytes(), takes(1)[:1]
    rng = np.random.default_rng(0)
    for at in rng.integers(0, len(data), 60).tolist():
        for damaged in (data[:at], data[:at] + bytes([data[at] ^ 0xFF]) + data[at + 1 :]):
            stored.write_bytes(damaged)
            with suppress(OnbeatError):
                load_recogniser(stored).predict(probe)


def test_pickles_are_not_opened(stored: Path):
    name = next(n for n in np.load(stored).files if n != "header")
    with pytest.raises(FormatError, match="no whole recogniser"):
        load_recogniser(changed(stored, **{name: np.array([{}], dtype=object)}))


def test_arrays_that_do_not_fit_the_header_are_refused(stored: Path):
    names = [n for n in np.load(stored).files if n != "header"]
    for name in names:
        with np.load(stored) as arrays:
            good = arrays[name]
        with pytest.raises(FormatError, match=name):
            load_recogniser(changed(stored, **{name: good.astype(np.float32)}))
        changed(stored, **{name: good})
    with pytest.raises(FormatError, match="no whole recogniser"):
        load_recogniser(with_header(stored, elements=["hips"]))


def test_numbers_that_are_none_are_refused(stored: Path):
    name = next(n for n in np.load(stored).files if n.endswith(("whitener", "references")))
    with np.load(stored) as arrays:
        bad = np.full_like(arrays[name], np.nan)
    with pytest.raises(FormatError, match="not a number"):
        load_recogniser(changed(stored, **{name: bad}))


def test_an_archive_that_promises_too_much_is_not_unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("onbeat.recognition.model_file.LARGEST", 1000)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("header.npy", bytes(2000))
    (tmp_path / "bomb.npz").write_bytes(buffer.getvalue())
    with pytest.raises(FormatError, match="2000 bytes promised"):
        load_recogniser(tmp_path / "bomb.npz")
