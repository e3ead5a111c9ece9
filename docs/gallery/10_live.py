"""It hears the music and dances: sound goes in tick by tick, poses come out.

There is no clock here, so that it is done faster than the song lasts: `onbeat live` lets the same go in real time.
"""

import sys
from pathlib import Path

import numpy as np

import onbeat
from onbeat.examples.song import demo_song
from onbeat.viewer.plots.files import new_figure, save_figure

made = Path(sys.argv[1] if len(sys.argv) > 1 else "made")
made.mkdir(exist_ok=True)
song = demo_song(14.0, tempo=112)

# A choreography that follows the music; with a library instead of a motion it makes its dance up.
live = onbeat.dance_live(song.samples, song.rate, onbeat.embedded_motions()[0])
for status in live.said[79::80]:
    print(f"{status.time:4.1f} s: {status.hearing}, {status.tempo:.0f} BPM, {status.dancing}")
late = np.abs(live.beats[:, None] - song.beats).min(axis=1)
print(f"{len(live.beats)} beats heard as they happened, {1000 * np.median(late):.0f} ms off (median)")
onbeat.write_motion(live.motion, made / "live.bvh")

# How far off each beat was said: few people hear what is inside the grey band.
heard = live.beats[live.beats < song.beats[-1] + 0.1]
off = 1000 * (heard - song.beats[np.abs(song.beats[:, None] - heard).argmin(axis=0)])
figure = new_figure((7.0, 2.6))
axes = figure.subplots()
axes.axhspan(-50, 50, color="0.93")
axes.stem(heard, off, basefmt="k-")
axes.set(xlabel="time [s]", ylabel="said late by [ms]", xlim=(0, 14), ylim=(-110, 110))
save_figure(figure, made / "picture.png")
