"""The keyposes of a dance, with its song's beats and without; and what they are good for."""

import sys
from pathlib import Path

import numpy as np

import onbeat
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.keyposes.segments import segments
from onbeat.viewer.keypose.sheet import write_keypose_sheet
from onbeat.viewer.sheet import write_png

made = Path(sys.argv[1] if len(sys.argv) > 1 else "made")
made.mkdir(exist_ok=True)
danced = perform(DANCERS[3], [FOLK_DANCE], speed=1.0, cycles=2, rng=np.random.default_rng(0))

found = onbeat.find_keyposes(danced.motion, danced.beats)
off = np.abs(found.times[:, None] - danced.keyposes).min(axis=0)
print(f"{len(found)} keyposes; the true ones are at most {1000 * off.max():.0f} ms from one that was found")

# Without music the dance's own rests keep the beat.
own = motion_beats(danced.motion)
kept, true = (60.0 / np.median(np.diff(beats)) for beats in (own, danced.beats))
print(f"its own pulse: {kept:.0f} beats a minute; danced at {true:.0f}")

# From keypose to keypose: the pieces that are recognised and retimed.
longest = max(segments(found), key=lambda part: part.duration)
print(f"the longest segment goes from {longest.start:.2f} to {longest.end:.2f} s")

print(f"a sheet to print: {write_keypose_sheet(made / 'keyposes.png', found, danced.motion, cycle=12)[0]}")
write_png(made / "picture.png", onbeat.contact_sheet(danced.motion, found.times[:8], columns=4, size=(240, 240)))
