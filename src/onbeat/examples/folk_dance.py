"""The folk dance: eight keyposes in a cycle of twelve beats, danced in a circle of one's own."""

from __future__ import annotations

from onbeat.examples.figures import STANCE, Figure, Pose, Step

FOLK_DANCE = Figure(
    name="folk dance",
    beats=12,
    hands={
        0: "clap | clap",
        1: "low side | low side",
        2: "clap | clap",
        4: "across | high",
        5: "chest | side",
        6: "high | across",
        8: "high front | high front",
        10: "low | low",
    },
    through={3: "low | low side", 7: "side | low side", 9: "side up | side up", 11: "open | open"},
    steps=(
        Step(1, "R", STANCE, 0.26),
        Step(2, "L", -STANCE, 0.26, "close"),
        Step(4, "R", 0.40, 0.26),
        Step(5, "L", 0.17, 0.26, "tap"),
        Step(6, "L", -0.14, 0.26),
        Step(7, "R", STANCE, 0.28, "tap"),
        Step(8, "R", STANCE, -0.02),
        Step(10, "L", -STANCE, 0.0, "close"),
        Step(11, "R", STANCE, 0.0, "close"),
    ),
    trunk={
        0: Pose(bow=0.05, nod=0.05),
        1: Pose(bow=0.16, nod=0.12),
        2: Pose(bow=0.04),
        4: Pose(lean=0.10, twist=-0.28, turn=-0.15, look=-0.45, tip=0.08),
        5: Pose(lean=0.02, twist=-0.38, turn=-0.12, look=-0.5, sink=0.02),
        6: Pose(lean=-0.10, twist=0.28, turn=0.15, look=0.45, tip=-0.08),
        8: Pose(bow=-0.10, nod=-0.22),
        10: Pose(bow=0.30, sink=0.05, nod=0.16),
    },
    bounce=0.032,
)
