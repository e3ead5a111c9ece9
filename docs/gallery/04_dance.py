"""A song and a library in, a dance out: motion, page, document."""

import sys

import onbeat
from onbeat.examples import embedded_song
from onbeat.files import make_folder, write_atomically
from onbeat.moves.embedded import embedded_library
from onbeat.viewer.dance_page import write_dance_page
from onbeat.viewer.sheet import contact_sheet, write_png

folder = make_folder(sys.argv[1] if len(sys.argv) > 1 else "made")

song, samples, rate = embedded_song(seconds=10.0)
library = embedded_library()
print(f"{len(library.clips)} clips, {library.seconds:.0f} s of motion, {len(library.graph.costs)} joins")

dance = onbeat.make_dance(song, library)
for move in dance.document.moves:
    print(f"{move.at_s:6.2f} s  {move.clip}, from its second {move.from_s:.2f}")

onbeat.write_motion(dance.motion, folder / "dance.bvh")
write_atomically(folder / "dance.json", dance.document.to_json())
write_dance_page(folder / "dance.html", dance, library, (samples, rate))

# What it does on every second beat.
write_png(folder / "picture.png", contact_sheet(dance.motion, song.beats[1:13:2], columns=3, size=(280, 280)))
