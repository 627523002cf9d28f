"""How what the grammar expects is said in words."""

from collections.abc import Collection

_WORDS = {
    "NAME": "a name",
    "STRING": "a text in double quotes",
    "NUMBER": "a number",
    "BODY": "a comment /* ... */",
    "$END": "the end of the text",
}
_GROUPS = (
    (
        {"NUMBER", "null"},
        "an expression",
        "NAME STRING NUMBER null true false ( * + - ~ not new all if istype hastype @ as { $",
    ),
    (
        {":>", ":>>"},
        "what it specialises (':', ':>' or ':>>')",
        ": defined typed :> subsets :>> "
        "redefines ::> references => crosses [ ordered nonunique ~ conjugates disjoint unions "
        "intersects differences chains inverse featured specializes",
    ),
    ({"=", ":=", "default"}, "a value ('=')", "= := default"),
    (
        {"+", "xor"},
        "an operator",
        "?? or and implies xor | & == != === !== < > <= >= .. + - * / % ^ "
        "** istype hastype @ as @@ meta . .? -> # ( [ _INDEX",
    ),
)
_FIRST = ("';'", "'{'", "'}'")
_MOST = 5


def expectation(expected: Collection[str], beginnings: Collection[str]) -> str:
    """What may stand at a place, in words.

    ``expected`` are names of types and texts of words and symbols, ``beginnings`` those of them
    with which a member of a body may begin.
    """
    left = set(expected)
    said = []
    if {"package", "abstract"} <= left:
        said.append("a declaration")
        left -= set(beginnings)
    for needed, words, members in _GROUPS:
        if needed <= left:
            said.append(words)
            left -= set(members.split())
    if "NAME" in left:
        left -= {"$", "<", "~"}
    left -= {"_INDEX"} if len(left) == 1 else {"_INDEX", "parallel"}
    shown = [_WORDS.get(name, f"'{name}'") for name in sorted(left)]
    return joined(sorted(shown, key=_rank) + said)


def _rank(words: str) -> tuple[bool, bool, str]:
    return words not in _FIRST, not words.startswith("a "), words


def joined(parts: list[str]) -> str:
    """One of several, in words; of many only the first."""
    if len(parts) > _MOST:
        parts = [*parts[: _MOST - 1], "something else"]
    if len(parts) < 2:
        return parts[0] if parts else "nothing"
    return f"{', '.join(parts[:-1])} or {parts[-1]}"
