"""What the names of joints say: side, part of the body, and whether a joint only helps another one.

Names are taken apart into words: at separators, where a small letter meets a capital, and at digits. What is left
without the prefix that a file gives all its joints (``mixamorig:``, ``Bip01``, ``J_Bip_``, ``CC_Base_``, ``DEF-``) is a
side and a part: ``lfemur``, ``LeftUpLeg``, ``UpperLeg_L``, ``thigh.L`` and ``左足`` all are the left thigh. Parts are
those of Acclaim, CMU's BVH conversions, Mixamo and HumanIK, LAFAN1, SMPL, Xsens, Vicon, OptiTrack, Biped, Unreal,
Unity, Rigify, VRM, MakeHuman, Daz and Poser, MikuMikuDance, Kinect, OpenSim and the joints of robots' URDF.
"""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import NamedTuple

CENTRE_ROLES = ("hips", "spine", "chest", "neck", "head")
SIDE_ROLES = ("collar", "shoulder", "elbow", "wrist", "hand", "hip", "knee", "ankle", "toe")
ROLES = (*CENTRE_ROLES, *(f"{side}_{role}" for side in ("left", "right") for role in SIDE_ROLES))
"""All roles that a joint can play."""
NEEDED = (
    "hips",
    "chest",
    *(
        f"{side}_{role}"
        for side in ("left", "right")
        for role in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
    ),
)
"""Roles without which a body cannot dance."""

# For each role the parts that may play it, the likeliest first. Where a part stands for two roles the tree decides.
_CENTRE: Mapping[str, str] = {
    "hips": "hips pelvis root hip waist hipcenter hipcentre midhip spinebase pel lowerbody 下半身 center センター 腰",
    "spine": "lowerback spine spine0 spine1 abdomen abdomenlower torso lowback ab l5 spinemid spinenavel belly"
    " upperbody 上半身 waist",
    "chest": "thorax upperchest chestupper chest2 chest spine3 spine2 spine1 upperback t8 trx upperbody2 上半身2"
    " spinechest spineshoulder shouldercenter shouldercentre torso spine upperbody 上半身 waist",
    "neck": "lowerneck neck neck1 necklower upperneck necktwist1 首",
    "head": "head hed 頭",
}
_SIDE: Mapping[str, str] = {
    "collar": "clavicle collar shoulder inshoulder collarbone clav scapula thorax cl 肩",
    "shoulder": "humerus arm upperarm uparm uarm shldr shldrbend bicep hu 腕 shoulder",
    "elbow": "ulna radius forearm lowerarm elbow lowarm loarm farm forearmbend ra ひじ 肘",
    "wrist": "wrist wristrubberhand hand rubberhand palm hn 手首",
    "hand": "fingers middle1 handmiddle1 finger2 handend handsite fingerbase middleproximal mid1 fmiddle1 finger31"
    " 中指1 middlefinger1 finger3metacarpal handmid1 handtip rubberhand hand",
    "hip": "femur upleg upperleg thigh thighbend uleg hip fe leg 足",
    "knee": "tibia leg lowerleg shin calf knee lowleg loleg shank ti ひざ 膝",
    "ankle": "ankle talus foot fo 足首",
    "toe": "toes toebase toe toe0 toe11 bigtoe ball footend footsite to つま先 foot",
}
_ABBREVIATED = frozenset(("cl", "hu", "ra", "hn", "fe", "ti", "fo", "to"))
"""Vicon's two letters: believed only after a single letter for the side, as in ``LFE``."""
_SIDES: Mapping[str, str] = {
    **dict.fromkeys(("left", "l", "lft", "lt", "左"), "left"),
    **dict.fromkeys(("right", "r", "rgt", "rt", "右"), "right"),
}
_PREFIXES = frozenset(
    re.findall(r"\w+", "mixamorig bip biped def org base cc c j joint jnt bone bn character actor robot armature")
)
_HELPERS = frozenset(
    re.findall(r"\w+", "twist roll ik fk ctrl pole target helper share nub tweak mch socket dummy virtual")
)
_AXES = frozenset(("pitch", "roll", "yaw"))
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[0-9]+|[^\W0-9a-zA-Z_]+")
_WORST = 40  # how much less a name is believed of which a number or "joint" had to be cut


def _places(table: Mapping[str, str]) -> dict[str, tuple[tuple[str, int], ...]]:
    """The roles that each part may play, with the place of the part in the role's list."""
    found: dict[str, tuple[tuple[str, int], ...]] = {}
    for role, parts in table.items():
        for place, part in enumerate(parts.split()):
            found[part] = (*found.get(part, ()), (role, place))
    return found


_CENTRE_PLACES, _SIDE_PLACES = _places(_CENTRE), _places(_SIDE)


class Part(NamedTuple):
    """What a name says: ``left``, ``right`` or nothing, the part of the body, and whether it is a joint of a run.

    A run is several joints that turn one part about an axis each, as robots have: pitch, roll and yaw of a hip.
    """

    side: str
    word: str
    run: bool = False


class Candidate(NamedTuple):
    """A joint that may play a role by its name; the less the doubt, the likelier."""

    doubt: float
    joint: int
    run: int = -1
    """The first joint of the run that it is of, -1 where it is of none."""


