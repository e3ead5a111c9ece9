"""The search against a random walk, beside chance."""

import sys

import onbeat
from onbeat.dance.sublibrary import sublibrary
from onbeat.files import make_folder
from onbeat.viewer.plots.files import new_figure, save_figure

folder = make_folder(sys.argv[1] if len(sys.argv) > 1 else "made")
song, _, _ = onbeat.embedded_song(seconds=8.0)
library = sublibrary(onbeat.embedded_library(), song, seconds=100.0)  # a part that suits the song is enough here

figure = new_figure((6.0, 2.6))
axes = figure.subplots()
print("method          F50 before  after the warp  chance   z")
for row, method in enumerate(("optimal", "shiratori2006", "walk")):
    metrics = onbeat.make_dance(song, library, method=method, fps=30.0).document.metrics
    before, after = metrics["beats_before_warp"], metrics["beats"]
    chance = after["f50_jitter_null"]
    print(f"{method:14} {before['f50']:11.2f} {after['f50']:15.2f} {chance:7.2f} {after['f50_jitter_z']:5.1f}")
    axes.barh(row - 0.2, before["f50"], 0.38, color="#9db8d6", label="_" * row + "before the time warp")
    axes.barh(row + 0.2, after["f50"], 0.38, color="#48689a", label="_" * row + "after it")
    axes.vlines(chance, row - 0.42, row + 0.42, color="tab:red", label="_" * row + "chance")

axes.set(yticks=range(3), yticklabels=["optimal", "shiratori2006", "walk"], xlim=(0, 1), xlabel="F within 50 ms")
axes.invert_yaxis()
figure.legend(loc="outside upper center", ncols=3, frameon=False)
save_figure(figure, folder / "picture.png")
