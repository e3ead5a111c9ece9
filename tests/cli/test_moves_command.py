import json
import sys

import pytest

from onbeat.cli import main
from onbeat.examples.troupe import dance_library
from onbeat.formats import write_motion
from persons import AMC, ASF

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("clips")
    for name, performance in zip("ab", dance_library(fps=30.0), strict=False):
        write_motion(performance.motion[:150], folder / f"{name}.npz")
    (folder / "broken.bvh").write_text("nothing")
    return folder


def run(monkeypatch, *words):
    monkeypatch.setattr(sys, "argv", ["onbeat", "moves", *map(str, words)])
    try:
        main()
    except SystemExit as leaving:
        return int(leaving.code or 0)
    return 0


def test_a_library_is_built_and_shown(folder, tmp_path, monkeypatch, capsys):
    lib = tmp_path / "lib"
    assert run(monkeypatch, "build", folder, "-o", lib) == 0
    built = capsys.readouterr()
    assert "a~mirror" in built.out
    assert "4 clips, 10 s of recordings" in built.out
    assert "onbeat: left out broken.bvh: " in built.err
    assert f"next: onbeat dance SONG --moves {lib}" in built.err
    assert run(monkeypatch, "show", lib) == 0
    shown = capsys.readouterr()
    assert shown.out == built.out
    assert "left out broken.bvh" in shown.err


def test_json_has_everything(folder, tmp_path, monkeypatch, capsys):
    assert run(monkeypatch, "build", folder, "-o", tmp_path / "lib", "--no-mirror", "--json") == 0
    document = json.loads(capsys.readouterr().out)
    assert document["seconds"] == 10
    assert [clip["name"] for clip in document["clips"]] == ["a", "b"]
    assert sum(clip["joins"] for clip in document["clips"]) == document["joins"] > 0
    assert 0 < document["core"] <= 1
    assert 0 < document["joins_link_error"] < 40
    assert len(document["problems"]) == 1
    assert document["clips"][0]["performer"] is None


def test_a_library_is_checked_changed_and_merged(folder, tmp_path, monkeypatch, capsys):
    for name in "ab":
        assert run(monkeypatch, "build", folder / f"{name}.npz", "-o", tmp_path / name, "--no-mirror") == 0
    capsys.readouterr()
    assert run(monkeypatch, "merge", tmp_path / "a", tmp_path / "b", "-o", tmp_path / "ab") == 0
    assert capsys.readouterr().out.startswith("2 clips, 10 s of recordings")
    assert run(monkeypatch, "verify", tmp_path / "ab") == 0
    assert capsys.readouterr().out == f"{tmp_path / 'ab'}: all is as it was built\n"
    assert run(monkeypatch, "remove", tmp_path / "ab", "b") == 0
    assert capsys.readouterr().out.startswith("1 clip, 5 s of recordings")
    (shard,) = (tmp_path / "ab").glob("shards/clips-*")
    shard.write_bytes(b"?" + shard.read_bytes()[1:])
    assert run(monkeypatch, "verify", tmp_path / "ab") == 1
    assert "are not those it had" in capsys.readouterr().out


def test_problems_and_what_a_table_tells_are_shown(folder, tmp_path, monkeypatch, capsys):
    (tmp_path / "about.csv").write_text("file,performer\na.npz,anna\n")
    words = ("--about", tmp_path / "about.csv", "--search", "exact", "--no-mirror")
    assert run(monkeypatch, "build", folder, "-o", tmp_path / "lib", *words) == 0
    assert "anna" in capsys.readouterr().out
    assert run(monkeypatch, "show", tmp_path / "lib", "--problems") == 0
    assert capsys.readouterr().out.startswith("broken.bvh: ")


def test_an_assumed_rate_is_one_line(tmp_path, monkeypatch, capsys):
    (tmp_path / "t.asf").write_text(ASF)
    (tmp_path / "t.amc").write_text(AMC)
    assert run(monkeypatch, "build", tmp_path, "-o", tmp_path / "lib") == 1
    told = capsys.readouterr().err
    assert told.startswith("onbeat: the only file cannot be used; t.amc: no joint found for")
    assert told.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("build", "none", "-o", "lib"), "no file or folder none"),
        (("build", ".", "-o", "lib"), "no motion files in ."),
        (("build", ".", "-o", "lib", "--fps", "0"), "0 frames a second cannot be"),
        (("build", ".", "-o", "lib", "--workers", "0"), "0 workers cannot be"),
        (("build", ".", "-o", "lib", "--scheduler", "here"), "'here' is no address of a scheduler"),
        (("show", "."), "no library in ."),
        (("verify", "."), "no library in ."),
        (("remove", ".", "a"), "no library in ."),
        (("merge", ".", ".", "-o", "lib"), "no library in ."),
    ],
)
def test_mistakes_are_told_in_one_line(tmp_path, monkeypatch, capsys, words, told):
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, *words) == 1
    shown = capsys.readouterr()
    assert shown.err.startswith(f"onbeat: {told}")
    assert shown.err.count("\n") == 1
    assert shown.out == ""
    assert not (tmp_path / "lib").exists()
