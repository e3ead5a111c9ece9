"""The methods by their names."""

from __future__ import annotations

from collections.abc import Mapping

from onbeat.retime.clamp import clamp
from onbeat.retime.controlpoints import fit
from onbeat.retime.demand import Method
from onbeat.retime.layers2007 import lower
from onbeat.retime.layers_qp import weigh
from onbeat.retime.pollard2002 import follow
from onbeat.retime.uniform import slow_down

METHODS: Mapping[str, Method] = {
    "qp": fit,
    "layers-qp": weigh,
    "layers2007": lower,
    "pollard2002": follow,
    "clamp": clamp,
    "uniform": slow_down,
}
"""The first is the best, the last three are what others do."""
