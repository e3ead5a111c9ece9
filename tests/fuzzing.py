"""How much the readers are fuzzed: a few hundred inputs each, or as many as ``ONBEAT_FUZZ`` says."""

import os

from hypothesis import HealthCheck, settings

INPUTS = int(os.environ.get("ONBEAT_FUZZ", "200"))
patient = settings(max_examples=INPUTS, deadline=10_000, suppress_health_check=list(HealthCheck))
"""An input that takes ten seconds hangs, even on a busy machine."""
