"""The troupe's sixteen other figures, from calm to energetic."""

from __future__ import annotations

import numpy as np

from onbeat.examples.figures import STANCE, Figure, Pose, Step

SWAY = Figure(
    name="sway",
    beats=4,
    hands={0: "belly | hip side", 2: "hip side | belly"},
    steps=(Step(2, "L", -STANCE, kind="shift"), Step(4, "R", STANCE, kind="shift")),
    trunk={
        0: Pose(lean=0.09, hip=0.10, twist=-0.12, tip=0.06, look=-0.1),
        2: Pose(lean=-0.09, hip=-0.10, twist=0.12, tip=-0.06, look=0.1),
    },
    bounce=0.008,
)
OFFERING = Figure(
    name="offering",
    beats=8,
    hands={0: "belly | belly", 2: "open | chest", 4: "belly | open", 6: "high front | high front"},
    through={7: "side up | side up"},
    steps=(
        Step(2, "L", -STANCE, 0.20),
        Step(4, "R", STANCE, 0.20, "close"),
        Step(6, "R", STANCE, 0.0),
        Step(8, "L", -STANCE, 0.0, "close"),
    ),
    trunk={
        0: Pose(bow=0.06, nod=0.1),
        2: Pose(bow=0.10, twist=0.22, look=0.3, nod=0.08),
        4: Pose(bow=0.12, nod=0.05),
        6: Pose(bow=-0.09, nod=-0.2),
    },
    bounce=0.010,
)
BOW = Figure(
    name="bow",
    beats=8,
    hands={0: "loose | loose", 2: "side low | side low", 4: "hip side | belly", 6: "open | open"},
    steps=(Step(2, "R", STANCE, -0.16), Step(8, "R", STANCE, 0.0, "close")),
    trunk={
        0: Pose(),
        2: Pose(bow=-0.05, nod=-0.1),
        4: Pose(bow=0.75, nod=0.22, sink=0.04),
        6: Pose(bow=0.25, nod=0.05),
    },
    bounce=0.006,
)
HIP_CIRCLES = Figure(
    name="hip circles",
    beats=4,
    hands={0: "side up | high", 2: "high | side up"},
    trunk={0: Pose(sink=0.04, lean=-0.04, tip=0.06), 2: Pose(sink=0.04, lean=0.04, tip=-0.06)},
    bounce=0.006,
    circle=0.085,
)
TURN = Figure(
    name="turn",
    beats=8,
    hands={0: "low side | low side", 2: "side up | side up", 4: "belly | belly", 6: "up | up"},
    steps=tuple(
        Step(
            2 * pair + (1 if foot == "L" else 2),
            foot,
            1.15 * side * STANCE * float(np.cos(angle)),
            1.15 * side * STANCE * float(np.sin(angle)),
            kind="close" if pair == 3 and foot == "R" else "step",
            turn=float(np.degrees(angle)),
        )
        for pair in range(4)
        for foot, side in (("L", -1.0), ("R", 1.0))
        for angle in [np.pi / 4 * (pair + 1)]
    ),
    trunk={
        0: Pose(),
        2: Pose(twist=0.12, look=0.3, bow=-0.03),
        4: Pose(bow=0.08, twist=0.1, look=0.2, nod=0.08),
        6: Pose(bow=-0.06, nod=-0.12, look=0.15),
    },
    travel=(0.0, 0.0, 180.0),
    bounce=0.016,
)
ARM_WAVES = Figure(
    name="arm waves",
    beats=4,
    hands={0: "low side | high", 1: "side | side", 2: "high | low side", 3: "side | side"},
    steps=(
        Step(1, "L", -0.16, 0.0),
        Step(2, "R", 0.16, 0.0, "tap"),
        Step(3, "R", 0.16, 0.0),
        Step(4, "L", -0.16, 0.0, "tap"),
    ),
    trunk={0: Pose(lean=-0.10, tip=-0.06), 1: Pose(), 2: Pose(lean=0.10, tip=0.06), 3: Pose()},
    bounce=0.022,
)
STEP_TOUCH = Figure(
    name="step touch",
    beats=4,
    hands={0: "hip side | hip side", 1: "across | side low", 2: "hip side | hip side", 3: "side low | across"},
    steps=(
        Step(1, "R", 0.44),
        Step(2, "L", 0.20, kind="tap"),
        Step(3, "L", -STANCE),
        Step(4, "R", 0.11, kind="tap"),
    ),
    trunk={
        0: Pose(hip=0.05),
        1: Pose(lean=0.05, twist=-0.18, look=-0.2),
        2: Pose(hip=-0.05, sink=0.01),
        3: Pose(lean=-0.05, twist=0.18, look=0.2),
    },
    bounce=0.036,
)
HEEL_TOE = Figure(
    name="heel toe",
    beats=8,
    hands={
        0: "waist | waist",
        1: "waist | side up",
        2: "waist | chest",
        3: "waist | side up",
        4: "waist | waist",
        5: "side up | waist",
        6: "chest | waist",
        7: "side up | waist",
    },
    steps=(
        Step(1, "R", 0.20, 0.34, "heel"),
        Step(2, "R", 0.05, 0.16, "tap"),
        Step(3, "R", 0.20, 0.34, "heel"),
        Step(4, "R", STANCE, 0.0),
        Step(5, "L", -0.20, 0.34, "heel"),
        Step(6, "L", -0.05, 0.16, "tap"),
        Step(7, "L", -0.20, 0.34, "heel"),
        Step(8, "L", -STANCE, 0.0),
    ),
    trunk={
        0: Pose(),
        1: Pose(bow=-0.05, lean=0.06, look=-0.25),
        2: Pose(bow=0.04, twist=0.12),
        3: Pose(bow=-0.05, lean=0.06, look=-0.25),
        4: Pose(),
        5: Pose(bow=-0.05, lean=-0.06, look=0.25),
        6: Pose(bow=0.04, twist=-0.12),
        7: Pose(bow=-0.05, lean=-0.06, look=0.25),
    },
    bounce=0.032,
)
WALK = Figure(
    name="walk in place",
    beats=2,
    hands={0: "low | back", 1: "back | low"},
    steps=(Step(1, "R", STANCE, z=0.10), Step(2, "L", -STANCE, z=0.10)),
    trunk={0: Pose(twist=-0.14, turn=0.05, lean=-0.02), 1: Pose(twist=0.14, turn=-0.05, lean=0.02)},
    bounce=0.028,
)
GRAPEVINE = Figure(
    name="grapevine",
    beats=8,
    hands={
        0: "clap | clap",
        1: "side low | side low",
        2: "across | belly",
        3: "side low | side low",
        4: "clap | clap",
        5: "side low | side low",
        6: "belly | across",
        7: "side low | side low",
    },
    steps=(
        Step(1, "R", 0.46),
        Step(2, "L", 0.62, -0.33, around=-0.20),
        Step(3, "R", 0.98, around=0.08),
        Step(4, "L", 0.74, kind="tap"),
        Step(5, "L", 0.42),
        Step(6, "R", 0.24, -0.33, around=-0.20),
        Step(7, "L", -STANCE, around=0.08),
        Step(8, "R", STANCE, kind="tap"),
    ),
    trunk={
        0: Pose(),
        1: Pose(lean=0.05, look=-0.25),
        2: Pose(bow=0.08, twist=-0.12, turn=0.18, look=-0.25),
        3: Pose(lean=0.05, look=-0.25),
        4: Pose(bow=-0.03),
        5: Pose(lean=-0.05, look=0.25),
        6: Pose(bow=0.08, twist=0.12, turn=-0.18, look=0.25),
        7: Pose(lean=-0.05, look=0.25),
    },
    bounce=0.034,
)
CLAPS = Figure(
    name="claps",
    beats=4,
    hands={0: "open | open", 1: "clap | clap", 2: "side up | side up", 3: "clap high | clap high"},
    steps=(
        Step(1, "R", 0.20),
        Step(2, "L", -0.06, 0.0, "tap"),
        Step(3, "L", -STANCE),
        Step(4, "R", STANCE, 0.0, "tap"),
    ),
    trunk={0: Pose(), 1: Pose(bow=0.08, twist=-0.1), 2: Pose(bow=-0.05), 3: Pose(bow=-0.02, nod=-0.14)},
    bounce=0.042,
)
PUNCH = Figure(
    name="punch",
    beats=4,
    hands={0: "guard | guard", 1: "belly | punch", 2: "guard | guard", 3: "punch | belly"},
    steps=(
        Step(1, "R", 0.22, 0.10),
        Step(2, "L", -0.20, 0.0, "tap"),
        Step(3, "L", -0.20, 0.10),
        Step(4, "R", 0.16, 0.0, "tap"),
    ),
    trunk={
        0: Pose(bow=0.10, sink=0.03),
        1: Pose(bow=0.06, twist=0.42, lean=-0.04, sink=0.01),
        2: Pose(bow=0.12, twist=-0.2, sink=0.03),
        3: Pose(bow=0.06, twist=-0.42, lean=0.04, sink=0.01),
    },
    bounce=0.045,
)
BOUNCE = Figure(
    name="bounce",
    beats=4,
    hands={0: "low | low", 1: "guard | guard", 2: "low | low", 3: "side up | side up"},
    trunk={0: Pose(bow=0.14, sink=0.02), 1: Pose(bow=0.0), 2: Pose(bow=0.14, sink=0.02), 3: Pose(bow=-0.06, nod=-0.08)},
    bounce=0.085,
)
KICK = Figure(
    name="kick",
    beats=4,
    hands={0: "front | back", 1: "guard | guard", 2: "back | front", 3: "guard | guard"},
    steps=(
        Step(1, "R", STANCE),
        Step(2, "L", -0.08, 0.74, "air", z=0.24),
        Step(3, "L", -STANCE),
        Step(4, "R", 0.08, 0.74, "air", z=0.24),
    ),
    trunk={
        0: Pose(bow=-0.08, twist=-0.2, ahead=-0.07, look=0.1),
        1: Pose(bow=0.06, sink=0.015),
        2: Pose(bow=-0.08, twist=0.2, ahead=-0.07, look=-0.1),
        3: Pose(bow=0.06, sink=0.015),
    },
    bounce=0.034,
)
ARM_CIRCLES = Figure(
    name="arm circles",
    beats=4,
    hands={0: "belly | belly", 1: "side | side", 2: "up | up", 3: "high front | high front"},
    steps=(
        Step(1, "R", 0.30),
        Step(2, "L", 0.08, kind="tap"),
        Step(3, "L", -STANCE),
        Step(4, "R", STANCE, kind="tap"),
    ),
    trunk={0: Pose(bow=0.08, nod=0.06), 1: Pose(), 2: Pose(bow=-0.09, nod=-0.15), 3: Pose(bow=0.0)},
    bounce=0.030,
)
STAR = Figure(
    name="star",
    beats=4,
    hands={0: "clap low | clap low", 1: "high | high", 2: "clap low | clap low", 3: "high | side"},
    steps=(
        Step(1, "R", 0.46),
        Step(2, "L", 0.18, kind="tap"),
        Step(3, "L", -0.16),
        Step(4, "R", STANCE, kind="tap"),
    ),
    trunk={
        0: Pose(bow=0.20, sink=0.05, nod=0.1),
        1: Pose(bow=-0.08, nod=-0.15),
        2: Pose(bow=0.20, sink=0.05, nod=0.1),
        3: Pose(lean=-0.14, twist=0.15, nod=-0.1, look=-0.3),
    },
    bounce=0.045,
)
REPERTOIRE = (
    SWAY, OFFERING, BOW, HIP_CIRCLES, TURN, ARM_WAVES, STEP_TOUCH, HEEL_TOE, WALK, GRAPEVINE, CLAPS, PUNCH, BOUNCE,
    KICK, ARM_CIRCLES, STAR,
)  # fmt: skip
"""All but the folk dance, roughly by the speed of the hands."""
