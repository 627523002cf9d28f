"""Random changes of SysML v2 and KerML texts: tokens, members, names, relations, cycles."""

from collections.abc import Callable
from random import Random

from dialects.mutations import pair_in_cycle
from fuzz.text_choices import (
    choose_member,
    choose_name,
    choose_or,
    choose_token,
    fill_in,
    insert,
    insert_member,
    is_kerml,
    make_member,
    make_path,
)
from fuzz.text_pieces import (
    KERML_KINDS,
    KEYWORDS,
    KINDS,
    PREFIXES,
    RELATIONS,
    Pieces,
    find_bodies,
    find_declared_names,
    find_members,
    find_names,
    find_tokens,
    is_name,
    split_pieces,
)
from fuzz.text_templates import EXPRESSIONS, JUNK, MULTIPLICITIES

TextChange = Callable[[Pieces, Random], Pieces]
_LARGE = 3000
"""Number of pieces from which a member is too large to be inserted many times."""


def mutate_text(text: str, random: Random, donor: str = "") -> tuple[str, str]:
    """Apply one to four random changes; return their names and the result.

    *donor* is another text, from which a member may be copied.
    """
    parts, descriptions = split_pieces(text), []
    for _ in range(random.choice((1, 1, 2, 2, 3, 4))):
        if donor and random.random() < 0.05:
            descriptions.append("graft")
            parts = _insert_foreign_member(parts, split_pieces(donor), random)
        else:
            change = random.choice(TEXT_CHANGES)
            descriptions.append(change.__name__.strip("_"))
            parts = change(parts, random)
    return " ".join(descriptions), "".join(parts)


# -- tokens and lines ----------------------------------------------------------------------------


def _drop_token(parts: Pieces, random: Random) -> Pieces:
    index = choose_token(parts, random)
    return parts[:index] + parts[index + 1 :]


def _duplicate_token(parts: Pieces, random: Random) -> Pieces:
    index = choose_token(parts, random)
    return insert(parts, index, *parts[index : index + 1], " ")


def _swap_tokens(parts: Pieces, random: Random) -> Pieces:
    first, second = choose_token(parts, random), choose_token(parts, random)
    swapped = list(parts)
    if parts:
        swapped[first], swapped[second] = parts[second], parts[first]
    return swapped


def _replace_token(parts: Pieces, random: Random) -> Pieces:
    index, donor = choose_token(parts, random), choose_token(parts, random)
    return [*parts[:index], *parts[donor : donor + 1], *parts[index + 1 :]]


def _insert_junk(parts: Pieces, random: Random) -> Pieces:
    return insert(parts, random.randrange(len(parts) + 1), random.choice(JUNK))


def _change_line(parts: Pieces, random: Random) -> Pieces:
    """Drop, duplicate or move a line."""
    lines = "".join(parts).split("\n")
    index, target = random.randrange(len(lines)), random.randrange(len(lines))
    line = lines.pop(index)
    lines[target:target] = random.choice(([], [line], [line, line]))
    return split_pieces("\n".join(lines))


def _unbalance_brackets(parts: Pieces, random: Random) -> Pieces:
    braces = [index for index, part in enumerate(parts) if part in ("{", "}", "(", ")", "[", "]")]
    index = choose_or(braces, random, 0)
    return [*parts[:index], *random.choice(([], ["{"], ["}"], ["}", "}"])), *parts[index + 1 :]]


def _truncate_text(parts: Pieces, random: Random) -> Pieces:
    return parts[: random.randrange(len(parts) + 1)]


# -- members -------------------------------------------------------------------------------------


def _drop_member(parts: Pieces, random: Random) -> Pieces:
    start, end = choose_member(parts, random)
    return parts[:start] + parts[end:]


def _drop_many(parts: Pieces, random: Random) -> Pieces:
    """Drop most of the members that begin with the same word."""
    ranges = find_members(parts)
    start, _ = choose_or(ranges, random, (0, 0))
    result = list(parts)
    for begin, end in ranges:
        if parts[begin] == parts[start] and random.random() < 0.7:
            result[begin:end] = [""] * (end - begin)
    return result


def _duplicate_member(parts: Pieces, random: Random) -> Pieces:
    start, end = choose_member(parts, random)
    return insert(parts, end, "\n", *parts[start:end])


def _move_member(parts: Pieces, random: Random) -> Pieces:
    start, end = choose_member(parts, random)
    return insert_member(parts[:start] + parts[end:], random, "".join(parts[start:end]))


def _swap_members(parts: Pieces, random: Random) -> Pieces:
    (a, b), (c, d) = sorted((choose_member(parts, random), choose_member(parts, random)))
    if b > c:
        return parts
    return [*parts[:a], *parts[c:d], *parts[b:c], *parts[a:b], *parts[d:]]


