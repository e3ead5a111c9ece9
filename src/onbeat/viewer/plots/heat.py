"""The colours of distances: from pale to dark and from cool to hot in even steps, so that no legend is needed to rank.

Steps are even in OKLCH (Ottosson 2020), whose lightness is as people see it. It falls from end to end, so that the
scale is ordered in grey and to those who see few colours, and neither end is lost on white or on black.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array

_STOPS = np.array(
    [  # lightness, chroma, hue [degrees]
        (0.86, 0.035, 195),
        (0.80, 0.09, 95),
        (0.68, 0.15, 62),
        (0.54, 0.18, 27),
        (0.38, 0.15, 350),
    ]
)
_STEPS = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 80.0, 100.0, 200.0, 400.0)
LEAST = 5.0
"""Centimetres at the end of the scale at least: less than that is not what a teacher looks for."""
UNKNOWN = (176, 182, 192)
"""sRGB of what is compared with nothing."""


def colours(levels: Array) -> np.ndarray:
    """(..., 3) sRGB uint8 of levels 0…1; ``UNKNOWN`` for NaN.

    Examples
    --------
    >>> grey = colours(np.linspace(0, 1, 9)) @ [0.2126, 0.7152, 0.0722]
    >>> bool((np.diff(grey) < 0).all())
    True
    """
    levels = np.asarray(levels, np.float64)
    at = np.clip(np.nan_to_num(levels), 0.0, 1.0) * (len(_STOPS) - 1)
    angle = np.radians(_STOPS[:, 2])
    lab = np.column_stack((_STOPS[:, 0], _STOPS[:, 1] * np.cos(angle), _STOPS[:, 1] * np.sin(angle)))
    mixed = np.stack([np.interp(at, np.arange(len(lab)), axis) for axis in lab.T], axis=-1)
    found = _srgb(mixed)
    found[np.isnan(levels)] = UNKNOWN
    return found


def hex_scale(steps: int = 17) -> list[str]:
    """The scale as ``#rrggbb``, from 0 to 1 in even steps."""
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in colours(np.linspace(0.0, 1.0, steps)).tolist()]


def scale_end(centimetres: Array) -> float:
    """Centimetres at which the scale ends: a round number that hardly any distance is beyond.

    Examples
    --------
    >>> scale_end(np.array([1.0, 2.0, 13.0])), scale_end(np.zeros(3))
    (15.0, 5.0)
    """
    known = centimetres[np.isfinite(centimetres)]
    most = float(np.percentile(known, 98)) if len(known) else 0.0
    return next((step for step in _STEPS if step >= max(most, LEAST)), _STEPS[-1])


def _srgb(lab: Array) -> np.ndarray:
    """(..., 3) uint8 of OKLab."""
    to_lms = np.array(
        [[1, 0.3963377774, 0.2158037573], [1, -0.1055613458, -0.0638541728], [1, -0.0894841775, -1.291485548]]
    )
    to_rgb = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.707614701],
        ]
    )
    linear = np.clip((lab @ to_lms.T) ** 3 @ to_rgb.T, 0.0, 1.0)
    curved = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.rint(255 * curved).astype(np.uint8)
