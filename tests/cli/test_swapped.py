"""Files in each other's place are told, with the command that is meant."""

from __future__ import annotations

from pathlib import Path

import pytest

from onbeat.cli.swapped import refuse_swapped, refuse_swapped_model
from onbeat.errors import OnbeatError

MEANT = "dance {song} --moves {motion}"


@pytest.mark.parametrize(
    ("song", "motion", "told"),
    [
        ("a.bvh", "b.ogg", "they look swapped; give `dance b.ogg --moves a.bvh`"),
        ("clips", "my song.mp3", "they look swapped; give `dance 'my song.mp3' --moves clips`"),
        ("a.bvh", None, "a.bvh is motion, no song; give `dance SONG --moves a.bvh`"),
        (None, "b.WAV", "b.WAV is a song, no motion; give `dance b.WAV --moves MOTION`"),
        ("a.ogg", "song:vibe-ace", "song:vibe-ace is a song, no motion; give `dance a.ogg --moves MOTION`"),
    ],
)
def test_motion_as_a_song_and_a_song_as_motion(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, song: str | None, motion: str | None, told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("clips").mkdir()
    Path("clips/one.bvh").touch()
    with pytest.raises(OnbeatError) as caught:
        refuse_swapped(song and Path(song), motion and Path(motion), MEANT)
    assert str(caught.value).endswith(told)


def test_what_is_in_its_place_is_let_through(tmp_path: Path) -> None:
    (tmp_path / "songs.mp3").mkdir()  # a folder of motion may be called so
    for song, motion in (
        (None, None),
        (tmp_path / "a.ogg", tmp_path),
        (tmp_path / "song.json", tmp_path / "songs.mp3"),
    ):
        refuse_swapped(song, motion, MEANT)
    refuse_swapped_model(tmp_path / "model.npz", [tmp_path / "a.bvh"])
    refuse_swapped_model(tmp_path / "model", [tmp_path / "a.npz"])


def test_motion_as_a_recogniser() -> None:
    with pytest.raises(OnbeatError, match=r"give `onbeat recognise m.npz a.bvh b.bvh`"):
        refuse_swapped_model(Path("a.bvh"), [Path("b.bvh"), Path("m.npz")])
    with pytest.raises(OnbeatError, match=r"give `onbeat recognise MODEL.npz a.bvh b.bvh`"):
        refuse_swapped_model(Path("a.bvh"), [Path("b.bvh")])
