"""Motion files: one file per format, read and written through the registry."""

from onbeat.formats.conventions import Convention
from onbeat.formats.registry import motion_files, read_motion, write_motion

__all__ = ["Convention", "motion_files", "read_motion", "write_motion"]
