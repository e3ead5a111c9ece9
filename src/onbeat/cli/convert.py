"""``onbeat convert``: motion files in another format, cut, joined, turned, scaled on the way."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import cyclopts

from onbeat.cli.progress import warnings_as_lines
from onbeat.errors import FormatError
from onbeat.formats import read_file, read_motion, write_markers, write_motion
from onbeat.formats.conventions import Convention, Up
from onbeat.formats.read import fitted
from onbeat.formats.registry import Format, writing
from onbeat.formats.tracking import JointOrder, write_tracking
from onbeat.motion import Markers, Motion
from onbeat.motion.edit import concatenated, cropped, scaled, stature
from onbeat.motion.floor import on_floor
from onbeat.motion.mirror import mirrored
from onbeat.motion.retarget import retarget
from onbeat.motion.role_file import Roles, read_roles

Unit = Literal["m", "cm", "mm", "in", "cmu", "dm", "ft"]
Flag = cyclopts.Parameter(negative="")
Axis = cyclopts.Parameter(allow_leading_hyphen=True)


@dataclass
class Options:
    """What is done on the way.

    Parameters
    ----------
    fps
        Frames a second of the new file.
    source_fps
        The rate of the source, where it stores none (AMC, robot CSV) or a wrong one.
    source_up
        The axis of the source that points up, where the guess is wrong; -y where Y points down.
    source_unit
        The unit of the source, where the guess is wrong; cmu is the length of CMU's files, ft are feet.
    up
        Up axis of the new file, where its format leaves it free.
    unit
        Unit of the new file, where its format leaves it free.
    start
        Leave out what comes before this second.
    end
        Leave out what comes from this second on.
    blend
        Seconds in which one source fades into the next; without it they follow each other.
    like
        Move it over to the skeleton of this motion file.
    mirror
        Left becomes right.
    height
        Scale the body, and its path, to this height in metres.
    scale
        Scale the body, and its path, by this factor.
    ground
        Put the feet on a floor at height 0, where they stand higher or lower.
    roles
        A roles file (TOML) that says which joint or marker is what; by default the one beside a source.
    joint_order
        Order of the joints in a .tracking.npz: mujoco (mjlab) or isaac (Isaac Lab).
    """

    fps: float | None = None
    source_fps: float | None = None
    source_up: Annotated[Up | None, Axis] = None
    source_unit: Unit | None = None
    up: Annotated[Up | None, Axis] = None
    unit: Unit | None = None
    start: float = 0.0
    end: float | None = None
    blend: float = 0.0
    like: Path | None = None
    mirror: Annotated[bool, Flag] = False
    height: float | None = None
    scale: float | None = None
    ground: Annotated[bool, Flag] = False
    roles: Path | None = None
    joint_order: JointOrder = "mujoco"


DEFAULT = Options()


def convert_command(
    *files: Annotated[Path, cyclopts.Parameter(name=["SOURCE... TARGET"])],
    options: Annotated[Options, cyclopts.Parameter(name="*")] = DEFAULT,
) -> None:
    """Convert motion files: any that is read in, any that is written out; cut, joined, mirrored, scaled on the way.

    Parameters
    ----------
    files
        One or more files to read, put together one after the other, and last the file to write.
    options
        What is done on the way.
    """
    if len(files) < 2:
        given = f"only {files[0]} is given" if files else "no file is given"
        raise FormatError(f"{given}; a file to read and one to write are expected: `onbeat convert OLD.bvh NEW.glb`")
    *sources, target = files
    into = writing(target)
    _check(options, into)
    told = None if options.roles is None else read_roles(options.roles)
    with warnings_as_lines():
        found = _joined([_read(source, into, options, told) for source in sources], options)
        if isinstance(found, Motion):
            found = _changed(found, options)
        _write(found, target, into, options)
    if hint := _misread(into, options):
        print(f"onbeat: {hint}", file=sys.stderr)  # noqa: T201
    what = f"{len(found.names)} markers" if isinstance(found, Markers) else _body(found)
    print(f"{target}: {_length(found)}, {what}", file=sys.stderr)  # noqa: T201


def _write(found: Motion | Markers, target: Path, into: Format, options: Options) -> None:
    if isinstance(found, Markers):
        write_markers(found, target, up=options.up, unit=options.unit)
    elif into.suffix == ".tracking.npz":
        asked = Convention(options.up or "z", options.unit or "m")
        write_tracking(found, target, asked, options.joint_order)
    else:
        write_motion(found, target, up=options.up, unit=options.unit)


def _misread(into: Format, options: Options) -> str:
    """What a reader of a format that stores neither axis nor unit has to be told; empty where it is guessed right."""
    if into.suffix != ".bvh" or (options.up != "x" and options.unit != "in"):
        return ""
    needed = " ".join(
        [*(["--source-up x"] if options.up == "x" else []), *(["--source-unit in"] if options.unit == "in" else [])]
    )
    return f"BVH files store neither axis nor unit, and no reader guesses these: onbeat reads it with {needed}"


def _check(options: Options, into: Format) -> None:
    if options.joint_order != DEFAULT.joint_order and into.suffix != ".tracking.npz":
        raise FormatError(f"--joint-order is of .tracking.npz files; {into.suffix} has no other order")
    if options.scale is not None and not 1e-3 <= options.scale <= 1e3:
        raise FormatError(f"a scale of {options.scale:g} cannot be; give one from 0.001 to 1000")
    for rate in (options.fps, options.source_fps):
        if rate is not None and not 0.1 <= rate <= 10000:
            raise FormatError(f"{rate} frames a second cannot be; give a rate from 0.1 to 10000")
    if options.height is not None and options.scale is not None:
        raise FormatError("--height and --scale are both given; give one of them")
    if options.height is not None and not 0.01 <= options.height <= 1000:
        raise FormatError(f"a body of {options.height:g} m cannot be; give a height from 0.01 to 1000")
    if not 0 <= options.blend <= 10:
        raise FormatError(f"a blend of {options.blend:g} s cannot be; give one from 0 to 10")
    if options.unit is not None:
        Convention("z", options.unit)


def _read(source: Path, into: Format, options: Options, told: Roles | None) -> Motion | Markers:
    """A source, on the body of ``--like``; markers stay so where the target holds them and no body is needed."""
    found = read_file(source, options.source_fps, options.source_up, options.source_unit, told)
    bodily = options.like or options.mirror or options.height or options.scale or options.ground
    if isinstance(found, Markers):
        if into.write_markers and not bodily:
            return found
        found = fitted(found, source, told).motion
    if options.like is None:
        return found
    other = read_motion(options.like)
    return retarget(found, other.skeleton, other)


def _joined(found: list[Motion | Markers], options: Options) -> Motion | Markers:
    if len(found) == 1:
        if isinstance(one := found[0], Motion):
            return cropped(one, options.start, options.end)
        one = cropped(one, options.start, options.end)
        return one.resampled(options.fps) if options.fps else one
    bodies = [each for each in found if isinstance(each, Motion)]
    if len(bodies) < len(found):
        raise FormatError("files of markers are converted one by one; give one source, or write a body's motion")
    return cropped(concatenated(bodies, options.blend), options.start, options.end)


def _changed(motion: Motion, options: Options) -> Motion:
    motion = mirrored(motion) if options.mirror else motion
    tall = stature(motion) if options.height is not None else 1.0
    if not tall > 0:
        raise FormatError("the body is 0 m tall, which no --height can change: its bones have no length")
    factor = options.scale if options.height is None else options.height / tall
    motion = motion if factor is None else scaled(motion, factor)
    motion = on_floor(motion) if options.ground else motion
    return motion if options.fps is None else motion.resampled(options.fps)


def _length(found: Motion | Markers) -> str:
    return f"{len(found)} frames, {found.duration:.2f} s at {found.fps:g} frames a second"


def _body(motion: Motion) -> str:
    return f"{len(motion.skeleton)} joints, {stature(motion):.2f} m tall"
