"""What a paper is done again on: the embedded troupe and songs, or files that somebody has."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from onbeat.errors import OnbeatError

if TYPE_CHECKING:
    from onbeat.motion import Motion


@dataclass(frozen=True)
class Data:
    """What the experiments run on.

    Parameters
    ----------
    motions : motion files and folders of them; empty for the embedded troupe.
    songs : audio files; empty for the embedded songs.
    quick : fewer repetitions and shorter songs, for a first look: figures come out rougher.
    seed : of the embedded troupe and songs, and of everything that is drawn by chance.
    fps : frames a second of motion files that store none.

    Raises
    ------
    OnbeatError
        If there is no such rate.
    """

    motions: tuple[Path, ...] = ()
    songs: tuple[Path, ...] = ()
    quick: bool = False
    seed: int = 0
    fps: float | None = None

    def __post_init__(self) -> None:
        if self.fps is not None and not 0.1 <= self.fps <= 10000:
            raise OnbeatError(f"{self.fps:g} frames a second cannot be; give a rate from 0.1 to 10000")

    @property
    def embedded(self) -> bool:
        """Whether the embedded troupe dances."""
        return not self.motions

    def motion_files(self) -> list[Path]:
        """The motion files that were given, those in folders too, by name.

        Raises
        ------
        OnbeatError
            If a path is not there, or no motion lies in any.
        """
        from onbeat.formats.read import motion_files

        missing = [path for path in self.motions if not path.exists()]
        if missing:
            raise OnbeatError(f"no file or folder {missing[0]}; give motion files or folders of them to --motions")
        found = [file for path in self.motions for file in (motion_files(path) if path.is_dir() else [path])]
        if self.motions and not found:
            names = ", ".join(map(str, self.motions))
            raise OnbeatError(f"no motion file in {names}; give BVH, ASF/AMC, C3D or npz files to --motions")
        return found

    def motion(self, path: Path) -> Motion:
        """A motion file, at the rate that was given where it stores none.

        Raises
        ------
        OnbeatError
            If it cannot be read.
        """
        from onbeat.formats.read import read_motion

        return read_motion(path, fps=self.fps)
