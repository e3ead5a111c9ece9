"""Hear a song, and hear whether the beats are right."""

import sys

import numpy as np
import soundfile

import onbeat
from onbeat.files import make_folder
from onbeat.music.audio import RATE, read_blocks, read_stereo
from onbeat.music.clicks import write_with_clicks
from onbeat.music.picture import write_picture

folder = make_folder(sys.argv[1] if len(sys.argv) > 1 else "made")

# The embedded song knows its own beats; here it is only a sound file like any other.
truth, samples, rate = onbeat.embedded_song(seconds=20.0)
soundfile.write(folder / "song.wav", samples, rate)

song = onbeat.listen(folder / "song.wav")
print(f"{song.tempo:.1f} beats a minute, {song.meter} in a bar, {len(song.beats)} beats")
off = np.abs(truth.beats[:, None] - song.beats).min(axis=1)
print(f"half of the beats played are met within {1000 * np.median(off):.0f} ms")

# Everything that was heard, as a document and as a picture; and the song with a click on every beat.
(folder / "song.json").write_bytes(song.to_json())
write_picture(folder / "picture.png", read_blocks(folder / "song.wav"), RATE, song)
write_with_clicks(folder / "clicks.wav", *read_stereo(folder / "song.wav"), song)
