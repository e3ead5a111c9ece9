"""A roles file for markers, to edit: which label is at which place on the body."""

from __future__ import annotations

import json
from collections.abc import Sequence

from onbeat.capture.labels import NEEDED, find_sites
from onbeat.capture.sites import SITES


def marker_template(labels: Sequence[str]) -> str:
    """The text of a roles file: places that are known by their labels, those that are needed as comments, all labels.

    Examples
    --------
    >>> print(marker_template(["LKNE", "Point 7"]).splitlines()[-1])
    left_knee_lateral = ["LKNE"]
    """
    found = find_sites(labels)
    used = {label for chosen in found.values() for label in chosen}
    unknown = ", ".join(_quoted(label) for label in labels if label not in used)
    places = {f"{side}_{place}" for side in ("left", "right") for any_of in NEEDED.values() for place in any_of.split()}
    lines = [
        "# Which marker is where on the body. Fill in labels, take a # away; what is left out is found by the labels.",
        "# Needed: three of the pelvis (asis, psis, sacrum) or both hips; and of both sides",
        *(f"#   {joint}: one of {', '.join(any_of.split())}" for joint, any_of in NEEDED.items()),
        f"# Labels that no place is known for: {unknown or 'none'}",
        "",
        "[markers]",
    ]
    pelvis = [site for site, place in SITES.items() if place.segment == "Hips"]
    missing = [site for site in SITES if site not in found and (site in places or site in pelvis)]
    lines += [f'# {site} = [""]' for site in missing]
    lines += [f"{site} = [{', '.join(map(_quoted, chosen))}]" for site, chosen in found.items()]
    return "\n".join(lines) + "\n"


def _quoted(label: str) -> str:
    return json.dumps(label, ensure_ascii=False)
