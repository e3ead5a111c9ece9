"""A library of one's own files, built once, opened again."""

import sys

import onbeat
from onbeat.examples import embedded_motions, embedded_song
from onbeat.files import make_folder
from onbeat.moves.build import build_library

folder = make_folder(sys.argv[1] if len(sys.argv) > 1 else "made")

# A folder of motion capture; here, three clips of the troupe.
clips = make_folder(folder / "clips")
for number, motion in enumerate(embedded_motions()[:3]):
    onbeat.write_motion(motion, clips / f"clip_{number}.bvh")

# Only what changed since the last time is read.
library = build_library([clips], folder / "library")
for line in (*library.notes, *library.problems):
    print(line)

song, _, _ = embedded_song(seconds=8.0)
dance = onbeat.make_dance(song, library)
print(f"{dance.motion.duration:.2f} s of dance with {len(dance.document.joins)} joins")
print(f"from {library.seconds:.0f} s of motion")
