"""The flag that says at which rate the frames of a motion file are, where it stores none: one name in all commands."""

from __future__ import annotations

from typing import Annotated

import cyclopts

SourceRate = Annotated[float | None, cyclopts.Parameter(name=["--source-fps", "--fps"])]
"""Of commands that only read motion: ``--source-fps``, as those have it that write some, too; ``--fps`` is the same."""
