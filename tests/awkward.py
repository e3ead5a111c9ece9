"""Awkward BVH files of many kinds, made from a small body whose joint positions are computed here by matrices alone."""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass, field, replace

import numpy as np

Row = tuple[str, str, tuple[float, float, float], str]
"""Name, parent, OFFSET and channels ("Xp Yp Zp Zr Xr Yr"); an End Site has the name "" and no channels."""

BODY: tuple[Row, ...] = (
    ("Hips", "", (0, 0, 0), "Xp Yp Zp Zr Xr Yr"),
    ("Chest", "Hips", (0, 30, 2), "Zr Xr Yr"),
    ("Head", "Chest", (0, 28, 0), "Zr Xr Yr"),
    ("", "Head", (0, 18, 3), ""),
    ("LeftArm", "Chest", (17, 20, 0), "Zr Xr Yr"),
    ("", "LeftArm", (45, 0, 0), ""),
    ("LeftLeg", "Hips", (9, -5, 0), "Zr Xr Yr"),
    ("LeftFoot", "LeftLeg", (0, -80, 0), "Zr Xr Yr"),
    ("", "LeftFoot", (0, -4, 14), ""),
)


@dataclass(frozen=True)
class Spec:
    """A body and its frames, from which text and truth are made."""

    rows: tuple[Row, ...] = BODY
    frame_time: str = "0.0333333"
    fps: float = 30.0
    frames: int = 3
    large: float = 40.0
    digits: int = 4

    @property
    def values(self) -> np.ndarray:
        """(frames, channels) as printed."""
        kinds = [channel[1] for _, _, _, channels in self.rows for channel in channels.split()]
        rng = np.random.default_rng(7)
        table = rng.uniform(-self.large, self.large, (self.frames, len(kinds)))
        return np.round(np.where([kind == "p" for kind in kinds], 50 + table / 4, table), self.digits)

    @functools.cached_property
    def truth(self) -> dict[str, np.ndarray]:
        """(frames, 3) of each joint in the file's unit and axes, by 4×4 matrices."""
        values, at, world, found = self.values, 0, {}, {}
        for number, (name, parent, offset, channels) in enumerate(self.rows):
            place, turn = np.tile(np.array(offset, float), (self.frames, 1)), np.tile(np.eye(3), (self.frames, 1, 1))
            for channel in channels.split():
                axis, column = "XYZ".index(channel[0]), values[:, at]
                if channel[1] == "p":
                    place[:, axis] = column
                else:
                    turn = turn @ turns(axis, np.radians(column))
                at += 1
            above, from_ = world.get(parent, (np.eye(3)[None], np.zeros((1, 3))))
            here = (above @ turn, from_ + np.einsum("fij,fj->fi", np.broadcast_to(above, turn.shape), place))
            world[name], found[name or f"end {number}"] = here, here[1]
        return found

    @property
    def text(self) -> str:
        """The file, plainly written."""
        lines, stack = ["HIERARCHY"], [""]
        for name, parent, offset, channels in self.rows:
            while stack[-1] != parent:
                stack.pop()
                lines.append("  " * (len(stack) - 1) + "}")
            indent = "  " * (len(stack) - 1)
            title = f"{'JOINT' if parent else 'ROOT'} {name}" if name else "End Site"
            lines += [indent + title, indent + "{", indent + "  OFFSET " + " ".join(f"{v:.1f}" for v in offset)]
            if name:
                words = [f"{c[0]}{'position' if c[1] == 'p' else 'rotation'}" for c in channels.split()]
                lines.append(indent + "  " + " ".join(["CHANNELS", str(len(words)), *words]))
                stack.append(name)
            else:
                lines.append(indent + "}")
        lines += ["  " * (depth - 1) + "}" for depth in range(len(stack) - 1, 0, -1)]
        rows = [" ".join(f"{v:.{self.digits}f}" for v in row) for row in self.values]
        return "\n".join([*lines, "MOTION", f"Frames: {self.frames}", f"Frame Time: {self.frame_time}", *rows]) + "\n"

    def channels(self, **named: str) -> Spec:
        """Other channels for some joints."""
        rows = tuple((name, parent, offset, named.get(name, old)) for name, parent, offset, old in self.rows)
        return replace(self, rows=rows)

    def renamed(self, **names: str) -> Spec:
        """Other names for some joints."""
        rows = tuple((names.get(n, n), names.get(p, p), offset, channels) for n, p, offset, channels in self.rows)
        return replace(self, rows=rows)


