"""The command line: one short file per command."""

from __future__ import annotations

import sys

import cyclopts

import onbeat

app = cyclopts.App(name="onbeat", version=onbeat.__version__, help=onbeat.__doc__)
# Named by path, so that a command is imported when it is called.
app.command("onbeat.cli.listen:listen_command", name="listen", help="Hear the beats and chords of a song.")
app.command("onbeat.cli.evaluate:evaluate_command", name="evaluate")
app.command("onbeat.cli.convert:convert_command", name="convert")
app.command("onbeat.cli.moves:moves_app", name="moves", help="Build and show motion libraries.")


def main() -> None:
    """Run the command line; a user's error becomes one line on stderr and exit status 1."""
    try:
        app()
    except onbeat.OnbeatError as error:
        print(f"onbeat: {error}", file=sys.stderr)  # noqa: T201
        sys.exit(1)
    except KeyboardInterrupt:
        print("onbeat: stopped", file=sys.stderr)  # noqa: T201
        sys.exit(130)
