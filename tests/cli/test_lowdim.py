"""``onbeat lowdim``: what it writes and says, and what it says of mistakes."""

import json

import cyclopts
import numpy as np
import pytest

from folk_dancers import dancers
from onbeat.cli.lowdim import lowdim_command
from onbeat.cli.lowdim_pulses import tell_unlike_pulses
from onbeat.errors import OnbeatError
from onbeat.formats import read_motion, write_motion
from onbeat.keyposes.lowdim_document import LowdimDocument

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Three dancers with marked keyposes, and the beats they dance to."""
    folder = tmp_path_factory.mktemp("dancers")
    for clip in dancers(3):
        write_motion(clip.motion, folder / f"{clip.person}.bvh")
        lines = "\n".join(f"{time:.6f}" for time in clip.keyposes)
        (folder / f"{clip.person}.keyposes.csv").write_text(lines)
    (folder / "dance.beats").write_text("\n".join(f"{beat:.6f}" for beat in dancers(3)[0].beats))
    return folder


@pytest.fixture
def run(capsys):
    """Runs the command in this process; gives stdout and stderr."""

    def call(*words):
        app = cyclopts.App(result_action="return_value")
        app.default(lowdim_command)
        app([str(word) for word in words], exit_on_error=False)
        return capsys.readouterr()

    return call


@pytest.fixture(scope="module")
def written(folder, tmp_path_factory):
    out = tmp_path_factory.mktemp("lowdim") / "out"
    app = cyclopts.App(result_action="return_value")
    app.default(lowdim_command)
    app(
        [*map(str, sorted(folder.glob("*.bvh"))), "--in-cycle", "8", "--dims", "2", "-o", str(out)], exit_on_error=False
    )
    return out


def test_motions_figures_page_and_document_are_written(written):
    names = {path.name for path in written.iterdir()}
    motions = {
        f"{name}_{space}_{dims}d.bvh" for name in ("Aiko", "Bruno", "Carla") for space in ("keyposes", "uniform")
        for dims in (1, 2)
    }  # fmt: skip
    figures = {f"{f}.{kind}" for f in ("variance", "clusters", "trajectory", "held_out") for kind in ("png", "svg")}
    assert motions | figures | {"lowdim.json", "judge.html", "dimensions.png"} <= names
    assert {"postures.png", "unnatural.png"} & names
    assert names - motions - figures <= {"lowdim.json", "judge.html", "dimensions.png", "postures.png", "unnatural.png"}


def test_the_motions_play(written, folder):
    original, made = read_motion(folder / "Bruno.bvh"), read_motion(written / "Bruno_keyposes_2d.bvh")
    assert made.skeleton == original.skeleton
    assert len(made) == len(original)
    assert np.allclose(made.root_positions, original.root_positions, atol=1e-5)
    assert 0.02 < np.linalg.norm(made.positions - original.positions, axis=-1).mean() < 0.2


def test_the_document_says_who_taught_what(written, run, folder):
    told = LowdimDocument.from_json((written / "lowdim.json").read_bytes())
    assert [person.name for person in told.people] == ["Aiko", "Bruno", "Carla"]
    assert all(len(person.keyposes) == 8 for person in told.people)
    assert told.dims == 2
    shown = run(*sorted(folder.glob("*.bvh")), "--in-cycle", "8", "--dims", "2", "--json")
    assert shown.out.encode() == (written / "lowdim.json").read_bytes()


def test_without_marks_keyposes_are_found_on_the_beats(folder, tmp_path, run):
    for name in ("Aiko", "Bruno"):
        (tmp_path / f"{name}.bvh").write_bytes((folder / f"{name}.bvh").read_bytes())
    given = [*sorted(tmp_path.glob("*.bvh")), "--in-cycle", 8]
    shown = run(*given, "--beats", folder / "dance.beats")
    assert "2 people, 16 poses, 3 of 15 dimensions" in shown.out
    assert "error, unseen people: keyposes" in shown.out
    assert "from the motion itself" in run(*given).err


def test_files_of_one_name_are_told_apart_by_their_folders(folder, tmp_path, run):
    other = tmp_path / "second"
    other.mkdir()
    for ending in (".bvh", ".keyposes.csv"):
        (other / f"Aiko{ending}").write_bytes((folder / f"Aiko{ending}").read_bytes())
    shown = run(folder / "Aiko.bvh", other / "Aiko.bvh", "--in-cycle", "8", "--json")
    assert [person["name"] for person in json.loads(shown.out)["people"]][1] == "second_Aiko"


def test_files_of_one_name_in_folders_of_one_name_are_numbered(folder, tmp_path, run):
    for name in ("a", "b"):
        (tmp_path / name / "x").mkdir(parents=True)
        for ending in (".bvh", ".keyposes.csv"):
            (tmp_path / name / "x" / f"1{ending}").write_bytes((folder / f"Aiko{ending}").read_bytes())
    shown = run(*sorted(tmp_path.glob("*/x/1.bvh")), "--in-cycle", "8", "--dims", "2", "--json")
    assert [person["name"] for person in json.loads(shown.out)["people"]] == ["x_1", "x_1 (2)"]


def test_where_the_others_span_fewer_dimensions_that_is_said(folder, tmp_path, run):
    for name in ("Aiko", "Bruno"):
        (tmp_path / f"{name}.bvh").write_bytes((folder / f"{name}.bvh").read_bytes())
        marks = (folder / f"{name}.keyposes.csv").read_text().split()
        (tmp_path / f"{name}.keyposes.csv").write_text("\n".join(marks[:4]))
    shown = run(*sorted(tmp_path.glob("*.bvh")))
    rows = {line.split("  ")[0]: line.split()[-2:] for line in shown.out.splitlines()}
    assert "2 people, 4 poses, 3 of 3 dimensions" in rows
    assert rows["error, unseen people: all frames"] == ["–", "–"]
    assert "mm" in rows["error, unseen frames: all frames"]
    assert "span but 1 dimension" in shown.out
    assert "as points: bone through bone" in shown.out


def test_of_one_cycle_the_table_tells_what_was_tested(folder, tmp_path, run):
    (tmp_path / "Aiko.bvh").write_bytes((folder / "Aiko.bvh").read_bytes())
    marks = (folder / "Aiko.keyposes.csv").read_text().split()
    (tmp_path / "Aiko.keyposes.csv").write_text("\n".join(marks[:8]))
    shown = run(tmp_path / "Aiko.bvh", "--in-cycle", "8").out
    assert shown.startswith("1 person, 8 poses")
    assert "error, between taught poses: all frames" in shown
    assert "unseen" not in shown


def test_answers_are_judged(tmp_path, run):
    one, two = saved(tmp_path / "one.json", 1.0), saved(tmp_path / "two.json", 2.0)
    shown = run("--judged", one, two)
    assert shown.out.startswith(
        "18 of 18 chose keyposes (100%; 95 % confidence interval of the true share: 81% to 100%"
    )
    assert "p = 7.6e-06" in shown.out
    told = json.loads(run("--judged", one, two, "--json").out)
    assert (told["chosen"], told["trials"]) == (18, 18)
    assert told["low"] == pytest.approx(0.8147, abs=1e-4)


def saved(path, seconds, dims=3):
    rows = [{"motion": "Aiko", "a": "uniform", "b": "keyposes", "chosen": "b", "seconds": seconds}] * 9
    path.write_text(json.dumps({"version": 1, "dims": dims, "answers": rows}))
    return path


def test_answers_that_do_not_belong_together_are_refused(tmp_path, run):
    one, copy, flat = (saved(tmp_path / f"{n}.json", 1.0, dims) for n, dims in enumerate((3, 3, 2)))
    with pytest.raises(OnbeatError, match=r"1\.json holds the same answers as .*0\.json"):
        run("--judged", one, copy)
    with pytest.raises(OnbeatError, match="of 2 and of 3 dimensions"):
        run("--judged", one, flat)
    with pytest.raises(OnbeatError, match="leave out -o"):
        run("--judged", one, "-o", tmp_path / "out")


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ((), "no motions"),
        (("none.bvh",), "no file none.bvh"),
        (("--judged", "none.json"), "cannot read none.json"),
        (("Aiko.bvh", "--judged", "none.json"), "leave out Aiko.bvh"),
        (("Aiko.bvh", "--in-cycle", "99"), "of which a cycle has 99"),
        (("Aiko.bvh", "--dims", "40"), "40 dimensions of a space that has"),
        (("Aiko.bvh", "--rho", "2"), "a share of 2"),
        (("Aiko.bvh", "Bruno.bvh", "./Aiko.bvh"), "Aiko.bvh is given twice"),
        (("none.bvh", "--seed", "-1"), "--seed -1"),
        (("none.bvh", "--repeats", "0"), "--repeats 0"),
        (("none.bvh", "--repeats", "11"), "give 1 to 10"),
        (("Aiko.bvh", "--in-cycle", "8", "-o", "dance.beats/out"), "cannot make the folder"),
    ],
)
def test_mistakes_are_told(folder, monkeypatch, run, words, told):
    monkeypatch.chdir(folder)
    with pytest.raises(OnbeatError, match=told):
        run(*words)


def test_a_motion_that_stands_still_has_no_keyposes(tmp_path, run):
    clip = dancers(1)[0].motion
    still = clip.replace(rotations=np.repeat(clip.rotations[:1], len(clip), axis=0),
                         root_positions=np.repeat(clip.root_positions[:1], len(clip), axis=0))  # fmt: skip
    write_motion(still, tmp_path / "still.bvh")
    (tmp_path / "still.beats").write_text("\n".join(str(beat / 2) for beat in range(30)))
    with pytest.raises(OnbeatError, match="still"):
        run(tmp_path / "still.bvh", "--beats", tmp_path / "still.beats")


def test_pulses_that_are_no_one_dances_are_told(capsys):
    tell_unlike_pulses(["a.bvh", "b.bvh", "c.bvh"], [100.0, 110.0, None])
    assert capsys.readouterr().err == ""
    tell_unlike_pulses(["a.bvh", "b.bvh", "c.bvh"], [240.0, 97.0, None])
    assert "are not one dance's (a.bvh 240, b.bvh 97 a minute)" in capsys.readouterr().err
