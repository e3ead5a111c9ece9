"""Writes ``docs/documents.md`` from the documents' own types: ``python docs/make_documents.py``."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from onbeat.dance.document import DanceDocument
from onbeat.formats.report import FileReport
from onbeat.keyposes.document import KeyposesDocument
from onbeat.keyposes.judging import AnswersDocument
from onbeat.keyposes.lowdim_document import LowdimDocument
from onbeat.keyposes.threshold_file import LearnedDocument
from onbeat.music.song import SongDocument
from onbeat.reproduce.document import ResultsDocument
from onbeat.reproduce.study.answers import StudyDocument
from onbeat.retime.document import RetimeDocument
from onbeat.retime.observe_document import ObserveDocument
from onbeat.robots.document import RobotDocument

PAGE = Path(__file__).parent / "documents.md"

HEAD = """# Documents

Everything onbeat says about a song or a dance beside sound and motion is a JSON document. Times are seconds. A document
carries its version; an onbeat that does not know that version says so and stops. Fields may be added within a version:
readers pass over fields they do not know.

This page is written by `python docs/make_documents.py` from the types that read and write the documents; a test
holds them together.
"""


class Document(NamedTuple):
    """A document by the name of its file, the type that reads it, who writes it, and what else is to be known."""

    name: str
    type: type
    about: str
    more: str = ""


METRICS = """
`metrics` are groups of scores: `search`, `beats_before_warp`, `beats`, `warp`, `intensity`, `feet`, `smoothness` and
`variety` ([how to read them](choose.md)). Those of `search`, of which the last four are there only where a library was
too great to be searched whole:

| score | what |
|---|---|
| `objective` | what the plan is worth to the search |
| `optimum_with_repeats` | what the best plan is worth that may show a stretch twice; null if it was not searched for |
| `of_optimum` | the first divided by the second |
| `searched_s`, `library_s` | seconds of motion, with mirror images, of the part that was searched and of the library |
| `bound` | no plan in the whole library is worth more |
| `gap_at_most` | 0…1: by what share of `bound` the best plan of the part may be below the best there is |

`wishes` is there where something was wished: `kept_s` and `favourites_s` are the seconds that were kept and that show
favourites, `forbidden_clips` how many there are; of `objective`, `favourites_earned` is for favourites and
`seed_earned` for what the seed likes.
"""


DOCUMENTS = (
    Document(
        "song.json", SongDocument, "Written by `onbeat listen SONG -o song.json` and, as danced to, by `onbeat dance`."
    ),
    Document("dance.json", DanceDocument, "Written by `onbeat dance` beside the motion.", METRICS),
    Document("keyposes.json", KeyposesDocument, "Written by `onbeat keyposes MOTION -o FOLDER`."),
    Document("thresholds.json", LearnedDocument, "Written by `onbeat keyposes learn … -o thresholds.json`."),
    Document("lowdim.json", LowdimDocument, "Written by `onbeat lowdim MOTIONS… -o FOLDER`."),
    Document("observe.json", ObserveDocument, "Written by `onbeat observe MOTIONS… -o FOLDER`."),
    Document("retime.json", RetimeDocument, "Written by `onbeat retime MOTION … -o FOLDER` beside the motion."),
    Document("robot.json", RobotDocument, "Written by `onbeat robot MOTION … -o FOLDER` beside the dance."),
    Document("answers.json", AnswersDocument, "Saved by `judge.html`, read by `onbeat lowdim --judged`."),
    Document(
        "answers.json of a study",
        StudyDocument,
        "Saved by `study.html`, and kept by `onbeat reproduce study FOLDER` in its folder `answers`, a file a person.",
    ),
    Document("results.json", ResultsDocument, "Written by `onbeat reproduce` beside the pages of the papers."),
    Document("Report of a motion file", FileReport, "Printed by `onbeat info FILE --json`."),
)


def page() -> str:
    """The whole page as Markdown."""
    return "\n".join([HEAD, *(section(document) for document in DOCUMENTS)])


def section(document: Document) -> str:
    """One document: its fields as tables, its own first, and its JSON schema."""
    schema = msgspec.json.schema(document.type)
    parts = {name: found for name, found in schema["$defs"].items() if name != document.type.__name__}
    tables = [table(schema["$defs"][document.type.__name__])]
    tables += [f"`{name}`: {table(found)}" for name, found in parts.items()]
    pretty = msgspec.json.format(msgspec.json.encode(schema), indent=2).decode()
    head = f"## {document.name}\n\n{document.about}\n\n"
    return head + "\n".join(tables) + document.more + f"\nAs JSON schema:\n\n```json\n{pretty}\n```\n"


def table(schema: dict[str, Any]) -> str:
    """The fields of one type."""
    required = schema.get("required", [])
    rows = ["| field | type | what |", "|---|---|---|"]
    for field, found in schema["properties"].items():
        optional = "" if field in required else "; may be left out"
        rows.append(f"| `{field}` | {kind(found)} | {found['description']}{optional} |")
    return schema["description"].replace("``", "`") + "\n\n" + "\n".join(rows) + "\n"


def kind(schema: dict[str, Any]) -> str:
    """A type in words."""
    if "anyOf" in schema and not any("$ref" in one for one in schema["anyOf"]):
        return " or ".join(kind(one) for one in schema["anyOf"])
    if "$ref" in schema or "allOf" in schema or "anyOf" in schema:
        ref = schema.get("$ref") or (schema.get("allOf") or schema["anyOf"])[0]["$ref"]
        return f"`{ref.rsplit('/', 1)[-1]}`"
    if schema["type"] == "array":
        return f"list of {kind(schema['items'])}"
    words = {"object": "object", "integer": "whole number", "string": "text", "boolean": "yes or no"}
    return words.get(schema["type"], schema["type"])


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
