"""Hearing a song: its beats, downbeats, chord changes and intensity, from any audio file."""

from onbeat.music.listen import METHODS, listen, listen_samples
from onbeat.music.song import Song

__all__ = ["METHODS", "Song", "listen", "listen_samples"]
