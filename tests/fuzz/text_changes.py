"""Changes of SysML v2 and KerML text: tokens, members, names, relations, circles, strangers."""

import re
from collections.abc import Callable
from random import Random

from fuzz.text_pieces import (
    KERML_KINDS,
    KEYWORDS,
    KINDS,
    PREFIXES,
    RELATIONS,
    Pieces,
    bodies,
    declared,
    is_name,
    members,
    names,
    pieces,
    tokens,
)
from fuzz.text_strangers import EXPRESSIONS, JUNK, KERML_MEMBERS, MEMBERS, MULTIPLICITIES

TextChange = Callable[[Pieces, Random], Pieces]
_PLACE = re.compile(r"\$([abc])")
_LARGE = 3000
"""Pieces of a member that is not put in many times."""


def mutate_text(text: str, random: Random, donor: str = "") -> tuple[str, str]:
    """One to four changes of a text; what was done, and the result.

    ``donor`` is another text, of which a member may be taken.
    """
    parts, done = pieces(text), []
    for _ in range(random.choice((1, 1, 2, 2, 3, 4))):
        if donor and random.random() < 0.05:
            done.append("graft")
            parts = _graft(parts, pieces(donor), random)
        else:
            change = random.choice(TEXT_CHANGES)
            done.append(change.__name__.strip("_"))
            parts = change(parts, random)
    return " ".join(done), "".join(parts)


def _any(found: list, random: Random, otherwise: object) -> object:
    return random.choice(found) if found else otherwise


def _token(parts: Pieces, random: Random) -> int:
    return _any(tokens(parts), random, 0)


def _member(parts: Pieces, random: Random) -> tuple[int, int]:
    return _any(members(parts), random, (0, 0))


def _name(parts: Pieces, random: Random) -> str:
    """A name of the text, most often one that it declares."""
    at = _any(declared(parts) if random.random() < 0.7 else names(parts), random, -1)
    return parts[at] if at >= 0 else "none"


def _path(parts: Pieces, random: Random) -> str:
    """A name, a qualified name or a chain, of which the links may have nothing to do together."""
    one, other = _name(parts, random), _name(parts, random)
    both = (f"{one}::{other}", f"{one}.{other}", f"{one}::{one}")
    return random.choice((one, one, one, *both, "none", f"$::{one}"))


def _filled(pattern: str, parts: Pieces, random: Random) -> str:
    known = {letter: _name(parts, random) for letter in "abc"}
    return _PLACE.sub(lambda found: known[found[1]], pattern)


def _is_kerml(parts: Pieces) -> bool:
    """Whether the text seems to be KerML."""
    return sum(p in KERML_KINDS for p in parts) > sum(p in KINDS for p in parts)


def _stranger(parts: Pieces, random: Random) -> str:
    is_other = random.random() < 0.1
    known = KERML_MEMBERS if _is_kerml(parts) != is_other else MEMBERS
    return _filled(random.choice(known), parts, random)


def _with(parts: Pieces, at: int, *new: str) -> Pieces:
    return [*parts[:at], *new, *parts[at:]]


def _into_a_body(parts: Pieces, random: Random, new: str) -> Pieces:
    """A member more, at any place between the members of a body."""
    places = [at + 1 for at, part in enumerate(parts) if part in (";", "{", "}")]
    return _with(parts, _any(places, random, len(parts)), "\n", new, "\n")


# -- tokens and lines ----------------------------------------------------------------------------


def _drop_token(parts: Pieces, random: Random) -> Pieces:
    at = _token(parts, random)
    return parts[:at] + parts[at + 1 :]


def _double_token(parts: Pieces, random: Random) -> Pieces:
    at = _token(parts, random)
    return _with(parts, at, *parts[at : at + 1], " ")


def _swap_tokens(parts: Pieces, random: Random) -> Pieces:
    one, other = _token(parts, random), _token(parts, random)
    made = list(parts)
    if parts:
        made[one], made[other] = parts[other], parts[one]
    return made


def _other_token(parts: Pieces, random: Random) -> Pieces:
    one, other = _token(parts, random), _token(parts, random)
    return [*parts[:one], *parts[other : other + 1], *parts[one + 1 :]]


def _junk(parts: Pieces, random: Random) -> Pieces:
    return _with(parts, random.randrange(len(parts) + 1), random.choice(JUNK))


def _lines(parts: Pieces, random: Random) -> Pieces:
    """A line is dropped, doubled or put elsewhere."""
    lines = "".join(parts).split("\n")
    one, other = random.randrange(len(lines)), random.randrange(len(lines))
    line = lines.pop(one)
    lines[other:other] = random.choice(([], [line], [line, line]))
    return pieces("\n".join(lines))


def _unbalance(parts: Pieces, random: Random) -> Pieces:
    braces = [at for at, part in enumerate(parts) if part in ("{", "}", "(", ")", "[", "]")]
    at = _any(braces, random, 0)
    return [*parts[:at], *random.choice(([], ["{"], ["}"], ["}", "}"])), *parts[at + 1 :]]


