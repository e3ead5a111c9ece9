"""The commands there are: where each is, what it does, and an example."""

from __future__ import annotations

import cyclopts

import onbeat

app = cyclopts.App(name="onbeat", version=onbeat.__version__, help=onbeat.__doc__, suppress_keyboard_interrupt=False)
# Named by path, so that a command is imported when it is called; its help stands here, so that a list needs none.
COMMANDS = {
    "dance": (
        "onbeat.cli.dance:dance_command",
        "Dance to a song: motion capture and a song in, a dance on the music out.",
        "onbeat dance song.mp3 --moves my_clips -o my_dance --seconds 60",
    ),
    "listen": (
        "onbeat.cli.listen:listen_command",
        "Hear the beats, downbeats, chord changes and intensity of a song.",
        "onbeat listen song.mp3 -o song.json --click song_clicks.wav --plot song.png",
    ),
    "moves": (
        "onbeat.cli.moves:moves_app",
        "Build, show, check and change motion libraries: clips and the joins between them.",
        "onbeat moves build my_clips -o my_library",
    ),
    "songs": (
        "onbeat.cli.songs:songs_app",
        "List songs with free licences, and fetch them.",
        "onbeat songs fetch vibe-ace",
    ),
    "keyposes": (
        "onbeat.cli.keyposes:keyposes_app",
        "Find the keyposes of a dance: the poses in which it rests on the beat; learn how, measure how well.",
        "onbeat keyposes dance.bvh --music song.mp3 -o dance_keyposes",
    ),
    "lowdim": (
        "onbeat.cli.lowdim:lowdim_command",
        "Rebuild dances in a few dimensions, by keyposes and by uniform sampling, and test which looks right.",
        "onbeat lowdim aiko.bvh bruno.bvh carla.bvh --in-cycle 8 --music song.mp3 -o lowdim",
    ),
    "recognise": (
        "onbeat.cli.recognise:recognise_app",
        "Say which step is danced and by whom, or that it is new; hold a pupil against a master; move styles.",
        "onbeat recognise model.npz unknown.bvh",
    ),
    "observe": (
        "onbeat.cli.observe:observe_command",
        "Observe takes of a dance at several speeds: which details go in faster music, which poses stay.",
        "onbeat observe slow_1.bvh slow_2.bvh fast_1.bvh fast_2.bvh -o observed",
    ),
    "retime": (
        "onbeat.cli.retime:retime_command",
        "Play a dance faster or slower, or to other music, inside the body's limits; keyposes stay what they are.",
        "onbeat retime dance.csv --robot g1 --speed 1.2 -o faster",
    ),
    "evaluate": (
        "onbeat.cli.evaluate:evaluate_command",
        "Measure how well a motion dances to a song: on the beat, with its intensity, on its feet, smoothly.",
        "onbeat evaluate dance.bvh --music song.wav",
    ),
    "convert": (
        "onbeat.cli.convert:convert_command",
        "Convert motion files: any that is read in, any that is written out; cut, joined, mirrored, scaled on the way.",
        "onbeat convert 05_01.amc dance.glb --source-fps 120 --ground",
    ),
    "info": (
        "onbeat.cli.info:info_command",
        "Say what is in a motion file: body, rate, unit, roles, contacts, and what is wrong with it.",
        "onbeat info dance.bvh",
    ),
    "robot": (
        "onbeat.cli.robot:robot_command",
        "Put a dance on a humanoid robot: retargeted, on the music, inside limits, balanced; simulated and exported.",
        "onbeat robot dance.bvh --robot g1 --speed 1.2 --simulate -o out",
    ),
    "live": (
        "onbeat.cli.live:live_command",
        "Hear music as it happens and dance on it: poses a hundred times a second, for a page, OSC, MIDI, a robot.",
        "onbeat live --input mic --osc 127.0.0.1:9000",
    ),
    "robots": (
        "onbeat.cli.robots:robots_command",
        "List the robots that are known by name, or what the joints of one can do: how far, how fast.",
        "onbeat robots g1",
    ),
    "studio": (
        "onbeat.cli.studio:studio_command",
        "Open the studio, a local web app: drop a song and motion files in, look, correct, dance, compare, export.",
        "onbeat studio my_project",
    ),
    "reproduce": (
        "onbeat.cli.reproduce:reproduce_app",
        "Do the papers' experiments again: every table and figure of theirs beside ours.",
        "onbeat reproduce P1 -o reproduced",
    ),
}
"""Of each command: where it is, what it does in a sentence, and an example."""

for order, (name, (path, sentence, example)) in enumerate(COMMANDS.items()):
    app.command(path, name=name, help=f"{sentence}\n\nExample: ``{example}``", sort_key=order)
