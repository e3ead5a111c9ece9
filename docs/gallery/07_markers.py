"""Markers become a body that can dance: write a C3D file with gaps, fit a skeleton to it, see what is told."""

import sys

import numpy as np

import onbeat
from onbeat.capture.fit import fit_body
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.files import make_folder
from onbeat.motion.joint_markers import joint_markers
from onbeat.viewer.plots.files import new_figure, save_figure

folder = make_folder(sys.argv[1] if len(sys.argv) > 1 else "made")

# A dancer's joints as markers, one of which is hidden for half a second, as in a studio.
danced = perform(DANCERS[0], [FOLK_DANCE], speed=1.0, cycles=1, rng=np.random.default_rng(0))
markers = joint_markers(danced.motion)[:160]
seen = np.array(markers.positions)
seen[100:130, markers.index("LeftHand")] = np.nan
onbeat.write_markers(onbeat.Markers(markers.names, seen, markers.fps), folder / "take.c3d")

# A body of constant bones is fitted, as `onbeat.read_motion` does; it says how far off it is and what was filled.
fit = fit_body(onbeat.read_markers(folder / "take.c3d"))
body = fit.motion
print(*fit.report, sep="\n")
onbeat.write_motion(body, folder / "take.glb")

# The hand that was hidden: as it was danced, as the cameras saw it, and where the fitted body has it.
hand = markers.index("LeftHand")
fitted = body.positions[:, onbeat.Body.of(body.skeleton)["left_wrist"], 2]
figure = new_figure((7.0, 2.6))
axes = figure.subplots()
axes.plot(markers.times, markers.positions[:, hand, 2], color="0.8", linewidth=6, label="danced")
axes.plot(body.times, fitted, "tab:red", linestyle="--", label="fitted")
axes.plot(markers.times, seen[:, hand, 2], "tab:blue", label="seen")
axes.set(xlabel="time [s]", ylabel="height of the left hand [m]", xlim=(0, len(markers) / markers.fps))
figure.legend(loc="outside upper center", ncols=3, frameon=False)
save_figure(figure, folder / "picture.png")
