"""What ``onbeat retime`` writes: the motion, ``retime.json``, a figure, and a page with both dances side by side."""

from __future__ import annotations

from pathlib import Path

from onbeat.cli.time_flags import Music
from onbeat.errors import OnbeatError
from onbeat.files import make_folder, write_atomically
from onbeat.formats.joint_table import write_joint_table
from onbeat.formats.registry import writing
from onbeat.formats.write import write_motion
from onbeat.motion.joint_angles import JointAngles
from onbeat.music.audio import read_stereo
from onbeat.retime.document import RetimeDocument
from onbeat.retime.retime import Retimed
from onbeat.retime.sources import Table
from onbeat.viewer.pages.retime import write_retime_page
from onbeat.viewer.plots.limits import write_limits_figure
from onbeat.viewer.plots.retime import write_retime_figure
from onbeat.viewer.plots.retime_curves import look_at

DEFAULT = ".bvh"


def write_all(
    result: Retimed, document: RetimeDocument, source: Path, output: Path, music: Music | None, joint: str | None
) -> list[Path]:
    """Write everything, the motion first; the paths of what was written."""
    look_at(result, joint)  # refuses a joint that is none, before anything is written
    path = _motion_path(result, source, output)
    folder = make_folder(path.parent)
    if isinstance(result.dance, JointAngles):
        write_joint_table(result.dance, path)
    else:
        write_motion(result.dance, path)
    report, figure, overview = (folder / name for name in ("retime.json", "retime.png", "limits.png"))
    write_atomically(report, document.to_json())
    write_retime_figure(figure, [result], joint)
    write_limits_figure(overview, [result])
    written = [path, report, figure, overview]
    if isinstance(result.source, Table):
        return written
    page = folder / "retime.html"
    song = None if music is None else music.song
    sound = None if music is None or song is None else read_stereo(music.path)
    write_retime_page(page, result, result.source.motion, song, sound)
    return [*written, page]


def _motion_path(result: Retimed, source: Path, output: Path) -> Path:
    """A file's name as given; in a folder the dance's name in the dance's own format, if that can be written."""
    if output.suffix and not output.is_dir():
        return output
    if isinstance(result.dance, JointAngles):
        return output / source.name
    try:
        writing(source)
    except OnbeatError:
        return output / (source.stem + DEFAULT)
    return output / source.name
