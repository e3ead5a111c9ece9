"""A library of one's own files, built once, opened again."""

import sys

import numpy as np

import onbeat
from onbeat.files import make_folder
from onbeat.moves.graph import GRID
from onbeat.viewer.plots.files import new_figure, save_figure

folder = make_folder(sys.argv[1] if len(sys.argv) > 1 else "made")

# A folder of motion capture; here, three clips of the troupe.
clips = make_folder(folder / "clips")
for number, motion in enumerate(onbeat.embedded_motions()[:3]):
    onbeat.write_motion(motion, clips / f"clip_{number}.bvh")

# Only what changed since the last time is read.
library = onbeat.build_library([clips], folder / "library")
for line in (*library.notes, *library.problems):
    print(line)

song, _, _ = onbeat.embedded_song(seconds=6.0)
dance = onbeat.make_dance(song, library)
print(f"{dance.motion.duration:.2f} s of dance with {len(dance.document.joins)} joins")
print(f"from {library.seconds:.0f} s of motion")

# The motion graph: from which second of the library the dance can go on at which other one.
graph = library.graph
figure = new_figure((4.6, 4.0))
axes = figure.subplots()
seconds = np.arange(len(graph) // GRID + 2)
joins, _, _ = np.histogram2d(graph.targets / GRID, graph.sources / GRID, [seconds, seconds])
shown = axes.pcolormesh(seconds, seconds, np.where(joins, joins, np.nan), cmap="viridis_r")
figure.colorbar(shown, label="joins")
axes.set(xlabel="left at this second of the library", ylabel="entered at this one", aspect="equal")
save_figure(figure, folder / "picture.png")
