"""What there is of a sound card, and how late it is."""

from __future__ import annotations

import json as json_module

from rich.console import Console
from rich.text import Text

from onbeat.errors import OnbeatError


def tell_card(calibrate: bool, json: bool) -> None:
    """List the inputs, or play clicks and hear them."""
    if not calibrate:
        from onbeat.live.sound.sound_card import inputs

        names = inputs()
        if not names:
            raise OnbeatError("the sound card has no input; plug in a microphone, or give a song to --input")
        print(json_module.dumps(names) if json else "\n".join(names))  # noqa: T201
        return
    from onbeat.live.sound.calibrate import calibrate as measured

    with Console(stderr=True).status(Text("clicks are played and heard")):
        found = measured()
    told = {"latency_ms": round(1000 * found.seconds, 1), "spread_ms": round(1000 * found.spread, 1)}
    told["heard"] = found.heard
    if json:
        print(json_module.dumps(told))  # noqa: T201
        return
    print(  # noqa: T201
        f"sound comes back {told['latency_ms']:g} ms after it is played (± {told['spread_ms']:g} ms, "
        f"{found.heard} clicks heard): out and in together. What is heard is a part of that old: "
        "begin with --latency at half of it, and turn it until the dance looks right"
    )