def turns(axis: int, angle: np.ndarray) -> np.ndarray:
    """(F, 3, 3) turns about a coordinate axis."""
    c, s, out = np.cos(angle), np.sin(angle), np.tile(np.eye(3), (len(angle), 1, 1))
    j, k = (axis + 1) % 3, (axis + 2) % 3
    out[:, j, j], out[:, j, k], out[:, k, j], out[:, k, k] = c, -s, s, c
    return out


@dataclass(frozen=True)
class Case:
    """A file, and either the body it holds or, where it has to be refused, what a refusal must say."""

    name: str
    data: bytes
    spec: Spec | None
    says: str = ""
    names: tuple[str, ...] = field(default=())
    """What its joints are called once read, where that is not as written."""


PLAIN = Spec()
T = PLAIN.text
FLAT = Spec().channels(Chest="Xp Yp Zp Zr Xr Yr", LeftArm="Xp Yp Zp Yr Xr Zr")
TWINS = PLAIN.renamed(LeftFoot="LeftArm_2")


def _deep(count: int) -> Spec:
    rows = [(f"j{n}", f"j{n - 1}" if n else "", (0.0, 1.0, 0.0), "Xr") for n in range(count)]
    return Spec(tuple(rows), large=5.0)


def _values(change) -> str:
    head, rows = T.split("0.0333333\n")
    return head + "0.0333333\n" + change(rows)


def _right() -> list[Case]:
    def text(name: str, data: str | bytes, spec: Spec = PLAIN, names: tuple[str, ...] = ()) -> Case:
        return Case(name, data if isinstance(data, bytes) else data.encode(), spec, names=names)

    orders = PLAIN.channels(Chest="Xr Yr Zr", Head="Yr Zr Xr", LeftArm="Zr Yr Xr", LeftLeg="Yr Xr Zr")
    one = PLAIN.channels(LeftLeg="Xr", LeftFoot="Xr", Head="Yr")
    turned = PLAIN.channels(Hips="Zr Xr Yr Xp Yp Zp")
    still = PLAIN.channels(Hips="Zr Xr Yr")
    two = PLAIN.channels(Chest="Xr Yr", LeftArm="")
    spaced = PLAIN.renamed(Chest="Upper Body", LeftArm="Left Arm", LeftFoot="Left Foot 1")
    colons = PLAIN.renamed(Hips="mixamorig:Hips", Chest="mixamorig:Spine", LeftArm="rig:sub:Arm.L-1")
    umlauts = PLAIN.renamed(LeftFoot="FußLinks", Head="頭", Chest="Grudní")
    latin = PLAIN.renamed(LeftFoot="FußLinks", Chest="Tête")
    bare = Spec(tuple(row for row in BODY if row[0]))
    flat_end = Spec(tuple((n, p, (0, 0, 0) if not n else o, c) for n, p, o, c in BODY))
    whole = replace(PLAIN, digits=0)
    number = r"(?<= )(-?)0\.(\d)"
    return [
        text("plain", T),
        text("channel orders differ by joint", orders.text, orders),
        text("joints of one channel", one.text, one),
        text("joints of two and no channels", two.text, two),
        text("joints of six channels", FLAT.text, FLAT),
        text("rotations before positions", turned.text, turned),
        text("a root that stays", still.text, still),
        text("leaves without End Sites", bare.text, bare),
        text("End Sites without length", flat_end.text, flat_end),
        text("frames over several lines", _values(lambda rows: rows.replace(" ", "\n", 40))),
        text("all frames in one line", _values(lambda rows: rows.replace("\n", " ") + "\n")),
        text("several spaces", _values(lambda rows: rows.replace(" ", "    "))),
        text("tabs", re.sub(r"(?<!End) ", "\t", T)),
        text("spaces at the ends of lines", T.replace("\n", "  \n")),
        text("CRLF", T.replace("\n", "\r\n")),
        text("CR alone", T.replace("\n", "\r")),
        text("lower case", re.sub(r"[A-Z]\w*(?:position|rotation)|[A-Z]{4,}|End Site|Frames|Frame Time",
                                  lambda m: m[0].lower(), T)),
        text("upper case", re.sub(r"[A-Z]\w*(?:position|rotation)|End Site|Frames|Frame Time",
                                  lambda m: m[0].upper(), T)),
        text("names with spaces", spaced.text, spaced),
        text("names with colons, dots, dashes", colons.text, colons),
        text("names in UTF-8", umlauts.text, umlauts),
        text("names in Latin-1", latin.text.encode("latin-1"), latin),
        text("byte order mark", "\ufeff" + T),
        text("UTF-16", T.encode("utf-16")),
        text("no final newline", T.rstrip("\n")),
        text("blank lines everywhere", T.replace("\n", "\n\n") + "\n \n"),
        text("Ctrl-Z at the end", T + "\x1a"),
        text("scientific notation", re.sub(r"(-?\d+\.\d{4})(?!\d)", lambda m: f"{float(m[0]):.9E}", T)),
        text("whole numbers", whole.text, whole),
        text("bare decimal points", re.sub(number, r"\1.\2", T)),
        text("plus signs", _values(lambda rows: re.sub(r"(?<![\d.-])(\d)", r"+\1", rows))),
        text("a brace beside the name", re.sub(r"\n\s*\{", " {", T)),
        text("the hierarchy in one line", " ".join(T.split("MOTION")[0].replace("End Site", "End Site\n").split("\n"))
             + "\nMOTION" + T.split("MOTION")[1]),
        text("no space after colons", T.replace("Frames: ", "Frames:").replace("Time: ", "Time:")),
        text("channels before the offset", re.sub(r"( +OFFSET.*\n)( +CHANNELS.*\n)", r"\2\1", T)),
        text("film rate", replace(PLAIN, frame_time="0.0416667", fps=24).text, replace(PLAIN, fps=24)),
        text("a rate of 120 in six digits", replace(PLAIN, frame_time="0.008333", fps=120).text,
             replace(PLAIN, fps=120)),
        text("29.97 frames a second", replace(PLAIN, frame_time="0.03336667", fps=29.97).text,
             replace(PLAIN, fps=29.97)),
        text("angles past a whole turn", replace(PLAIN, large=900.0).text, replace(PLAIN, large=900.0)),
        text("one frame", replace(PLAIN, frames=1).text, replace(PLAIN, frames=1)),
        text("two joints of one name", TWINS.text.replace("LeftArm_2", "LeftArm"), TWINS),
        text("800 joints deep", _deep(800).text, _deep(800)),
    ]  # fmt: skip


