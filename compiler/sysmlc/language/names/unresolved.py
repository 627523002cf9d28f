"""Diagnostics about names that cannot be resolved, each with one sentence of advice."""

import re
from functools import cache
from typing import NamedTuple

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.language.metaclasses import FEATURES, describe_kind, kinds_of
from sysmlc.language.names import contexts
from sysmlc.language.names.expression_results import find_result
from sysmlc.language.names.generals import GENERALIZATION_KINDS
from sysmlc.language.names.lookup import Lookup
from sysmlc.language.names.model import Model
from sysmlc.language.text import parse
from sysmlc.language.text.hints import NOTE, find_type
from sysmlc.language.text.spelling import quote_name
from sysmlc.language.tree import Document, Node, Reference, Relation, make_subject
from sysmlc.support import resources
from sysmlc.support.suggestions import find_similar
from sysmlc.support.units import find_unit


def find_unit_name(model: Model, name: str) -> str:
    """Return the qualified name of the unit that users write as *name*, or nothing.

    SI of the standard library lacks some units of plants, which the library of sysmlc has.
    """
    unit = find_unit(name)
    symbol = name if unit is None else unit.symbol
    for candidate in (name, symbol, symbol.replace("·", "⋅")):
        if model.find(f"SI::{candidate}") is not None:
            return f"SI::{quote_name(candidate)}"
        if candidate in _list_shipped_units():
            return f"SysMLC::Units::{quote_name(candidate)}"
    return ""


@cache
def _list_shipped_units() -> frozenset[str]:
    """Return the symbols in the package of units that every model may use."""
    text = resources.read_text("metamodels", "SysMLC.sysml")
    root = parse(text, "SysMLC.sysml", "sysml", Sink()).root
    units = next(node for node in root.walk() if node.name == "Units")
    return frozenset(str(unit.short_name or unit.name) for unit in units.members)


UNRESOLVED = rule(
    "SM205", "unresolved-name", Severity.ERROR, "unknown name '{name}'{inside}", help="{advice}"
)
TOO_CIRCULAR = rule(
    "SM240",
    "names-too-circular",
    Severity.ERROR,
    "the search for '{name}' was abandoned after 2,000 cycles of names",
    help="rename the elements that share this name, or qualify the names of their general types",
)

_EXPECTED_WORDS = {
    "Subclassification": "a definition",
    "FeatureTyping": "a definition",
    "ConjugatedPortTyping": "a port definition",
    "Specialization": "a type",
    "Conjugation": "a type",
    "Subsetting": "a usage or feature",
    "Redefinition": "a usage or feature",
    "ReferenceSubsetting": "a usage or feature",
    "CrossSubsetting": "a usage or feature",
    "FeatureChaining": "a usage or feature",
    "importedNamespace": "a namespace",
}
_MAX_ADVICE_FROM_IMPORTS = 50
"""Diagnostics of a unit after which names of imported packages are no longer suggested."""
_MAX_SIMILAR_NAMES = 50
"""Diagnostics of a unit after which no similar names are searched, each among all names."""
_NOT_GIVEN = "give the file that has it as an input too, or the folder of all files"
_UNKNOWN = "declare it, import the package that has it, or give its file as an input too"
_NOT_INHERITED = "only an inherited feature can be redefined: declare it in a general type"
_SYNTAX_ERRORS = ("SM192", "SM194", "SM195")
"""Rules of the parser whose finding about a word includes that the word is no known name."""
_LITERALS = {"True": "true", "False": "false"} | dict.fromkeys(
    ("None", "NULL", "Null", "nil", "nullptr", "undefined"), "null"
)
"""Literals of other languages."""
_NOTE_SIGNS = ("# ", "#\t")
"""Signs before a note of another language, ``# the plant;``, which reads as metadata."""
_MAX_LISTED = 7
"""Names of the members of an element that are listed in place of a similar name."""
_TYPES_OF_LIBRARY = ("ScalarValues", "ISQ")
_CLASSIFIERS = kinds_of("Classifier")
_OPERATORS = frozenset({"OperatorExpression"})
_PACKAGES = kinds_of("Package")
_MEMBERSHIP_IMPORTS = kinds_of("MembershipImport")


