"""onbeat puts motion on the beat: motion capture and a song in, a dance on the music out."""

from onbeat.errors import OnbeatError
from onbeat.motion import Body, Motion, Skeleton
from onbeat.music import Song

__all__ = ["Body", "Motion", "OnbeatError", "Skeleton", "Song", "__version__"]
__version__ = "0.1.0"