def _truncate(parts: Pieces, random: Random) -> Pieces:
    return parts[: random.randrange(len(parts) + 1)]


# -- members -------------------------------------------------------------------------------------


def _drop_member(parts: Pieces, random: Random) -> Pieces:
    start, end = _member(parts, random)
    return parts[:start] + parts[end:]


def _drop_many(parts: Pieces, random: Random) -> Pieces:
    """Every member that begins with one word is gone, or most of them."""
    found = members(parts)
    start, _ = _any(found, random, (0, 0))
    made = list(parts)
    for one, end in found:
        if parts[one] == parts[start] and random.random() < 0.7:
            made[one:end] = [""] * (end - one)
    return made


def _double_member(parts: Pieces, random: Random) -> Pieces:
    start, end = _member(parts, random)
    return _with(parts, end, "\n", *parts[start:end])


def _move_member(parts: Pieces, random: Random) -> Pieces:
    start, end = _member(parts, random)
    return _into_a_body(parts[:start] + parts[end:], random, "".join(parts[start:end]))


def _swap_members(parts: Pieces, random: Random) -> Pieces:
    (a, b), (c, d) = sorted((_member(parts, random), _member(parts, random)))
    if b > c:
        return parts
    return [*parts[:a], *parts[c:d], *parts[b:c], *parts[a:b], *parts[d:]]


def _copy_member(parts: Pieces, random: Random) -> Pieces:
    """A member also where it does not belong: in another body, in itself."""
    start, end = _member(parts, random)
    return _into_a_body(parts, random, "".join(parts[start:end]))


def _into_itself(parts: Pieces, random: Random) -> Pieces:
    start, end = _member(parts, random)
    inner = [at + 1 for at in range(start, end) if parts[at] == "{"]
    if end - start > _LARGE or not inner:
        return parts
    return _with(parts, random.choice(inner), *parts[start:end])


def _empty_a_body(parts: Pieces, random: Random) -> Pieces:
    start, end = _any(bodies(parts), random, (0, 0))
    return (
        [*parts[: start + 1], *parts[end:]]
        if random.random() < 0.5
        else [
            *parts[:start],
            ";",
            *parts[end + 1 :],
        ]
    )


def _crowd(parts: Pieces, random: Random) -> Pieces:
    """Many copies of one member, with one name or with names of their own."""
    start, end = _member(parts, random)
    if not 0 < end - start <= _LARGE // 10:
        return parts
    name = next((at for at in range(start, end) if is_name(parts[at])), start)
    copies: Pieces = []
    renamed = random.random() < 0.5
    for number in range(random.choice((5, 60))):
        copy = parts[start:end]
        if renamed and is_name(parts[name]):
            copy[name - start] = f"'{parts[name].strip(chr(39))} {number}'"
        copies += ["\n", *copy]
    return _with(parts, end, *copies)


def _dig(parts: Pieces, random: Random) -> Pieces:
    """A member so deep within others that recursion would end: under or over the limit."""
    start, end = _member(parts, random)
    depth = random.choice((20, 90, 300, 700))
    word = random.choice(("part", "action", "state", "package", "class", "if", "loop"))
    name = _name(parts, random)
    opening = [f"{word} {random.choice((name, f'd{at}'))} {{" for at in range(depth)]
    return [*parts[:start], *opening, *parts[start:end], "}" * depth, *parts[end:]]


def _graft(parts: Pieces, donor: Pieces, random: Random) -> Pieces:
    """A member of another text."""
    start, end = _member(donor, random)
    return _into_a_body(parts, random, "".join(donor[start:end]))


def _strangers(parts: Pieces, random: Random) -> Pieces:
    for _ in range(random.choice((1, 1, 2, 4))):
        parts = _into_a_body(parts, random, _stranger(parts, random))
    return parts


# -- names ---------------------------------------------------------------------------------------


def _retarget(parts: Pieces, random: Random) -> Pieces:
    made = list(parts)
    found = names(parts)
    for at in random.sample(found, min(len(found), random.choice((1, 1, 2, 5)))):
        made[at] = _path(parts, random)
    return made


def _rename_all(parts: Pieces, random: Random) -> Pieces:
    """All uses of one name get another: two things become one, or none."""
    old = _name(parts, random)
    odd = ("none", "''", "'a b'", "'::'", "start", "done", "self", "that", "'", "é", "Parts", "SI")
    new = _name(parts, random) if random.random() < 0.6 else random.choice(odd)
    return [new if part == old else part for part in parts]


def _no_names(parts: Pieces, random: Random) -> Pieces:
    """Declarations without a name: one, or most of them."""
    found = declared(parts)
    made = list(parts)
    share = random.choice((0.0, 0.1, 0.8))
    for at in found:
        if random.random() < share:
            made[at] = ""
    if found:
        made[random.choice(found)] = ""
    return made


