"""What a motion has for the music: stops, intensity, foot contacts."""

import sys

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.files import make_folder
from onbeat.motion.contacts import foot_contacts
from onbeat.motion.features import hand_features, intensity_component
from onbeat.viewer.plots.files import new_figure, save_figure

folder = make_folder(sys.argv[1] if len(sys.argv) > 1 else "made")
danced = perform(DANCERS[3], [FOLK_DANCE], speed=1.0, cycles=2, rng=np.random.default_rng(0))
motion = danced.motion

# A dancer's hands come to rest in the keyposes, and the keyposes are on beats.
features = hand_features(motion)
late = np.abs(features.body_stops[:, None] - danced.beats).min(axis=1)
print(f"{len(features.body_stops)} stops; half of them within {1000 * np.median(late):.0f} ms of a beat")

# The same at another rate: times are seconds, so nothing depends on frames.
slower = hand_features(motion.resampled(30.0))
print(f"at 30 frames a second: {len(slower.body_stops)} stops")

times = np.arange(0.0, motion.duration, 0.1)
strength = intensity_component(features, times)
print(f"hands move at up to {strength.max():.1f} m/s, at their strongest {times[strength.argmax()]:.1f} s in")

standing = foot_contacts(motion).feet
print(f"the left foot stands {standing[:, 0].mean():.0%} of the time, the right one {standing[:, 1].mean():.0%}")

# The hands' speed, the stops found in it (dots), and the beats danced to.
figure = new_figure((7.0, 2.6))
axes = figure.subplots()
axes.vlines(danced.beats, 0, 1, transform=axes.get_xaxis_transform(), color="0.85", label="beats")
for side, colour, speed in zip(("left", "right"), ("tab:blue", "tab:red"), features.speeds.T, strict=True):
    axes.plot(features.times, speed, color=colour, label=f"{side} hand")
axes.plot(features.body_stops, 0 * features.body_stops, "ko", clip_on=False, label="stops")
axes.set(xlabel="time [s]", ylabel="speed [m/s]", xlim=(0, motion.duration), ylim=(0, None))
figure.legend(loc="outside upper center", ncols=4, frameon=False)
save_figure(figure, folder / "picture.png")