def _refused() -> list[Case]:
    def bad(name: str, data: str, says: str) -> Case:
        return Case(name, data.encode(), None, says)

    frames = len(T.split("MOTION")[0].splitlines()) + 1
    return [
        bad("fewer frames than promised", T.replace("Frames: 3", "Frames: 4"), "3 frames found"),
        bad("more frames than promised", T.replace("Frames: 3", "Frames: 2"), "3 frames found"),
        bad("cut inside a frame", T[: T.rindex(" ")], "2.95238 frames found"),
        bad("cut inside the hierarchy", T[:200], "no MOTION"),
        bad("NaN", _values(lambda rows: rows.replace(rows.split()[30], "nan")), "frame 1 has a value that is not a"),
        bad("decimal commas", _values(lambda rows: rows.replace(".", ",")), f":{frames + 3}: a number is expected"),
        bad("a word among the numbers", _values(lambda rows: rows.replace(" ", " x", 1)), f":{frames + 3}: a number"),
        bad("10⁹ frames promised", T.replace("Frames: 3", "Frames: 1000000000"), "1000000000 frames of 21 channels"),
        bad("a brace too few", T.replace("}\nMOTION", "MOTION"), "are not closed"),
        bad("an unknown channel", T.replace("Yrotation", "Wrotation", 1), ":5: 6 channels such as Xrotation"),
        bad("no offset", re.sub(r" +OFFSET 9.*\n", "", T), "joint 'LeftLeg' has no OFFSET"),
        bad("two roots", T.replace("JOINT LeftLeg", "ROOT LeftLeg"), "ROOT is out of place"),
        bad("a frame time of zero", T.replace("0.0333333", "0.0"), f":{frames}: a frame time in seconds"),
        bad("empty", "", "no MOTION"),
    ]


CASES = [*_right(), *_refused()]
