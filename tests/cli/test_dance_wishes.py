"""``onbeat dance --without --prefer --keep``: what a user wishes of a dance."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from onbeat.examples import embedded_motions
from onbeat.formats import write_motion

Run = Callable[..., tuple[int, str, str]]

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")


@pytest.fixture(scope="module")
def clips(cache: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three short clips in a folder; no library of the whole troupe is made for them."""
    assert cache.is_dir()  # in which their own is kept
    folder = tmp_path_factory.mktemp("clips")
    for name, motion in zip("abc", embedded_motions(), strict=False):
        write_motion(motion[:400], folder / f"{name}.npz")
    return folder


def moves_of(folder: Path) -> list[dict[str, float | str]]:
    return json.loads((folder / "dance.json").read_bytes())["moves"]


def test_a_dance_keeps_a_stretch_of_the_one_before(run: Run, song: Path, clips: Path, tmp_path: Path) -> None:
    words = (song, "--moves", clips, "-o", tmp_path, "--no-mirror", "--fps", "30")
    assert run(*words)[0] == 0
    first = moves_of(tmp_path)
    shown = {str(move["clip"]).removesuffix("~mirror") for move in first}
    liked = sorted(shown)[0]
    status, _, err = run(*words, "--keep", f"{tmp_path}/dance.json:0-2.5", "--prefer", liked, "--seed", "1")
    assert status == 0, err
    again = moves_of(tmp_path)
    assert [move["clip"] for move in again if move["at_s"] < 2.5] == [m["clip"] for m in first if m["at_s"] < 2.5]
    told = json.loads((tmp_path / "dance.json").read_bytes())["metrics"]["wishes"]
    assert told["kept_s"] == 2.5
    assert told["favourites_s"] > 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--without", "nobody"), "no clip 'nobody' among the"),
        (("--keep", "dance.json"), "--keep 'dance.json': give a dance.json and seconds of the song"),
        (("--keep", "dance.json:1-b"), "--keep 'dance.json:1-b': give a dance.json and seconds"),
        (("--keep", "none.json:1-2"), "--keep: cannot read none.json: No such file"),
        (("--keep", "ODD:1-2"), "not a dance document"),
    ],
)
def test_wishes_that_cannot_be_are_said(
    run: Run, song: Path, clips: Path, tmp_path: Path, words: tuple[str, ...], message: str
) -> None:
    odd = tmp_path / "odd.json"
    odd.write_text('{"version": 1, "moves": 3}')
    words = tuple(word.replace("ODD", str(odd)) for word in words)
    status, out, err = run(song, "--moves", clips, "-o", tmp_path / "dance", *words)
    assert status == 1
    assert out == ""
    assert message in err
    assert err.count("\n") == 1
