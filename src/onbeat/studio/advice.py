"""What messages advise, said for the studio: who sees them has a page before them and no command line."""

from __future__ import annotations

import re

_SAID = (
    (r"say where the beats are with --beats or --tap", "put its beats in on the song's page"),
    (r"choose (a|another) stretch(?: of it)? with --start and --seconds", r"choose \1 stretch of the song"),
    (r"dance to ([0-9.]+) --seconds at most", r"dance to \1 seconds at most"),
    (r"play the plan as it is with --no-warp", "choose another stretch of the song or other moves"),
    (r"say it with --source-fps", "where that is wrong, say it on the motion's page"),
    (r"say it with --[^;\n)]*(?:\([^)]*\))?", "where that is wrong, save the file at that rate and drop it again"),
    (r"build one with `onbeat moves build[^`]*`", "make the library again"),
    (r"write one with `onbeat dance`", "dance it again"),
    (r"`onbeat moves show` lists all of a library, dance\.json those of a dance", "the library's page lists all"),
    (r": `onbeat info [^`]*`", ""),
    (r" \(`?(?:onbeat )?(?:[a-z]+ )?--[^)]*\)", ""),
    (r" \(`onbeat [^`)]*`[^)]*\)", ""),
)
"""What is advised to those at a command line, and what is to be done here instead."""
_RULES = tuple((re.compile(said), here) for said, here in _SAID)


def here(text: str) -> str:
    """A message without what only a command line can do.

    Examples
    --------
    >>> here("no beat is heard: choose another stretch with --start and --seconds")
    'no beat is heard: choose another stretch of the song'
    >>> here("or say where the beats are with --beats or --tap")
    "or put its beats in on the song's page"
    >>> here("feet stand at +0.20 m (`onbeat convert --ground` puts them on 0)")
    'feet stand at +0.20 m'
    """
    for said, instead in _RULES:
        text = said.sub(instead, text)
    return text