def _copy_member(parts: Pieces, random: Random) -> Pieces:
    """Copy a member to a random place, perhaps into itself."""
    start, end = choose_member(parts, random)
    return insert_member(parts, random, "".join(parts[start:end]))


def _copy_into_itself(parts: Pieces, random: Random) -> Pieces:
    start, end = choose_member(parts, random)
    indices = [index + 1 for index in range(start, end) if parts[index] == "{"]
    if end - start > _LARGE or not indices:
        return parts
    return insert(parts, random.choice(indices), *parts[start:end])


def _empty_body(parts: Pieces, random: Random) -> Pieces:
    start, end = choose_or(find_bodies(parts), random, (0, 0))
    return (
        [*parts[: start + 1], *parts[end:]]
        if random.random() < 0.5
        else [
            *parts[:start],
            ";",
            *parts[end + 1 :],
        ]
    )


def _add_many_copies(parts: Pieces, random: Random) -> Pieces:
    """Add many copies of one member, with the same name or with different names."""
    start, end = choose_member(parts, random)
    if not 0 < end - start <= _LARGE // 10:
        return parts
    name_index = next((index for index in range(start, end) if is_name(parts[index])), start)
    copies: Pieces = []
    is_renamed = random.random() < 0.5
    for number in range(random.choice((5, 60))):
        copy = parts[start:end]
        if is_renamed and is_name(parts[name_index]):
            copy[name_index - start] = f"'{parts[name_index].strip(chr(39))} {number}'"
        copies += ["\n", *copy]
    return insert(parts, end, *copies)


def _nest_deeply(parts: Pieces, random: Random) -> Pieces:
    """Nest a member deeply: below or above the limit on depth."""
    start, end = choose_member(parts, random)
    depth = random.choice((20, 90, 300, 700))
    word = random.choice(("part", "action", "state", "package", "class", "if", "loop"))
    name = choose_name(parts, random)
    opening = [f"{word} {random.choice((name, f'd{level}'))} {{" for level in range(depth)]
    return [*parts[:start], *opening, *parts[start:end], "}" * depth, *parts[end:]]


def _insert_foreign_member(parts: Pieces, donor: Pieces, random: Random) -> Pieces:
    """Insert a member of another text."""
    start, end = choose_member(donor, random)
    return insert_member(parts, random, "".join(donor[start:end]))


def _insert_template_members(parts: Pieces, random: Random) -> Pieces:
    for _ in range(random.choice((1, 1, 2, 4))):
        parts = insert_member(parts, random, make_member(parts, random))
    return parts


# -- names ---------------------------------------------------------------------------------------


def _misdirect_names(parts: Pieces, random: Random) -> Pieces:
    result = list(parts)
    indices = find_names(parts)
    for index in random.sample(indices, min(len(indices), random.choice((1, 1, 2, 5)))):
        result[index] = make_path(parts, random)
    return result


def _rename_all(parts: Pieces, random: Random) -> Pieces:
    """Replace all uses of one name by another name, which may be in use or odd."""
    old = choose_name(parts, random)
    odd_names = (
        *("none", "''", "'a b'", "'::'", "start", "done"),
        *("self", "that", "'", "é", "Parts", "SI"),
    )
    new = choose_name(parts, random) if random.random() < 0.6 else random.choice(odd_names)
    return [new if part == old else part for part in parts]


def _drop_names(parts: Pieces, random: Random) -> Pieces:
    """Remove the name of one declaration, of some, or of most."""
    indices = find_declared_names(parts)
    result = list(parts)
    share = random.choice((0.0, 0.1, 0.8))
    for index in indices:
        if random.random() < share:
            result[index] = ""
    if indices:
        result[random.choice(indices)] = ""
    return result


def _duplicate_names(parts: Pieces, random: Random) -> Pieces:
    """Give several declarations the same name."""
    indices = find_declared_names(parts)
    result, name = list(parts), choose_name(parts, random)
    for index in random.sample(indices, min(len(indices), random.choice((1, 2, 6)))):
        result[index] = name
    return result


def _make_cycle(parts: Pieces, random: Random) -> Pieces:
    """Make declarations specialise, redefine, type or equal one another in a cycle."""
    indices = find_declared_names(parts)
    chosen = random.sample(indices, min(len(indices), random.randint(1, 4)))
    sign = random.choice((":>", ":>", ":", ":>>", "::>", "=", "=>", ": ~", "chains", "conjugates"))
    result = list(parts)
    for index, target in pair_in_cycle(chosen):
        result[index] = f"{parts[index]} {sign} {parts[target]}"
    return result


