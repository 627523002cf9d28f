"""Texts of SysML v2 or KerML as lists of pieces: tokens, comments and white space between them.

The module is independent of the compiler, whose parser the mutated texts shall test.
"""

import re
from collections.abc import Iterator

_PIECE = re.compile(
    r"//\*(?s:.)*?\*/|/\*(?s:.)*?\*/|//[^\n]*"
    r"|\"(?:[^\"\\]|\\(?s:.))*\"|'(?:[^'\\\n]|\\.)*'"
    r"|[^\W\d]\w*|\d[\w.]*|===|!==|:>>|::>|\*\*|::|:>|:=|==|!=|<=|>=|=>|->|\.\.|\.\?|\?\?|@@"
    r"|\s+|(?s:.)"
)


def _split_words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


KINDS = _split_words("""
    part item attribute port action state requirement constraint calc connection interface flow
    allocation occurrence enum metadata view viewpoint rendering concern case analysis verification
    package use individual snapshot timeslice event message exhibit perform include satisfy assert
    verify frame actor subject stakeholder objective ref succession bind transition
""")
"""Keywords of usages and definitions in SysML v2."""
KERML_KINDS = _split_words("""
    class struct datatype assoc behavior function predicate interaction metaclass classifier type
    feature step expr bool inv connector binding succession flow package namespace multiplicity
    subtype specialization conjugation disjoining redefinition subset inverse featuring
""")
"""Keywords of types and features in KerML."""
RELATIONS = (":", ":>", ":>>", "::>", "=>", "=", ":=", "::", ".", ",", "..", "~", "->", "==", "<")
PREFIXES = _split_words("""
    abstract ref in out inout end derived variation individual snapshot timeslice readonly constant
    private protected public variant composite portion var ordered nonunique default parallel
""")
_OTHER_KEYWORDS = _split_words("""
    about accept after alias all allocate and as assign assume at bind by chains comment connect
    conjugates crosses decide def defined dependency differences disjoint do doc done else entry
    exit expose false featured filter first for fork from hastype if implies import intersects
    istype join language library locale loop member merge meta new not null of or redefines
    references rep render require return send specializes standard start subsets terminate then
    to true typed unions until via when while xor
""")
KEYWORDS = frozenset((*KINDS, *KERML_KINDS, *PREFIXES, *_OTHER_KEYWORDS))

Pieces = list[str]


def split_pieces(text: str) -> Pieces:
    """Split a text into pieces; the joined pieces are the text."""
    return _PIECE.findall(text)


def find_tokens(parts: Pieces) -> list[int]:
    """Return the indices of tokens, without white space and comments."""
    return [index for index, part in enumerate(parts) if part.strip() and not is_comment(part)]


def is_comment(part: str) -> bool:
    """Whether a piece is a comment or note."""
    return part.startswith(("//", "/*"))


def is_name(part: str) -> bool:
    """Whether a piece is a name, with or without quotes."""
    is_word = part[:1].isalpha() or part.startswith(("_", "'"))
    return is_word and part not in KEYWORDS


def find_names(parts: Pieces) -> list[int]:
    """Return the indices of names."""
    return [index for index, part in enumerate(parts) if is_name(part)]


def find_declared_names(parts: Pieces) -> list[int]:
    """Return the indices of names after a keyword, which mostly declare elements."""
    indices = []
    previous = ""
    for index in find_tokens(parts):
        if is_name(parts[index]) and previous in KEYWORDS:
            indices.append(index)
        previous = parts[index]
    return indices


def find_bodies(parts: Pieces) -> list[tuple[int, int]]:
    """Return the indices of matching braces."""
    pairs, open_braces = [], []
    for index, part in enumerate(parts):
        if part == "{":
            open_braces.append(index)
        elif part == "}" and open_braces:
            pairs.append((open_braces.pop(), index))
    return sorted(pairs)


def find_members(parts: Pieces) -> list[tuple[int, int]]:
    """Return the start and end of all members; the end is after the semicolon or the brace."""
    return sorted(_iter_members(parts))


def _iter_members(parts: Pieces) -> Iterator[tuple[int, int]]:
    starts: list[int | None] = [None]
    for index in find_tokens(parts):
        part = parts[index]
        if part == "}":
            starts = starts[:-1] or [None]
        elif starts[-1] is None:
            starts[-1] = index
        if part == "{":
            starts.append(None)
        elif part in (";", "}"):
            start, starts[-1] = starts[-1], None
            if start is not None:
                yield start, index + 1
