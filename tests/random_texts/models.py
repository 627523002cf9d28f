"""Random texts: packages with imports, and the layout of their tokens."""

from collections.abc import Callable
from random import Random

from fuzz.text_pieces import is_comment, split_pieces
from random_texts import behaviour, connections, requirements, structure
from random_texts.drafts import Draft, Package

_DRAWERS: tuple[tuple[int, Callable[[Draft], object]], ...] = (
    (2, structure.draw_attribute_definition),
    (2, structure.draw_enumeration),
    (3, lambda draft: structure.draw_structure_definition(draft, "item def")),
    (5, lambda draft: structure.draw_structure_definition(draft, "part def")),
    (1, lambda draft: structure.draw_structure_definition(draft, "occurrence def")),
    (3, structure.draw_port_definition),
    (3, lambda draft: structure.draw_usage(draft, "part")),
    (1, lambda draft: structure.draw_usage(draft, "item")),
    (1, structure.draw_special_usage),
    (2, structure.draw_global_attribute),
    (1, structure.draw_individual),
    (1, structure.draw_variation),
    (1, connections.draw_connection_definition),
    (1, connections.draw_interface_definition),
    (2, connections.draw_assembly),
    (1, connections.draw_sequence),
    (1, connections.draw_flow_definition),
    (2, connections.draw_dependency),
    (2, connections.draw_metadata),
    (3, behaviour.draw_action_definition),
    (2, behaviour.draw_action_usage),
    (2, behaviour.draw_calculation),
    (1, behaviour.draw_constraint),
    (3, behaviour.draw_machine),
    (2, behaviour.draw_state_definition),
    (2, requirements.draw_requirement_definition),
    (2, requirements.draw_requirement_usage),
    (1, requirements.draw_requirement_group),
    (1, requirements.draw_satisfaction),
    (2, requirements.draw_case),
    (1, requirements.draw_view),
)
_LINES = (15, 40)
"""Least and greatest number of lines at which drawing ends, without changes of the layout."""


def draw_text(random: Random) -> str:
    """Return a valid text of SysML v2 with some 20 to 60 lines."""
    draft = Draft(random)
    packages: list[Package] = []
    count = random.randint(1, 3)
    for lines in [random.randint(*_LINES) // count] * count:
        packages.append(_draw_package(draft, packages, lines))
    return lay_out("\n".join(_write_package(draft, package) for package in packages) + "\n", random)


def _draw_package(draft: Draft, earlier: list[Package], lines: int) -> Package:
    draft.package = Package((draft.draw_name(),))
    for library in ("ScalarValues", "ISQ", "SI", "SysML"):
        if draft.is_drawn(0.5):
            draft.package.libraries.add(library)
            visibility = draft.choose(["private", "private", "public", "protected"])
            draft.add_member(f"{visibility} import {library}::*;")
    for package in earlier:
        _draw_import(draft, package)
    drawers = [drawer for weight, drawer in _DRAWERS for _ in range(weight)]
    while sum(text.count("\n") + 1 for text in draft.package.members) < lines:
        draft.choose(drawers)(draft)
    if draft.is_drawn(0.2):
        draft.add_member(f"package {draft.draw_name()} {{ doc /* nested */ }}")
    if draft.is_drawn(0.3):
        # The order of members means nothing in a package.
        draft.random.shuffle(draft.package.members)
    return draft.package


def _draw_import(draft: Draft, package: Package) -> None:
    """Draw an import of an earlier package, of some of its members, or an alias for one."""
    own = [definition for definition in draft.definitions if definition.package is package]
    path = "::".join(package.path)
    visibility = draft.choose(["private", "private", "public", "protected"])
    form = draft.choose(
        ["all", "members", "some", "recursive", "filter", "everything", "alias", ""]
    )
    visible = [definition for definition in own if not definition.is_private]
    suffix = {
        "members": "*",
        "recursive": "**",
        "filter": "*[@SysML::PartDefinition]",
        "everything": "*::**",
    }
    if form == "all":
        draft.add_member(f"{visibility} import all {path}::*;")
    elif form in suffix:
        draft.add_member(f"{visibility} import {path}::{suffix[form]};")
        if form == "filter":
            visible = [d for d in visible if d.kind == "part def" or d.kind == "assembly part def"]
    elif form == "some":
        visible = draft.random.sample(visible, min(2, len(visible)))
        for definition in visible:
            name = draft.choose([definition.name, definition.short_name or definition.name])
            draft.add_member(f"{visibility} import {path}::{name};")
    elif form == "alias":
        visible = draft.random.sample(visible, min(2, len(visible)))
        for definition in visible:
            alias = draft.draw_name()
            draft.add_member(f"alias {alias} for {path}::{definition.name};")
            draft.package.aliases[definition] = [alias]
        return
    else:
        return
    for definition in visible:
        draft.package.aliases[definition] = [definition.name]


def _write_package(draft: Draft, package: Package) -> str:
    keyword = draft.choose(["package", "package", "library package", "package"])
    return draft.make_block(f"{keyword} {package.path[-1]}", package.members)


def lay_out(text: str, random: Random) -> str:
    """Change the white space between tokens, and insert notes, in some texts."""
    if random.random() < 0.6:
        return text
    pieces = []
    for piece in split_pieces(text):
        if piece.isspace() and not is_comment(piece):
            drawn = random.random()
            if drawn < 0.1:
                piece += random.choice([" ", "\t", "\n", "\r\n", "\n\n"])
            elif drawn < 0.13:
                piece = random.choice([" // note; }\n", " //* a note\n { */ "])
        pieces.append(piece)
    return "".join(pieces)