# -- words and relations -------------------------------------------------------------------------


def _change_keyword(parts: Pieces, random: Random) -> Pieces:
    """Replace a keyword by another one, once or everywhere."""
    indices = [index for index in find_tokens(parts) if parts[index] in KEYWORDS]
    index = choose_or(indices, random, -1)
    if index < 0:
        return parts
    kinds = KERML_KINDS if is_kerml(parts) else KINDS
    new = random.choice(kinds if random.random() < 0.8 else sorted(KEYWORDS))
    if random.random() < 0.2:
        return [new if part == parts[index] else part for part in parts]
    return [*parts[:index], new, *parts[index + 1 :]]


def _swap_definition_and_usage(parts: Pieces, random: Random) -> Pieces:
    """Turn usages into definitions and definitions into usages, one or half of them."""
    result = list(parts)
    indices = [index for index in find_tokens(parts) if parts[index] in (*KINDS, "def")]
    share = random.choice((0.0, 0.5))
    chosen = [index for index in indices if random.random() < share]
    for index in chosen or random.sample(indices, min(1, len(indices))):
        result[index] = "" if parts[index] == "def" else f"{parts[index]} def"
    return result


def _insert_prefix(parts: Pieces, random: Random) -> Pieces:
    """Insert a prefix before a member, whether it may have one or not."""
    start, _ = choose_member(parts, random)
    before = random.choice(
        (*PREFIXES, *PREFIXES, f"#{choose_name(parts, random)}", "~", "then", "#")
    )
    return insert(parts, start, before, " ")


def _change_relation(parts: Pieces, random: Random) -> Pieces:
    indices = [index for index, part in enumerate(parts) if part in RELATIONS]
    index = choose_or(indices, random, -1)
    if index < 0:
        return parts
    return [*parts[:index], random.choice(RELATIONS), *parts[index + 1 :]]


def _add_relations(parts: Pieces, random: Random) -> Pieces:
    """Add types, specialisations and values after declared names."""
    indices = find_declared_names(parts)
    result = list(parts)
    for index in random.sample(indices, min(len(indices), random.choice((1, 1, 3)))):
        sign = random.choice((":", ":>", ":>>", "::>", "=>", ": ~", "references", "subsets"))
        result[index] = f"{parts[index]} {sign} {make_path(parts, random)}"
    return result


def _set_odd_value(parts: Pieces, random: Random) -> Pieces:
    """Insert an odd expression as a value, or in place of another expression."""
    expression = fill_in(random.choice(EXPRESSIONS), parts, random)
    signs = [
        index for index, part in enumerate(parts) if part in ("=", ":=", "default", "if", "==", "(")
    ]
    if signs and random.random() < 0.6:
        index = random.choice(signs)
        ends = (")", ";", "{", "}", "then", "do", ",")
        end = next((e for e in range(index + 1, len(parts)) if parts[e] in ends), index + 1)
        return [*parts[: index + 1], " ", expression, " ", *parts[end:]]
    index = choose_or(find_declared_names(parts), random, -1)
    sign = random.choice((" = ", " := ", " default ", " default = "))
    return insert(parts, index + 1, sign, expression) if index >= 0 else parts


def _add_odd_multiplicity(parts: Pieces, random: Random) -> Pieces:
    indices = find_declared_names(parts)
    result = list(parts)
    for index in random.sample(indices, min(len(indices), 2)):
        result[index] = parts[index] + fill_in(random.choice(MULTIPLICITIES), parts, random)
    return result


TEXT_CHANGES: tuple[TextChange, ...] = (
    _drop_token,
    _duplicate_token,
    _swap_tokens,
    _replace_token,
    _insert_junk,
    _change_line,
    _unbalance_brackets,
    _truncate_text,
    _drop_member,
    _drop_member,
    _drop_many,
    _duplicate_member,
    _move_member,
    _move_member,
    _swap_members,
    _copy_member,
    _copy_into_itself,
    _empty_body,
    _add_many_copies,
    _nest_deeply,
    _insert_template_members,
    _insert_template_members,
    _insert_template_members,
    _misdirect_names,
    _misdirect_names,
    _misdirect_names,
    _rename_all,
    _drop_names,
    _duplicate_names,
    _make_cycle,
    _make_cycle,
    _change_keyword,
    _change_keyword,
    _swap_definition_and_usage,
    _insert_prefix,
    _change_relation,
    _add_relations,
    _set_odd_value,
    _set_odd_value,
    _add_odd_multiplicity,
)
"""All changes of texts; frequent ones are listed several times."""
