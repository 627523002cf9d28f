"""JSON as text, in the form of all our outputs."""

import json
from collections.abc import Iterable, Mapping


def encode_json(content: object, indent: int = 1) -> str:
    """Return *content* as the text of a JSON file: indented, with a line feed at the end.

    Characters beyond ASCII stay as they are, because all files are UTF-8.
    """
    return json.dumps(content, ensure_ascii=False, indent=indent) + "\n"


def encode_row(content: object) -> str:
    """Return *content* as JSON on one line, for lists that are too long to be indented."""
    return json.dumps(content, ensure_ascii=False)


def append_members(head: Mapping[str, object], members: Iterable[str]) -> str:
    """Return a JSON file with the members of *head* and then *members*, which are JSON already."""
    start = encode_json(head, 2).removesuffix("\n}\n")
    return ",\n".join((start, *members)) + "\n}\n"
