"""Motion files: one file per format, read and written through the registry."""

from onbeat.formats.conventions import Convention
from onbeat.formats.read import motion_files, read_file, read_markers, read_motion
from onbeat.formats.write import write_markers, write_motion

__all__ = [
    "Convention",
    "motion_files",
    "read_file",
    "read_markers",
    "read_motion",
    "write_markers",
    "write_motion",
]
