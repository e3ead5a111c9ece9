"""Hearing a song."""

from onbeat.music.song import Song

__all__ = ["Song"]
