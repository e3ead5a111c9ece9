"""``pupil.html``: a pupil's body playing, coloured by how far it is from a master's, and the master beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import msgspec

from onbeat.recognition.ghost import Beside
from onbeat.viewer.contract import ComparedData, MetricData, pack_heat
from onbeat.viewer.pages.content import body_data, distance_curve, page_data, thinning
from onbeat.viewer.pages.page import write_filled
from onbeat.viewer.plots.heat import UNKNOWN, hex_scale, scale_end

MASTER = "#9aa3b2"
"""The colour of the master's body: no colour of the scale."""


def write_pupil_page(
    path: Path, found: Beside, *, master: str = "", title: str = "", told: Sequence[tuple[str, str]] = ()
) -> None:
    """Write the page: one file that opens without a server or a network.

    Parameters
    ----------
    path : the file.
    found : the pupil's motion beside the master's.
    master : the master's name.
    title : of the page.
    told : what is listed in it: names of parts, and what is said of each.
    """
    page = page_data(found.pupil, None, {"title": title or found.pupil.name})
    every = thinning(found.pupil)
    number = {name: joint for joint, name in enumerate(found.pupil.skeleton.names)}
    centimetres = 100.0 * found.joint_errors()[::every][:, [number[name] for name in page.joints]]
    heat = pack_heat(centimetres, scale_end(100.0 * found.errors), hex_scale(), "#" + bytes(UNKNOWN).hex())
    compared = ComparedData(master, heat, body_data(found.master, every, MASTER))
    metrics = [MetricData(name, value) for name, value in told]
    joins = found.starts[1:].round(4).tolist()
    curve = distance_curve(found.errors, found.pupil)
    shown = msgspec.structs.replace(page, compared=compared, metrics=metrics, joins=joins, motion_intensity=curve)
    write_filled(path, shown)
