"""A song and a library in, a dance out: motion, page, document."""

import sys

import onbeat
from onbeat.files import make_folder, write_atomically
from onbeat.viewer.sheet import write_png

folder = make_folder(sys.argv[1] if len(sys.argv) > 1 else "made")

song, samples, rate = onbeat.embedded_song(seconds=8.0)
library = onbeat.embedded_library()
print(f"{len(library.clips)} clips, {library.seconds:.0f} s of motion, {len(library.graph.costs)} joins")

dance = onbeat.make_dance(song, library)
for move in dance.document.moves:
    print(f"{move.at_s:6.2f} s  {move.clip}, from its second {move.from_s:.2f}")

onbeat.write_motion(dance.motion, folder / "dance.bvh")
write_atomically(folder / "dance.json", dance.document.to_json())
onbeat.write_dance_page(folder / "dance.html", dance, library, (samples, rate))

# What it does on the beats.
write_png(folder / "picture.png", onbeat.contact_sheet(dance.motion, song.beats[1:9], columns=4, size=(240, 240)))
