"""From labelled markers to a moving body: gaps, joint centres, a fitted skeleton."""

from onbeat.capture.fit import Fit, fit_body
from onbeat.capture.frames import marker_body_frames
from onbeat.capture.labels import find_sites
from onbeat.capture.sites import SITES

__all__ = ["SITES", "Fit", "find_sites", "fit_body", "marker_body_frames"]
