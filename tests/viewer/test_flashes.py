"""Rings on the floor: when they begin, where they are, and that they fade."""

from __future__ import annotations

import numpy as np

from onbeat.viewer.figure import Figure
from onbeat.viewer.film.flashes import BEAT, DOWNBEAT, FADE, Flashes
from onbeat.viewer.render.camera import Camera
from onbeat.viewer.render.raster import render_frame
from onbeat.viewer.render.stage import Ring, Stage
from onbeat.viewer.shape import Capsule

FLASHES = Flashes.on(np.array([1.5, 1.0]), np.array([1.5004]))
PLACES = np.array([[0.0, 0.0], [2.0, 3.0]])


def test_a_flash_begins_in_the_picture_nearest_to_its_beat_and_goes() -> None:
    frame = 0.04
    seen = [
        bool(FLASHES.rings(time, PLACES, frame)) for time in (0.97, 0.981, 1.0, 1.0 + FADE - 0.01, 1.0 + FADE + 0.01)
    ]
    assert seen == [False, True, True, True, False]


def test_a_ring_widens_and_fades_and_is_larger_on_downbeats() -> None:
    (early,), (late,) = (FLASHES.rings(time, PLACES, 0.01) for time in (1.05, 1.3))
    assert late.radius > early.radius
    assert late.strength < early.strength
    (strong,) = FLASHES.rings(1.55, PLACES, 0.01)
    assert (strong.x, strong.y, strong.colour, early.colour) == (2.0, 3.0, DOWNBEAT, BEAT)
    assert strong.radius > early.radius
    assert strong.strength > early.strength


def test_a_ring_is_drawn_where_the_camera_projects_it() -> None:
    camera, size = Camera((0.0, -5.0, 1.6), (0.0, 0.0, 0.9)), (320, 180)
    away = Figure.from_capsules([Capsule(0, 0, 0.1, 0.1, "head")])
    ring = Ring(0.3, -0.2, 0.6, 0.04, 1.0, (255, 0, 0))
    with_ring, without = (
        render_frame(np.array([[0.0, -90.0, 0.0]]), away, camera, size, Stage(rings=rings)).astype(int)
        for rings in ((ring,), ())
    )
    changed = np.abs(with_ring - without).sum(-1) > 250
    angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    around = np.column_stack((0.3 + 0.6 * np.cos(angles), -0.2 + 0.6 * np.sin(angles), 0 * angles))
    column, row = camera.project(around, size).astype(int).T
    assert changed[row, column].all()
    rows, columns = np.nonzero(changed)
    for found, told in ((columns, column), (rows, row)):
        assert abs(found.min() - told.min()) < 6
        assert abs(found.max() - told.max()) < 6
