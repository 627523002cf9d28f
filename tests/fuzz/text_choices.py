"""Random choices in a text of SysML v2 or KerML, and insertions of members and other pieces."""

import re
from collections.abc import Sequence
from random import Random
from typing import TypeVar

from fuzz.text_pieces import (
    KERML_KINDS,
    KINDS,
    Pieces,
    find_declared_names,
    find_members,
    find_names,
    find_tokens,
)
from fuzz.text_templates import KERML_MEMBERS, MEMBERS

T = TypeVar("T")
_PLACEHOLDER = re.compile(r"\$([abc])")


def choose_or(candidates: Sequence[T], random: Random, default: T) -> T:
    """Return a random candidate, or *default* if there are none."""
    return random.choice(candidates) if candidates else default


def choose_token(parts: Pieces, random: Random) -> int:
    return choose_or(find_tokens(parts), random, 0)


def choose_member(parts: Pieces, random: Random) -> tuple[int, int]:
    return choose_or(find_members(parts), random, (0, 0))


def choose_name(parts: Pieces, random: Random) -> str:
    """Return a name of the text, in most cases one that the text declares."""
    index = choose_or(
        find_declared_names(parts) if random.random() < 0.7 else find_names(parts), random, -1
    )
    return parts[index] if index >= 0 else "none"


def make_path(parts: Pieces, random: Random) -> str:
    """Return a name, a qualified name or a feature chain; its names may be unrelated."""
    first, second = choose_name(parts, random), choose_name(parts, random)
    compounds = (f"{first}::{second}", f"{first}.{second}", f"{first}::{first}")
    return random.choice((first, first, first, *compounds, "none", f"$::{first}"))


def fill_in(pattern: str, parts: Pieces, random: Random) -> str:
    """Replace ``$a``, ``$b`` and ``$c`` in *pattern* by names of the text."""
    names_by_letter = {letter: choose_name(parts, random) for letter in "abc"}
    return _PLACEHOLDER.sub(lambda match: names_by_letter[match[1]], pattern)


def is_kerml(parts: Pieces) -> bool:
    """Whether the text is probably KerML."""
    return sum(p in KERML_KINDS for p in parts) > sum(p in KINDS for p in parts)


def make_member(parts: Pieces, random: Random) -> str:
    """Return a member in the language of the text, at times in the other language."""
    is_other = random.random() < 0.1
    patterns = KERML_MEMBERS if is_kerml(parts) != is_other else MEMBERS
    return fill_in(random.choice(patterns), parts, random)


def insert(parts: Pieces, index: int, *new: str) -> Pieces:
    return [*parts[:index], *new, *parts[index:]]


def insert_member(parts: Pieces, random: Random, new: str) -> Pieces:
    """Insert a member at a random place between other members."""
    indices = [index + 1 for index, part in enumerate(parts) if part in (";", "{", "}")]
    return insert(parts, choose_or(indices, random, len(parts)), "\n", new, "\n")
