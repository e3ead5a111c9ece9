"""The software renderer: things are where they should be, and look the same each time."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.motion import Motion, Skeleton
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.render.camera import Camera, follow
from onbeat.viewer.render.cones import cones_from, hit, outward
from onbeat.viewer.render.raster import render_frame
from onbeat.viewer.render.stage import Stage
from onbeat.viewer.shape import GROUPS, Capsule
from onbeat.viewer.sheet import contact_sheet, png_bytes

SIZE = (160, 90)
CAMERA = Camera((0.0, -5.0, 1.2), (0.0, 0.0, 1.0))
RED, BLUE = (230, 20, 20), (20, 20, 230)


def balls(*groups: str, radius: float = 0.2) -> Figure:
    """One ball on each joint."""
    palette = dict.fromkeys(GROUPS, RED) | {"torso": BLUE}
    return Figure.from_capsules([Capsule(i, i, radius, radius, group) for i, group in enumerate(groups)], palette)


def coloured(picture: np.ndarray, channel: int) -> np.ndarray:
    """Pixels in which a channel stands out."""
    rest = [c for c in range(3) if c != channel]
    return picture[..., channel].astype(int) - picture[..., rest].max(-1) > 40


def stick_dancer(frames: int = 20, fps: float = 20.0) -> Motion:
    """A person of few joints, who walks along x and turns."""
    spine = {"hips": 0.95, "chest": 1.3, "neck": 1.5, "head": 1.6}
    names, places = list(spine), [(0.0, 0.0, z) for z in spine.values()]
    parents = [-1, 0, 1, 2]
    for side, x in (("Left", -1.0), ("Right", 1.0)):
        for root, limb in ((1, [("Arm", 0.18, 1.42), ("ForeArm", 0.45, 1.42), ("Hand", 0.7, 1.42)]),
                           (0, [("UpLeg", 0.1, 0.9), ("Leg", 0.1, 0.5), ("Foot", 0.1, 0.08)])):  # fmt: skip
            above = root
            for name, across, z in limb:
                names.append(side + name)
                places.append((x * across, 0.0, z))
                parents.append(above)
                above = len(names) - 1
    at = np.array(places)
    skeleton = Skeleton(names, parents, at - np.where(np.array(parents)[:, None] < 0, at, at[parents]))
    rotations = np.tile([1.0, 0, 0, 0], (frames, len(names), 1))
    turn = np.linspace(0, 1, frames)
    rotations[:, 0] = np.column_stack((np.cos(turn / 2), 0 * turn, 0 * turn, np.sin(turn / 2)))
    root = np.column_stack((2 * turn, 0 * turn, 0 * turn + 0.95))
    return Motion(skeleton, rotations, root, fps)


def test_a_ball_is_drawn_where_the_camera_projects_it() -> None:
    place = np.array([[0.4, 0.3, 1.3]])
    seen = coloured(render_frame(place, balls("head"), CAMERA, SIZE), 0)
    rows, columns = np.nonzero(seen)
    centre = (columns.mean() + 0.5, rows.mean() + 0.5)
    assert centre == pytest.approx(CAMERA.project(place[0], SIZE), abs=0.6)
    across = CAMERA.focal(SIZE) * 0.2 / CAMERA.to_camera(place[0])[2]
    assert seen.sum() == pytest.approx(np.pi * across**2, rel=0.12)


def test_the_nearer_hides_the_farther() -> None:
    towards = np.array([0.0, -1.0, 0.04])
    places = np.add([0.0, 0.0, 1.0], [[0.0, 0.0, 0.0], towards])
    picture = render_frame(places, balls("torso", "head"), CAMERA, SIZE)
    column, row = CAMERA.project(places[1], SIZE).astype(int)
    assert coloured(picture, 0)[row, column]
    assert not coloured(picture, 2).any()
    assert coloured(render_frame(places[::-1], balls("torso", "head"), CAMERA, SIZE), 2)[row, column]


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_shadow_falls_on_the_far_side_from_the_light(side: float) -> None:
    light = (side, 0.0, 1.0)
    place = np.array([[0.0, 0.0, 0.7]])
    with_ball = render_frame(place, balls("head"), CAMERA, SIZE, Stage(light)).astype(int)
    without = render_frame(place + 50 * np.eye(3)[2:], balls("head"), CAMERA, SIZE, Stage(light)).astype(int)
    darker = (without - with_ball).min(-1) > 25
    darker &= ~coloured(with_ball.astype(np.uint8), 0)
    column, row = CAMERA.project(np.array([-side * 0.7, 0.0, 0.0]), SIZE).astype(int)
    assert darker[row, column]
    mirrored = SIZE[0] - 1 - column
    assert not darker[row, mirrored]


def test_rays_meet_a_tapered_capsule_on_its_skin() -> None:
    cones = cones_from(np.array([[[-0.3, 0.1, 3.0], [0.4, -0.2, 3.4]]]), np.array([[0.2, 0.08]]))
    slopes = np.random.default_rng(1).uniform(-0.2, 0.2, (400, 2))
    depths = np.array([hit(cones, 0, x, y) for x, y in slopes])
    met = np.isfinite(depths)
    assert 40 < met.sum() < 360
    for (x, y), t in zip(slopes[met], depths[met], strict=True):
        off, nx, ny, nz = outward(cones, 0, x * t, y * t, t)
        assert abs(off) < 1e-6
        assert nx * x + ny * y + nz < 1e-9  # the skin faces the camera


def test_a_ball_inside_the_other_end_is_one_ball() -> None:
    cones = cones_from(np.array([[[0, 0, 3.0], [0, 0.01, 3.0]]]), np.array([[0.1, 0.3]]))
    assert hit(cones, 0, 0.0, 0.0) == pytest.approx(2.7, abs=1e-3)


def test_the_same_pose_gives_the_same_bytes() -> None:
    motion = stick_dancer()
    figure = Figure.of(motion.skeleton)
    camera = follow(motion, figure)[3]
    first, again = (png_bytes(render_frame(motion.positions[3], figure, camera, SIZE)) for _ in range(2))
    assert first == again


def test_a_body_behind_the_camera_is_not_drawn() -> None:
    picture = render_frame(np.array([[0.0, -9.0, 1.0]]), balls("head"), CAMERA, SIZE)
    assert not coloured(picture, 0).any()


def test_the_following_camera_keeps_the_dancer_in_view() -> None:
    motion = stick_dancer(60)
    figure = Figure.of(motion.skeleton)
    ground = ground_height(figure, motion)
    path = follow(motion, figure, ground, size=SIZE)
    for frame in range(0, 60, 7):
        seen = path[frame].project(figure.ends(motion.positions[frame]), SIZE)
        assert (seen > 0).all()
        assert (seen < SIZE).all()
    steps = np.diff(path.targets[:, 0])
    assert steps.min() >= -1e-9
    assert np.abs(np.diff(steps)).max() < 0.1 * steps.max()


def test_the_ground_is_under_the_soles() -> None:
    motion = stick_dancer()
    figure = Figure.of(motion.skeleton)
    low, _ = figure.bounds(motion.positions)
    assert ground_height(figure, motion) == pytest.approx(low[:, 2].min(), abs=1e-6)


def test_a_skeleton_without_roles_is_drawn_as_bones() -> None:
    figure = Figure.of(Skeleton(("a", "b", "c"), [-1, 0, 1], [[0, 0, 0], [0, 0, 0.5], [0, 0, 0.5]]))
    assert figure.joints.tolist() == [[0, 1], [1, 2]]


def test_a_contact_sheet_has_a_picture_for_each_time() -> None:
    motion = stick_dancer()
    sheet = contact_sheet(motion, np.array([0.0, 0.4, 0.8]), columns=2, size=(60, 80))
    assert sheet.shape == (160, 120, 3)
    assert (sheet[82:158, 62:118] == 255).all()  # the fourth place is empty
    for top, left in ((0, 0), (0, 60), (80, 0)):
        part = sheet[top + 20 : top + 78, left : left + 58].astype(int)
        assert (np.ptp(part, axis=-1) > 60).sum() > 50  # someone in colour stands there


def test_a_body_of_which_nothing_can_be_seen_is_refused():
    flat = Skeleton(("hips", "head"), [-1, 0], np.zeros((2, 3)))
    still = Motion(flat, np.tile([1.0, 0, 0, 0], (3, 2, 1)), np.zeros((3, 3)), fps=30)
    with pytest.raises(BodyError, match="nothing of the body to draw"):
        ground_height(Figure.of(flat), still)
