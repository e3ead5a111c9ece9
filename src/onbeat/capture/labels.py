"""Which marker sits where: the labels of the usual marker sets, and a clear word where too little is known."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence

from onbeat.capture.marker_sets import SETS
from onbeat.capture.sites import SITES
from onbeat.errors import BodyError

_SIDES = {"left": ("l", "left"), "right": ("r", "right")}


def _labels(table: Mapping[str, str]) -> dict[str, list[str]]:
    """The plain labels of each site, the likelier first."""
    found: dict[str, list[str]] = {}
    for site, labels in table.items():
        for side, short in _SIDES.items() if "*" in site else [("", ("",))]:
            name = site.replace("*", f"{side}_")
            plain = found.setdefault(name, [])
            for label in labels.split():
                label, _, only = label.partition(">")
                plain += [label.replace("*", s) for s in short] if only in ("", side) else []
                plain += [label.replace("*", "") + side] if "*" in label and side else []
    return found


_KNOWN = {name: _labels(table) for name, table in SETS.items()}


def plain_labels(labels: Sequence[str]) -> list[str]:
    """Labels without case, separators and the subject's name ("Anna:LASI", "Skeleton_Hip1").

    Examples
    --------
    >>> plain_labels(["Anna:LASI", "Anna:R.Knee"])
    ['lasi', 'rknee']
    """
    bare = [label.split(":")[-1] for label in labels]
    heads = Counter(match.group(1) for label in bare if (match := re.match(r"([^_]{3,})_", label)))
    if heads:
        head, count = heads.most_common(1)[0]
        if count > max(2, len(bare) // 2):
            bare = [label.removeprefix(f"{head}_") for label in bare]
    return [re.sub(r"[^a-z0-9]", "", label.lower()) for label in bare]


def find_sites(labels: Sequence[str], sites: Mapping[str, Sequence[str]] | None = None) -> dict[str, tuple[str, ...]]:
    """The labels of each site that is found.

    The marker set of which most labels are there goes first; the others add what it leaves open, unless the labels
    name joints.

    Parameters
    ----------
    labels : as the file spells them.
    sites : what is known better: labels by site (:data:`onbeat.capture.sites.SITES`); several labels of one site mean
        the middle of them.

    Raises
    ------
    BodyError
        If a site or a label of ``sites`` does not exist.

    Examples
    --------
    >>> found = find_sites(["LKNE", "R.Knee", "Tail"])
    >>> found["left_knee_lateral"], len(found)
    (('LKNE',), 2)
    """
    found = {site: _given(site, chosen, labels) for site, chosen in (sites or {}).items()}
    used = {label for chosen in found.values() for label in chosen}
    free = {
        plain: label
        for plain, label in reversed(list(zip(plain_labels(labels), labels, strict=True)))
        if label not in used
    }
    order = sorted(_KNOWN, key=lambda name: -_matches(name, free))
    for name in order[:1] if order[0] == "joints" else [name for name in order if name != "joints"]:
        for site, known in _KNOWN[name].items():
            label = next((plain for plain in known if plain in free), None)
            if label is not None and site not in found:
                found[site] = (free.pop(label),)
    return found


def _matches(name: str, free: Mapping[str, str]) -> int:
    return sum(any(plain in free for plain in known) for known in _KNOWN[name].values())


def _given(site: str, chosen: Sequence[str], labels: Sequence[str]) -> tuple[str, ...]:
    chosen = (chosen,) if isinstance(chosen, str) else tuple(chosen)
    if site not in SITES:
        raise BodyError(f"no place on the body is called {site!r}; there are {', '.join(SITES)}")
    missing = [label for label in chosen if label not in labels]
    if missing or not chosen:
        raise BodyError(f"the markers {', '.join(missing)} for {site} are not there; there are {', '.join(labels)}")
    return chosen


NEEDED: Mapping[str, str] = {
    "shoulder": "shoulder acromion",
    "elbow": "elbow elbow_lateral",
    "wrist": "wrist wrist_back wrist_thumb wrist_little",
    "knee": "knee knee_lateral",
    "ankle": "ankle ankle_lateral",
}
"""The joints without which no body is fitted, and the sites of which one must be seen."""


def check_enough(
    found: Mapping[str, Sequence[str]],
    labels: Sequence[str],
    name: str = "",
    joints: Sequence[str] = tuple(NEEDED),
    unseen: Sequence[str] = (),
) -> None:
    """Raise a ``BodyError`` unless the pelvis and both of these joints have markers.

    Parameters
    ----------
    found : the sites that are seen.
    labels : all there are, for the message.
    name : where they come from, for the message.
    joints : out of :data:`NEEDED`.
    unseen : labels that are known but of which nothing is ever seen.

    Examples
    --------
    >>> try:
    ...     check_enough({"left_acromion": ("LSHO",)}, ["LSHO"], joints=["shoulder"])
    ... except BodyError as error:
    ...     print(str(error)[:58])
    no body can be fitted to these markers: nothing is seen of
    """
    missing = [
        f"{side}_{joint} ({' or '.join(f'{side}_{place}' for place in NEEDED[joint].split())})"
        for side in ("left", "right")
        for joint in joints
        if not any(f"{side}_{place}" in found for place in NEEDED[joint].split())
    ]
    pelvis = [site for site in found if SITES[site].segment == "Hips"]
    if len(pelvis) < 3 and not {"left_hip", "right_hip"} <= set(pelvis):
        missing.insert(0, "three of the pelvis (left_asis, right_asis, left_psis, right_psis, sacrum) or both hips")
    if missing:
        raise BodyError(
            f"{name + ': ' if name else ''}no body can be fitted to these markers: nothing is seen of "
            f"{'; '.join(missing)}. Found are {_some(list(found)) or 'no sites'}. "
            + (f"Known but never seen are {_some(unseen)}. " if unseen else "")
            + f"The labels are {_some(labels)}. Say which are the missing sites in a roles file "
            "(`onbeat info FILE --roles-template`)"
        )


def _some(labels: Sequence[str], most: int = 12) -> str:
    return ", ".join(labels[:most]) + (f" and {len(labels) - most} more" if len(labels) > most else "")
