"""Faster music: the same dance 1.3 times as fast, no joint faster than the dancer ever moved it."""

import sys
from pathlib import Path

import numpy as np

import onbeat
from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import perform
from onbeat.viewer.pages.retime import write_retime_page
from onbeat.viewer.plots.limits import write_limits_figure
from onbeat.viewer.plots.retime import write_retime_figure

made = Path(sys.argv[1] if len(sys.argv) > 1 else "made")
made.mkdir(exist_ok=True)
danced = perform(DANCERS[3], [FOLK_DANCE], speed=1.0, cycles=1, rng=np.random.default_rng(0))
known = {"limits": onbeat.learned_limits([danced.motion]), "beats": danced.beats, "keyposes": danced.keyposes}

results = [onbeat.retime_motion(danced.motion, 1.3, **known, method=method) for method in ("qp", "layers-qp", "clamp")]
print("method     channels over their limits   worst keypose   from the wish (rms)   peak acceleration")
for found in results:
    figures = found.measures
    keypose, rms = np.degrees([figures.worst_keypose, np.sqrt(np.square(figures.rms).mean())])
    over, peak = sum(figures.violations), figures.peak_acceleration.max()
    print(f"{found.method:10} {over:26} {keypose:14.2f}° {rms:20.2f}° {peak:13.0f} rad/s²")

print(f"{danced.motion.duration:.2f} s became {results[0].dance.duration:.2f} s; every beat is where the music has it")
onbeat.write_motion(results[0].dance, made / "faster.bvh")
write_retime_page(made / "retimed.html", results[0], danced.motion)
write_retime_figure(made / "picture.png", results)
write_limits_figure(made / "limits.png", results)