class _UnknownName(NamedTuple):
    """A name that was not found, by its parts, and where it was looked up.

    ``container`` is the element before a dot. ``reported`` is the number of diagnostics before this
    one: the search of the first is longest.
    """

    model: Model
    node: Node
    relation: Relation
    names: tuple[str, ...]
    context: contexts.LookupContext
    container: Node | None
    reported: int

    @property
    def searches_imports(self) -> bool:
        """Whether the names of imported packages are compared: libraries have thousands."""
        return self.reported < _MAX_ADVICE_FROM_IMPORTS


def _make_advice(use: _UnknownName) -> str:
    """Return the help for a name that is not found."""
    model, names = use.model, use.names
    obstacle = _explain_obstacle(use)
    if obstacle:
        return obstacle
    if use.container is None:
        package = _find_unimported_package(use)
        if package is not None:
            return _advise_import(names[0], package, model.lookup, use.context)
    unknown, container = _find_unknown_part(use)
    if use.relation.kind in contexts.IMPORTED and container is None:
        scope_names = {scope.name for scope in contexts.list_scopes(use.context)}
        packages = [name for name in model.packages() if name not in scope_names]
        similar = find_similar(unknown, packages) if use.reported < _MAX_SIMILAR_NAMES else ""
        return f"did you mean '{similar}'?" if similar else _NOT_GIVEN
    known_names: list[str] = []
    if use.reported < _MAX_SIMILAR_NAMES:
        known_names = _list_known_names(use, unknown, container)
        is_qualifier = container is None and unknown != names[-1]
        known_names += model.packages() if is_qualifier else []
    similar = _name_in_library(use) or find_similar(unknown, known_names)
    if similar:
        quoted = similar if "'" in similar else f"'{similar}'"
        return f"did you mean {quoted}?"
    if container is not None and container.name:
        return _advise_declaration(model, container, known_names)
    return _NOT_INHERITED if use.context.inherited else _UNKNOWN


def _explain_obstacle(use: _UnknownName) -> str:
    """Return why an element that has the name cannot be used here, or nothing if none has it."""
    last, relation = use.names[-1], use.relation
    of_other_kind = _search_regardless(use, everything=False)
    if of_other_kind is not None and relation.kind in _EXPECTED_WORDS:
        kind, expected = describe_kind(of_other_kind), _EXPECTED_WORDS[relation.kind]
        advice = f"'{last}' is {kind}, {expected} is needed here"
        chain = relation.reference.chain
        if len(chain) > 1 and of_other_kind.kind in _PACKAGES:
            joined = "::".join(name for link in chain for name in link)
            return f"names of packages are joined by '::': {joined}"
        keyword, definition, _ = kind.partition(" ")[2].partition(" definition")
        # 'satisfy R' refers to a usage; 'satisfy requirement : R' declares one.
        declares = definition and relation.kind == "ReferenceSubsetting"
        return f"{advice}; write '{keyword} : {last}'" if declares else advice
    private = _explain_privacy(use)
    if private and of_other_kind is None:
        return private
    hidden = _search_regardless(use, everything=True)
    if hidden is not None and hidden.visibility in ("private", "protected"):
        owner = f" in '{hidden.owner.name}'" if hidden.owner and hidden.owner.name else ""
        return f"'{last}' is {hidden.visibility}{owner}"
    if hidden is not None and of_other_kind is None:
        return f"'{last}' is there by a private import only"
    return ""


def _explain_privacy(use: _UnknownName) -> str:
    """Return that the first unknown part is private where it would be found, or nothing."""
    lookup = use.model.lookup
    unknown, container = _find_unknown_part(use)
    scopes = [] if container is None else [container, *lookup.known_ancestors(container)]
    if container is None and use.searches_imports:
        scopes = lookup.list_imported_namespaces(contexts.list_scopes(use.context))
    for scope in scopes:
        for hit in lookup.symbol_table(scope).get(unknown, ()):
            if hit.visibility in ("private", "protected") and scope.name:
                return f"'{unknown}' is {hit.visibility} in '{scope.name}'"
    return ""


def _find_unknown_part(use: _UnknownName) -> tuple[str, Node | None]:
    """Return the first part of a qualified name that is unknown, and the element before it."""
    container = use.container
    for count, name in enumerate(use.names[:-1], start=1):
        part = use._replace(names=use.names[:count], container=container)
        element = _search_regardless(part, everything=False)
        if element is None:
            return name, container
        container = element
    return use.names[-1], container


