"""The command line: one short file per command."""

from __future__ import annotations

import contextlib
import io
import os
import sys
from typing import NoReturn

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
        "Build and show motion libraries: clips and the joins between them.",
        "onbeat moves build my_clips -o my_library",
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
}
"""Of each command: where it is, what it does in a sentence, and an example."""

for order, (name, (path, sentence, example)) in enumerate(COMMANDS.items()):
    app.command(path, name=name, help=f"{sentence}\n\nExample: ``{example}``", sort_key=order)


def main() -> None:
    """Run the command line; a user's error becomes one line on stderr and exit status 1, of usage 2."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # names of files may hold what a terminal cannot show
            stream.reconfigure(errors="backslashreplace")
    try:
        app()
        sys.stdout.flush()
    except onbeat.OnbeatError as error:
        _stop(str(error), 1)
    except MemoryError:
        _stop("not enough memory; choose a shorter stretch of the song or fewer clips", 1)
    except KeyboardInterrupt:
        _stop("stopped", 130)
    except SystemError as error:
        if not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        _stop("stopped", 130)  # Ctrl-C while a compiled loop ran
    except OSError as error:  # of files, onbeat's own errors tell; this is the screen, or the pipe, that is printed to
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what is left to print would only fail again
        if isinstance(error, BrokenPipeError):  # who reads our output has seen enough
            sys.exit(1)
        _stop(f"{error.filename or 'standard output'}: {error.strerror or error}", 1)


def _stop(message: str, status: int) -> NoReturn:
    print(f"onbeat: {' '.join(message.split())}", file=sys.stderr)  # noqa: T201
    sys.exit(status)
