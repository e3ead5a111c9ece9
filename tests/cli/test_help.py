"""Every command explains itself, and the examples it gives are taken by its own options."""

import shlex
import subprocess
import sys

import cyclopts
import pytest
from rich.console import Console

from onbeat.cli.commands import COMMANDS, app


def help_of(capsys: pytest.CaptureFixture[str], *command: str) -> str:
    app([*command, "--help"], console=Console(width=200), result_action="return_value")
    return capsys.readouterr().out


def test_the_list_names_every_command(capsys: pytest.CaptureFixture[str]):
    shown = help_of(capsys)
    assert all(name in shown and sentence in shown for name, (_, sentence, _) in COMMANDS.items())


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_says_what_it_does_and_gives_an_example(name: str, capsys: pytest.CaptureFixture[str]):
    shown = help_of(capsys, name)
    assert COMMANDS[name][1] in shown
    assert f"Example: {COMMANDS[name][2]}" in shown


@pytest.mark.parametrize("name", ["moves", "songs", "reproduce"])
def test_a_list_of_commands_says_what_each_does(name: str, capsys: pytest.CaptureFixture[str]):
    listed = help_of(capsys, name).partition("Commands")[2].partition("╰")[0]
    lines = [line.strip("│ ").split(maxsplit=1) for line in listed.splitlines() if line.startswith("│")]
    assert lines
    assert all(len(line) == 2 for line in lines), f"no word about some of {[line[0] for line in lines]}"


def test_commands_of_commands_give_examples_too(capsys: pytest.CaptureFixture[str]):
    pairs = [(name, part) for name in COMMANDS for part in app[name] if not part.startswith("-")]
    assert {name for name, _ in pairs} >= {"moves", "songs", "keyposes", "recognise", "reproduce"}
    assert [pair for pair in pairs if "Example: onbeat" not in help_of(capsys, *pair)] == []


READERS = (
    "dance", "keyposes", "keyposes learn", "keyposes evaluate", "lowdim", "recognise", "recognise train", "observe",
    "retime", "evaluate", "convert", "info", "robot", "live", "moves build", "reproduce", "reproduce study",
)  # fmt: skip


@pytest.mark.parametrize("command", READERS)
def test_the_rate_of_a_file_is_said_alike_in_all_commands(command: str, capsys: pytest.CaptureFixture[str]):
    assert "--source-fps" in help_of(capsys, *command.split())


@pytest.mark.parametrize("name", COMMANDS)
def test_an_example_is_taken(name: str):
    program, *words = shlex.split(COMMANDS[name][2])
    assert (program, words[0]) == ("onbeat", name)
    _, _, unused, _ = app.parse_known_args(words)
    assert not unused


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_explained(name: str):
    command = app[name]
    if command.default_command is None:
        return
    for argument in command.assemble_argument_collection(parse_docstring=True):
        assert argument.parameter.help, f"onbeat {name} {argument.name} is not explained"


def test_an_unknown_command_is_refused():
    with pytest.raises(cyclopts.CycloptsError, match="knit"):
        app(["knit"], exit_on_error=False, print_error=False)


def test_the_list_is_quick():
    code = "import sys; from onbeat.cli.commands import app; app(['--help'], result_action='return_value')"
    code += "; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"numba", "matplotlib", "scipy.signal"} & set(loaded)