def _advise_declaration(model: Model, container: Node, known_names: list[str]) -> str:
    """Return what to do about a name that is unknown in an element and like none of its names."""
    if model.document(container) not in model.documents:
        return f"'{container.name}' of the library has no such name"
    # A feature usually has its members from its type.
    types = model.types(container) if container.kind in FEATURES else []
    own_types = (type_ for type_ in types if model.document(type_) in model.documents)
    place = next(own_types, container)
    listed = sorted(set(known_names))
    others = f", which has: {', '.join(listed)}" if 0 < len(listed) <= _MAX_LISTED else ""
    return f"declare it in '{place.name or container.name}'{others}"


def _find_unimported_package(use: _UnknownName) -> Node | None:
    """Return a package of the model or of the library that has the name with a suitable kind.

    In the library only types and units are considered: no step or part 'b' means the unit bel.
    """
    model, name, kind = use.model, use.names[0], use.relation.kind
    if len(use.names) > 1:
        return None
    scopes = contexts.list_scopes(use.context)
    kinds = contexts.TARGET_KINDS.get(kind)
    for package in model.find_packages_owning(name):
        if package not in scopes and _has_visible_member(model.lookup, package, name, kinds):
            return package
    if kind == "FeatureTyping":
        for package_name in _TYPES_OF_LIBRARY:
            element = model.find(f"{package_name}::{name}")
            if element is not None and element.kind in _CLASSIFIERS:
                return model.find(package_name)
        for package in model.library.packages(name):
            if package.name and _has_visible_member(model.lookup, package, name, _CLASSIFIERS):
                return package
    if kind == "Membership" and _is_unit(use.node) and model.find(f"SI::{name}") is not None:
        return model.find("SI")
    return None


def _name_in_library(use: _UnknownName) -> str:
    """Return what the libraries call a type or unit with the name of another language, or nothing.

    The name is qualified unless it is visible where it is used.
    """
    name, kind, *qualifiers = "", use.relation.kind, *use.names[:-1]
    if kind == "FeatureTyping" and qualifiers in ([], ["ScalarValues"]):
        name = find_type(use.names[-1])
    elif kind == "Membership" and use.names[0] in _LITERALS:
        return _LITERALS[use.names[0]]
    elif kind == "Membership" and qualifiers in ([], ["SI"]) and _is_unit(use.node):
        name = find_unit_name(use.model, use.names[-1])
    own_name = name.rpartition("::")[2]
    lookup = use.model.lookup
    is_visible = name and lookup.search(use.context, (own_name.strip("'"),), None) is not None
    return own_name if is_visible else name


def _is_unit(node: Node) -> bool:
    """Whether an expression is in the brackets of a quantity."""
    while node.owner is not None and node.owner.kind in _OPERATORS:
        if node.owner.attributes.get("operator") == "[":
            return node is not node.owner.members[0]
        node = node.owner
    return False


def _has_visible_member(
    lookup: Lookup, package: Node, name: str, kinds: frozenset[str] | None
) -> bool:
    """Whether a package owns a public member with the name."""
    return any(
        hit.visibility in ("", "public") and _is_of_kind(lookup, hit, kinds)
        for hit in lookup.symbol_table(package).get(name, ())
    )


def _advise_import(
    name: str, package: Node, lookup: Lookup, context: contexts.LookupContext
) -> str:
    """Return how to import a name; the import of a package alone does not bring its members."""
    for scope in contexts.list_scopes(context):
        for import_ in lookup.imports(scope):
            if import_.kind in _MEMBERSHIP_IMPORTS and any(
                lookup.target(import_, relation) is package for relation in import_.relations
            ):
                return f"'{name}' is in '{package.name}': import {package.name}::*, not it alone"
    return f"'{name}' is in '{package.name}', which is not imported here"


def _search_regardless(use: _UnknownName, *, everything: bool) -> Node | None:
    lookup, names, context = use.model.lookup, use.names, use.context
    if use.container is not None:
        return lookup.descend(use.container, names, None, everything)
    if everything and context.inherited and context.scope is not None:
        hits = (
            lookup.own_members(general, names[0])
            for general in lookup.known_ancestors(context.scope)
        )
        return next((hit for members in hits for hit in members), None)
    return lookup.search(context._replace(everything=everything), names, None)