def words_of(name: str) -> list[str]:
    """The words of a name in lower case, without namespace and leading zeros.

    Examples
    --------
    >>> words_of("mixamorig:LeftUpLeg"), words_of("DEF-upper_arm.L.001"), words_of("LThigh")
    (['left', 'up', 'leg'], ['def', 'upper', 'arm', 'l', '1'], ['l', 'thigh'])
    """
    name = unicodedata.normalize("NFKC", name[:200])
    name = re.split(r"[:|]", name.rstrip(":|"))[-1]
    name = re.sub(r"[_\-. ](joint|link|jnt|bone|bnd)$", "", name, flags=re.IGNORECASE)
    words = [word.lower() for word in _WORD.findall(name)]
    words = [part for word in words for part in (re.split("^([左右])", word) if word[0] in "左右" else (word,)) if part]
    return [(word.lstrip("0") or "0") if word.isdigit() else word for word in words]


def parts_of(names: Sequence[str]) -> list[Part | None]:
    """What the names of a skeleton's joints say; None of a joint that only helps: it twists or controls another.

    Examples
    --------
    >>> parts_of(["Bip01 L Thigh", "upperarm_twist_01_l", "左ひざ"])
    [Part(side='left', word='thigh', run=False), None, Part(side='left', word='ひざ', run=False)]
    """
    split = _without_prefixes([words_of(name) for name in names])
    everything = {word for words in split for word in words}
    axes: frozenset[str] = _AXES if everything & {"pitch", "yaw"} else frozenset()
    if {"p", "y"} <= {words[-1] for words in split if len(words) > 1}:
        axes |= {"p", "r", "y"}
    return [_part(words, axes) for words in split]


def _without_prefixes(split: list[list[str]]) -> list[list[str]]:
    """The words without prefixes that are known or that most joints share; a name is never emptied."""
    for _ in range(3):
        first = Counter(words[0] for words in split if words)
        shared = {word for word, count in first.items() if count >= max(8, 0.6 * len(split))}
        shared -= set(_SIDES) | set(_SIDE_PLACES) | set(_CENTRE_PLACES)
        split = [_without(words, shared) for words in split]
    return split


def _without(words: list[str], shared: set[str]) -> list[str]:
    known = len(words) > 1 and (words[0] in _PREFIXES or words[0] in shared)
    cut = 2 if known and len(words) > 2 and words[1].isdigit() else int(known)
    return words[cut:]


def _part(words: list[str], axes: frozenset[str]) -> Part | None:
    kept = [word for n, word in enumerate(words) if word not in axes or (len(word) == 1 and n + 1 < len(words))]
    run = 0 < len(kept) < len(words)
    words = kept if run else words
    whole = "".join(words)
    if whole in _CENTRE_PLACES:
        return Part("", whole, run)
    if _HELPERS & set(words) or "twist" in whole or "捩" in whole:
        return None
    for n, word in enumerate(words):
        if word in _SIDES and len(words) > 1:
            return Part(_SIDES[word], "".join(words[:n] + words[n + 1 :]), run)
    return _unseparated(whole, run) or Part("", whole.removesuffix("m") if words[-1:] == ["m"] else whole, run)


def _unseparated(whole: str, run: bool) -> Part | None:
    """Side and part of a name that sets nothing off: ``lfemur``, ``leftupleg``, ``LUArm``."""
    for mark, side in _SIDES.items():
        for rest in {whole[len(mark) :] if whole.startswith(mark) else "", whole.removesuffix(mark)} - {"", whole}:
            short = rest in _ABBREVIATED and not (len(mark) == 1 and len(whole) == 3 and whole.startswith(mark))
            if (_known(rest, _SIDE_PLACES) and not short) or mark in ("left", "right"):
                return Part(side, rest, run)
    return None


def _known(word: str, places: Mapping[str, tuple[tuple[str, int], ...]]) -> list[tuple[str, float]]:
    """Roles that a part may play, with the doubt of each."""
    for cut, doubt in ((word, 0), (re.sub("[01]$", "", word), _WORST), (word.removesuffix("joint"), 2 * _WORST)):
        if cut in places and (doubt == 0 or cut != word):
            return [(role, place + doubt) for role, place in places[cut]]
    return []


def named(parts: Sequence[Part | None]) -> dict[str, list[Candidate]]:
    """The joints that may play each role by their names, the likeliest first; at most 12 for a role.

    Of a limb's run of three joints or more the middle one is the likeliest, of two the first. A robot's hip and
    shoulder turn about pitch, roll and yaw in places centimetres apart: on Unitree's G1 the point nearest to the
    three axes is 2 cm from the roll, 6 cm from the pitch and 14 cm from the yaw joint. Pitch is beside the leg, yaw
    down the thigh. The H1, whose order is yaw, roll, pitch, has its middle joint where the axes meet as well. An
    ankle's first joint ends the shin.
    """
    found: dict[str, list[Candidate]] = {}
    runs: dict[tuple[str, str, bool], list[int]] = {}
    for joint, part in enumerate(parts):
        if part is not None:
            runs.setdefault((part.side, part.word, part.run), []).append(joint)
    for (side, word, run), joints in runs.items():
        middle = (len(joints) - 1) // 2 if run and side else 0
        for role, doubt in _known(word, _SIDE_PLACES if side else _CENTRE_PLACES):
            role = f"{side}_{role}" if side else role
            first = joints[0] if run else -1
            ranked = [Candidate(doubt + 0.1 * abs(n - middle), joint, first) for n, joint in enumerate(joints)]
            found.setdefault(role, []).extend(ranked)
    return {role: sorted(candidates)[:12] for role, candidates in found.items()}


def usual_names(role: str) -> tuple[str, ...]:
    """The parts that play a role in the common namings.

    Examples
    --------
    >>> usual_names("left_ankle")
    ('ankle', 'talus', 'foot', 'fo', '足首')
    """
    return tuple((_CENTRE.get(role) or _SIDE[role.split("_")[-1]]).split())
