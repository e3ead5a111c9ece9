"""What a paper is done again on: the embedded troupe and songs, or files that somebody has."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from onbeat.errors import OnbeatError


@dataclass(frozen=True)
class Data:
    """What the experiments run on.

    Parameters
    ----------
    motions : motion files and folders of them; empty for the embedded troupe.
    songs : audio files; empty for the embedded songs.
    quick : fewer repetitions and shorter songs, for a first look: figures come out rougher.
    seed : of the embedded troupe and songs, and of everything that is drawn by chance.
    """

    motions: tuple[Path, ...] = ()
    songs: tuple[Path, ...] = ()
    quick: bool = False
    seed: int = 0

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
