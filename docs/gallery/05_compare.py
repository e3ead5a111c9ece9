"""The search against a random walk, beside chance."""

import onbeat
from onbeat.examples import embedded_song
from onbeat.moves.embedded import embedded_library

song, _, _ = embedded_song(seconds=15.0)
library = embedded_library()

print("method          F50 before  after the warp   z")
for method in ("optimal", "shiratori2006", "walk"):
    metrics = onbeat.make_dance(song, library, method=method, fps=30.0).document.metrics
    before, after = metrics["beats_before_warp"], metrics["beats"]
    print(f"{method:14} {before['f50']:11.2f} {after['f50']:15.2f} {after['f50_jitter_z']:5.1f}")