def _same_names(parts: Pieces, random: Random) -> Pieces:
    """Declarations of one name in many places."""
    found = declared(parts)
    made, name = list(parts), _name(parts, random)
    for at in random.sample(found, min(len(found), random.choice((1, 2, 6)))):
        made[at] = name
    return made


def _circle(parts: Pieces, random: Random) -> Pieces:
    """What is declared specialises, is typed by, redefines or equals one another."""
    found = declared(parts)
    chosen = random.sample(found, min(len(found), random.randint(1, 4)))
    sign = random.choice((":>", ":>", ":", ":>>", "::>", "=", "=>", ": ~", "chains", "conjugates"))
    made = list(parts)
    for one, other in zip(chosen, chosen[1:] + chosen[:1], strict=True):
        made[one] = f"{parts[one]} {sign} {parts[other]}"
    return made


# -- words and relations -------------------------------------------------------------------------


def _other_word(parts: Pieces, random: Random) -> Pieces:
    """A keyword becomes another, here or everywhere."""
    words = [at for at in tokens(parts) if parts[at] in KEYWORDS]
    at = _any(words, random, -1)
    if at < 0:
        return parts
    same = KERML_KINDS if _is_kerml(parts) else KINDS
    new = random.choice(same if random.random() < 0.8 else sorted(KEYWORDS))
    if random.random() < 0.2:
        return [new if part == parts[at] else part for part in parts]
    return [*parts[:at], new, *parts[at + 1 :]]


def _definition_or_usage(parts: Pieces, random: Random) -> Pieces:
    """A usage becomes a definition, or a definition a usage; one, or most of them."""
    made = list(parts)
    found = [at for at in tokens(parts) if parts[at] in (*KINDS, "def")]
    share = random.choice((0.0, 0.5))
    chosen = [at for at in found if random.random() < share]
    for at in chosen or random.sample(found, min(1, len(found))):
        made[at] = "" if parts[at] == "def" else f"{parts[at]} def"
    return made


def _prefix(parts: Pieces, random: Random) -> Pieces:
    """A word before a member that it may not have, or has not."""
    start, _ = _member(parts, random)
    before = random.choice((*PREFIXES, *PREFIXES, f"#{_name(parts, random)}", "~", "then", "#"))
    return _with(parts, start, before, " ")


def _other_relation(parts: Pieces, random: Random) -> Pieces:
    found = [at for at, part in enumerate(parts) if part in RELATIONS]
    at = _any(found, random, -1)
    if at < 0:
        return parts
    return [*parts[:at], random.choice(RELATIONS), *parts[at + 1 :]]


def _more_relations(parts: Pieces, random: Random) -> Pieces:
    """Types, specialisations and values behind declared names."""
    found = declared(parts)
    made = list(parts)
    for at in random.sample(found, min(len(found), random.choice((1, 1, 3)))):
        sign = random.choice((":", ":>", ":>>", "::>", "=>", ": ~", "references", "subsets"))
        made[at] = f"{parts[at]} {sign} {_path(parts, random)}"
    return made


def _odd_value(parts: Pieces, random: Random) -> Pieces:
    """A value that is an odd expression, behind a declared name or in place of another."""
    odd = _filled(random.choice(EXPRESSIONS), parts, random)
    signs = [at for at, part in enumerate(parts) if part in ("=", ":=", "default", "if", "==", "(")]
    if signs and random.random() < 0.6:
        at = random.choice(signs)
        ends = (")", ";", "{", "}", "then", "do", ",")
        end = next((e for e in range(at + 1, len(parts)) if parts[e] in ends), at + 1)
        return [*parts[: at + 1], " ", odd, " ", *parts[end:]]
    at = _any(declared(parts), random, -1)
    sign = random.choice((" = ", " := ", " default ", " default = "))
    return _with(parts, at + 1, sign, odd) if at >= 0 else parts


def _odd_multiplicity(parts: Pieces, random: Random) -> Pieces:
    found = declared(parts)
    made = list(parts)
    for at in random.sample(found, min(len(found), 2)):
        made[at] = parts[at] + _filled(random.choice(MULTIPLICITIES), parts, random)
    return made


TEXT_CHANGES: tuple[TextChange, ...] = (
    _drop_token,
    _double_token,
    _swap_tokens,
    _other_token,
    _junk,
    _lines,
    _unbalance,
    _truncate,
    _drop_member,
    _drop_member,
    _drop_many,
    _double_member,
    _move_member,
    _move_member,
    _swap_members,
    _copy_member,
    _into_itself,
    _empty_a_body,
    _crowd,
    _dig,
    _strangers,
    _strangers,
    _strangers,
    _retarget,
    _retarget,
    _retarget,
    _rename_all,
    _no_names,
    _same_names,
    _circle,
    _circle,
    _other_word,
    _other_word,
    _definition_or_usage,
    _prefix,
    _other_relation,
    _more_relations,
    _odd_value,
    _odd_value,
    _odd_multiplicity,
)
"""What is done to texts."""
