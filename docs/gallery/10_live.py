"""It hears the music and dances: a session of sound that goes in tick by tick, and poses that come out.

There is no clock here, so that it is done faster than the song lasts: `onbeat live` lets the same go in real time.
"""

import sys
from pathlib import Path

import numpy as np

import onbeat
from onbeat.examples.song import demo_song
from onbeat.examples.troupe import dance_library
from onbeat.live.cast import Known, following
from onbeat.live.protocol import BeatSaid, Status
from onbeat.live.pulse import Pulse
from onbeat.live.session import Session
from onbeat.motion import Motion
from onbeat.viewer.figures import new_figure, save_figure

made = Path(sys.argv[1] if len(sys.argv) > 1 else "made")
made.mkdir(exist_ok=True)
song = demo_song(20.0, tempo=112)
sound = song.samples.mean(axis=1).astype(np.float32)
one = dance_library()[0]
cast = following([Known(one.motion, np.asarray(one.beats), np.asarray(one.keyposes))])
session = Session(Pulse(), cast.conductor, cast.dancer)

poses, said = [], []
for tick in range(len(sound) // 441):
    step = session.step(sound[tick * 441 : (tick + 1) * 441])
    poses += step.poses
    for event in step.events:
        if isinstance(event, BeatSaid):
            said.append(event.time)
        elif isinstance(event, Status) and tick % 400 == 399:
            print(f"{event.time:4.1f} s: {event.hearing}, {event.tempo:.0f} BPM, {event.dancing}")
late = np.abs(np.array(said)[:, None] - song.beats).min(axis=1)
print(f"{len(said)} beats heard as they happened, {1000 * np.median(late):.0f} ms off (median)")

rotations, roots = np.stack([pose.rotations for pose in poses]), np.stack([pose.root for pose in poses])
danced = Motion(cast.dancer.skeleton, rotations, roots, 100.0, "danced live")
onbeat.write_motion(danced, made / "live.bvh")

# How far off each beat was said: few people hear what is inside the grey band.
heard = np.array([second for second in said if second < song.beats[-1] + 0.1])
off = 1000 * (heard - song.beats[np.abs(song.beats[:, None] - heard).argmin(axis=0)])
figure = new_figure((7.0, 2.6))
axes = figure.subplots()
axes.axhspan(-50, 50, color="0.93")
axes.stem(heard, off, basefmt="k-")
axes.set(xlabel="time [s]", ylabel="said late by [ms]", xlim=(0, 20), ylim=(-110, 110))
save_figure(figure, made / "picture.png")