def _list_known_names(use: _UnknownName, unknown: str, container: Node | None) -> list[str]:
    """Return the names of elements of the kind that is needed.

    After a dot these are members of the element before it, else names in the scopes around and in
    the packages that they import. In the brackets of a quantity the units of SI are valid, too.
    """
    model, lookup, context = use.model, use.model.lookup, use.context
    if container is None and context.inherited and context.scope is not None:
        scopes = lookup.known_ancestors(context.scope)
    else:
        starts = contexts.list_scopes(context) if container is None else [container]
        scopes = [*starts]
        if container is not None:
            scopes += lookup.known_ancestors(container)
        if use.searches_imports:
            scopes += lookup.list_imported_namespaces(starts)
        if use.searches_imports and container is None and _is_unit(use.node):
            scopes += filter(None, [model.find("SI")])
    kind = use.relation.kind
    is_last = unknown == use.relation.reference.chain[-1][-1]
    kinds = contexts.TARGET_KINDS.get(kind) if is_last else None
    if kinds is not None and kind == "FeatureTyping":
        kinds = _CLASSIFIERS
    return [
        name
        for scope in scopes
        for name, hits in lookup.symbol_table(scope).items()
        if name != unknown
        and use.node not in hits
        and (kinds is None or any(_is_of_kind(lookup, hit, kinds) for hit in hits))
    ]


def _is_of_kind(lookup: Lookup, hit: Node, kinds: frozenset[str] | None) -> bool:
    element = lookup.resolve_alias(hit)
    return element is not None and (kinds is None or element.kind in kinds)


_NAME = r"(?:'(?:[^'\\]|\\.)*'|[\w$~]+)"
_LINK = re.compile(rf"{_NAME}(?:\s*::\s*{_NAME})*")
"""A qualified name: one link of a feature chain."""


def report_unresolved(
    model: Model, document: Document, node: Node, relation: Relation, sink: Sink
) -> None:
    """Report the first name of a chain that was not found."""
    lookup = model.lookup
    reference = relation.reference
    index = len(reference.targets or ())
    context = contexts.find_context(node, relation)
    container = _find_containing(node, lookup, reference, context)
    # The element before the dot is unknown or reported, so this name cannot be judged.
    if container is None and (index or context.operand is not None or context.before is not None):
        return
    # A general that cannot be resolved may have the name; it is reported itself.
    if _is_incomplete(container or (context.scope if context.inherited else None), lookup):
        return
    name = "::".join(reference.chain[index])
    subject = make_subject(document, node, _find_link_offset(document, reference, index))
    # The name may exist, so "unknown name" would be wrong.
    if reference in lookup.circular_references:
        sink.report(TOO_CIRCULAR, subject, cause=f"circular name {name}", name=name)
        return
    inside = f" in '{container.name}'" if container is not None and container.name else ""
    # A keyword in place of the name, or a stray word that is read as an expression.
    if sink.has_reported(_SYNTAX_ERRORS, subject.place):
        return
    names = reference.chain[index]
    use = _UnknownName(model, node, relation, names, context, container, len(sink))
    advice = _make_advice(use)
    is_quoted = reference.start >= 0 and document.text.startswith("'", reference.start)
    if advice == _UNKNOWN and is_quoted and relation.kind == "Membership":
        advice = f'{advice}; a string stands in double quotes: "{name}"'
    elif advice == _UNKNOWN and document.text.endswith(_NOTE_SIGNS, 0, max(reference.start, 0)):
        advice = NOTE
    cause = f"unknown name {name}{inside}"
    sink.report(UNRESOLVED, subject, cause=cause, name=name, inside=inside, advice=advice)


def _find_containing(
    node: Node, lookup: Lookup, reference: Reference, context: contexts.LookupContext
) -> Node | None:
    """Return the element that should have the name that was not found, unless it is a scope."""
    if reference.targets:
        return reference.targets[-1]
    if context.operand is not None:
        return find_result(context.operand, lookup)
    return lookup.target(node, context.before) if context.before is not None else None


def _is_incomplete(scope: Node | None, lookup: Lookup) -> bool:
    """Whether ``scope`` has an unresolved general.

    That general may have the missing name, and is itself reported as unresolved.
    """
    worklist = [scope] if scope is not None else []
    seen = set(worklist)
    while worklist:
        node = worklist.pop()
        for relation in node.relations:
            if relation.kind in GENERALIZATION_KINDS:
                general = lookup.target(node, relation)
                if general is None:
                    return True
                if general not in seen:
                    seen.add(general)
                    worklist.append(general)
    return False


def _find_link_offset(document: Document, reference: Reference, index: int) -> int:
    """Return the offset of the link of a chain that was not found."""
    if index == 0 or reference.start < 0:
        return reference.start
    links = list(_LINK.finditer(document.text, reference.start, reference.end))
    return links[index].start() if index < len(links) else reference.start
