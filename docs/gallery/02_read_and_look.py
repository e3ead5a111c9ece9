"""Read motion, move it over to other formats, look at it."""

import sys

import numpy as np

import onbeat
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.files import make_folder
from onbeat.viewer.sheet import write_png

folder = make_folder(sys.argv[1] if len(sys.argv) > 1 else "made")

# One dancer of the embedded troupe, written as a studio would deliver it.
danced = perform(DANCERS[2], [FOLK_DANCE], speed=1.0, cycles=1, rng=np.random.default_rng(0))
onbeat.write_motion(danced.motion, folder / "folk_dance.bvh")

motion = onbeat.read_motion(folder / "folk_dance.bvh")
print(f"{len(motion)} frames at {motion.fps:g} a second, {motion.duration:.1f} s, {len(motion.skeleton)} joints")

# Metres and Z up whatever the file had; any time between frames can be asked for.
hands = motion.at(np.array([1.0, 1.005])).positions[:, onbeat.Body.of(motion.skeleton)["right_wrist"]]
print(f"the right hand at 1.0 s: {np.round(hands[0], 2)} m")

onbeat.write_motion(motion, folder / "folk_dance.glb")
onbeat.write_page(folder / "folk_dance.html", motion)
write_png(folder / "picture.png", onbeat.contact_sheet(motion, danced.keyposes[:6], columns=3, size=(280, 280)))
