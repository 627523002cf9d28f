"""A text of SysML v2 or KerML as pieces: tokens and what is between them; its members, its names.

It knows nothing of the compiler that it is to spoil texts for.
"""

import re
from collections.abc import Iterator

_PIECE = re.compile(
    r"//\*(?s:.)*?\*/|/\*(?s:.)*?\*/|//[^\n]*"
    r"|\"(?:[^\"\\]|\\(?s:.))*\"|'(?:[^'\\\n]|\\.)*'"
    r"|[^\W\d]\w*|\d[\w.]*|===|!==|:>>|::>|\*\*|::|:>|:=|==|!=|<=|>=|=>|->|\.\.|\.\?|\?\?|@@"
    r"|\s+|(?s:.)"
)


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


KINDS = _words("""
    part item attribute port action state requirement constraint calc connection interface flow
    allocation occurrence enum metadata view viewpoint rendering concern case analysis verification
    package use individual snapshot timeslice event message exhibit perform include satisfy assert
    verify frame actor subject stakeholder objective ref succession bind transition
""")
"""Words of SysML v2 that usages and definitions begin with."""
KERML_KINDS = _words("""
    class struct datatype assoc behavior function predicate interaction metaclass classifier type
    feature step expr bool inv connector binding succession flow package namespace multiplicity
    subtype specialization conjugation disjoining redefinition subset inverse featuring
""")
"""The same of KerML."""
RELATIONS = (":", ":>", ":>>", "::>", "=>", "=", ":=", "::", ".", ",", "..", "~", "->", "==", "<")
PREFIXES = _words("""
    abstract ref in out inout end derived variation individual snapshot timeslice readonly constant
    private protected public variant composite portion var ordered nonunique default parallel
""")
_OTHERS = _words("""
    about accept after alias all allocate and as assign assume at bind by chains comment connect
    conjugates crosses decide def defined dependency differences disjoint do doc done else entry
    exit expose false featured filter first for fork from hastype if implies import intersects
    istype join language library locale loop member merge meta new not null of or redefines
    references rep render require return send specializes standard start subsets terminate then
    to true typed unions until via when while xor
""")
KEYWORDS = frozenset((*KINDS, *KERML_KINDS, *PREFIXES, *_OTHERS))

Pieces = list[str]


def pieces(text: str) -> Pieces:
    """The text cut up; joined, the pieces are the text."""
    return _PIECE.findall(text)


def tokens(parts: Pieces) -> list[int]:
    """Where tokens are: no blanks, no comments."""
    return [at for at, part in enumerate(parts) if part.strip() and not is_comment(part)]


def is_comment(part: str) -> bool:
    """Whether a piece is a comment or note."""
    return part.startswith(("//", "/*"))


def is_name(part: str) -> bool:
    """Whether a piece is a name, with or without quotes."""
    is_word = part[:1].isalpha() or part.startswith(("_", "'"))
    return is_word and part not in KEYWORDS


def names(parts: Pieces) -> list[int]:
    """Where names are."""
    return [at for at, part in enumerate(parts) if is_name(part)]


def declared(parts: Pieces) -> list[int]:
    """Where names stand behind a word that declares something."""
    found = []
    before = ""
    for at in tokens(parts):
        if is_name(parts[at]) and before in KEYWORDS:
            found.append(at)
        before = parts[at]
    return found


def bodies(parts: Pieces) -> list[tuple[int, int]]:
    """Where braces open and close."""
    found, opened = [], []
    for at, part in enumerate(parts):
        if part == "{":
            opened.append(at)
        elif part == "}" and opened:
            found.append((opened.pop(), at))
    return sorted(found)


def members(parts: Pieces) -> list[tuple[int, int]]:
    """Where members begin and end (behind the semicolon or the brace), those within others too."""
    return sorted(_members(parts))


def _members(parts: Pieces) -> Iterator[tuple[int, int]]:
    began: list[int | None] = [None]
    for at in tokens(parts):
        part = parts[at]
        if part == "}":
            began = began[:-1] or [None]
        elif began[-1] is None:
            began[-1] = at
        if part == "{":
            began.append(None)
        elif part in (";", "}"):
            start, began[-1] = began[-1], None
            if start is not None:
                yield start, at + 1
