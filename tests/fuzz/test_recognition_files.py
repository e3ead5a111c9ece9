"""Any bytes as a file of labels or as a recogniser: what is in it, or one clear sentence, never anything else."""

from __future__ import annotations

import io
import json
import tempfile
import warnings
from functools import cache
from pathlib import Path

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from fuzzing import patient
from onbeat.errors import OnbeatError
from onbeat.recognition.labels import read_labels
from onbeat.recognition.model_file import load_recogniser, save_recogniser
from onbeat.recognition.recogniser import Recogniser
from recognition_takes import takes

LABELS = "file,from,to,task,person,cycle\na.bvh,0,1.5,bow,Aiko,0\nb.bvh,1e0,2,turn,Bruno,1\n"
WORDS = [
    "",
    ",",
    "\n",
    "\r",
    '"',
    ";",
    "\x00",
    "nan",
    "-inf",
    "1e999",
    "-1",
    "1.5",
    "٣",
    "é",
    "cycle",
    "," * 9,
    "\ufeff",
]


@st.composite
def damaged(draw) -> str:
    """Labels with a few places cut, doubled or overwritten."""
    text = LABELS
    for _ in range(draw(st.integers(1, 5))):
        a = draw(st.integers(0, len(text)))
        b = min(len(text), a + draw(st.integers(0, 20)))
        text = text[:a] + draw(st.sampled_from([*WORDS, text[a:b] * 2])) + text[b:]
    return text


@patient
@given(data=st.one_of(damaged().map(lambda text: text.encode()), st.binary(max_size=200)))
@example(data=b"file\n\xff\xfe\n")
@example(data=b"\x00" * 40)
def test_any_labels(tmp_path: Path, data: bytes):
    path = tmp_path / "labels.csv"
    path.write_bytes(data)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            found = read_labels(path)
        except OnbeatError as error:
            assert str(path) in str(error)  # noqa: PT017
        else:
            assert found


@cache
def stored() -> bytes:
    """A small recogniser's file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.npz"
        save_recogniser(Recogniser.train(takes(1, tasks=2, people=2), np.random.default_rng(0)), path)
        return path.read_bytes()


def loads(path: Path) -> None:
    """Nothing but answers or a refusal that names the file; no warning of NumPy's."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            model = load_recogniser(path)
        except OnbeatError as error:
            assert str(path) in str(error)  # noqa: PT017
            return
        try:
            answers = model.predict(takes(1)[:2])
        except OnbeatError:
            return
    assert all(0 <= match.probability <= 1 for one in answers for match in (*one.task_scores, *one.person_scores))


@patient
@given(
    edits=st.lists(st.tuples(st.integers(0, 1 << 20), st.integers(0, 40), st.binary(max_size=20)), max_size=4),
    end=st.integers(0, 1 << 20),
)
def test_a_recogniser_with_other_bytes(tmp_path: Path, edits: list[tuple[int, int, bytes]], end: int):
    data = stored()
    for at, length, new in edits:
        at %= len(data)
        data = data[:at] + new + data[at + length :]
    path = tmp_path / "model.npz"
    path.write_bytes(data if end % 2 else data[: end % len(data)])
    loads(path)


VALUES = st.one_of(
    st.none(), st.booleans(), st.integers(-(1 << 40), 1 << 40), st.text(max_size=5), st.just([]), st.just({}),
    st.floats(allow_nan=False, allow_infinity=False),
)  # fmt: skip


def paths_of(tree: object, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Where there is a value in a JSON document."""
    parts = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    return [path] * bool(path) + [found for key, part in parts for found in paths_of(part, (*path, key))]


@patient
@given(data=st.data())
def test_a_recogniser_with_another_header(tmp_path: Path, data: st.DataObject):
    arrays = dict(np.load(io.BytesIO(stored())))
    header = json.loads(arrays["header"].tobytes())
    *way, last = data.draw(st.sampled_from(paths_of(header)))
    inside = header
    for key in way:
        inside = inside[key]
    if isinstance(last, str) and data.draw(st.booleans()):
        del inside[last]
    else:
        inside[last] = data.draw(VALUES)
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), np.uint8)
    np.savez(tmp_path / "model.npz", **arrays)
    loads(tmp_path / "model.npz")


@patient
@given(
    pick=st.integers(0, 100), place=st.integers(0, 1 << 20),
    value=st.sampled_from([0.0, -1.0, 1e300, -1e300, 1e-300, np.inf, -np.inf, np.nan]),
    shape=st.sampled_from([None, (0,), (1,), (3, 3), (2, 0), ()]),
)  # fmt: skip
def test_a_recogniser_with_other_numbers(
    tmp_path: Path, pick: int, place: int, value: float, shape: tuple[int, ...] | None
):
    arrays = {name: values.copy() for name, values in np.load(io.BytesIO(stored())).items()}
    names = [name for name in arrays if name != "header"]
    name = names[pick % len(names)]
    if shape is not None:
        arrays[name] = np.zeros(shape)
    elif arrays[name].dtype == np.float64 and arrays[name].size:
        arrays[name].ravel()[place % arrays[name].size] = value
    np.savez(tmp_path / "model.npz", **arrays)
    loads(tmp_path / "model.npz")
