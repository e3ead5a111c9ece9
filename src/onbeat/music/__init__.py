"""Hearing a song: its beats, downbeats, chord changes and intensity, from any audio file."""

from onbeat.music.listen import METHODS, listen, listen_samples
from onbeat.music.song import Song
from onbeat.music.tempo import danceable_beats

__all__ = ["METHODS", "Song", "danceable_beats", "listen", "listen_samples"]
