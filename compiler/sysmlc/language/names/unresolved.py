"""Diagnostics about names that lead nowhere, with advice."""

import re

from sysmlc.diagnostics import Sink, Subject
from sysmlc.language.metaclasses import is_a, kinds_of
from sysmlc.language.names import contexts
from sysmlc.language.names.expression_results import result
from sysmlc.language.names.generals import GENERAL
from sysmlc.language.names.lookup import Lookup
from sysmlc.language.names.model import Model
from sysmlc.language.names.rules import TOO_CIRCULAR, UNRESOLVED
from sysmlc.language.tree import Document, Node, Reference, Relation, locate
from sysmlc.support.suggestions import did_you_mean

_WANTED = {
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


def advice(
    model: Model,
    user: tuple[Node, Relation],
    names: tuple[str, ...],
    start: contexts.Start,
    within: Node | None,
) -> str:
    """One sentence for the help of the message; ``within`` is the element before a dot."""
    relation = user[1]
    lookup = model.lookup
    other = _search(lookup, names, start, within, everything=False)
    if other is not None and relation.kind in _WANTED:
        return f"'{names[-1]}' is {kind_of(other)}, {_WANTED[relation.kind]} is needed here"
    hidden = _search(lookup, names, start, within, everything=True)
    if hidden is not None and hidden.visibility in ("private", "protected"):
        owner = f" in '{hidden.owner.name}'" if hidden.owner and hidden.owner.name else ""
        return f"'{names[-1]}' is {hidden.visibility}{owner}"
    if hidden is not None and other is None:
        return f"'{names[-1]}' is there by a private import only"
    package = _elsewhere(model, user, names, start) if within is None else None
    if package is not None:
        return _not_imported(names[0], package, lookup, start)
    if relation.kind in _IMPORTED and lookup.search(start, names[:1], None) is None:
        around = {one.name for one in _around(start)}
        near = [name for name in model.packages() if name not in around]
        said = did_you_mean(names[0], near) if near else ""
        return said if said.startswith("did you mean") else _NOT_GIVEN
    known = _known(lookup, names, start, within)
    roots = model.packages() if len(names) > 1 else []
    return did_you_mean(names[-1], known or roots) if known or roots else _UNNAMED


_IMPORTED = frozenset({"importedNamespace", "importedMembership"})
_NOT_GIVEN = "give the file that has it as an input too, or the folder of all files"
_UNNAMED = "declare it, or import the package that has it"


_TYPES_OF_LIBRARY = ("ScalarValues", "ISQ")
_UNITS_OF_LIBRARY = ("SI",)
_CLASSIFIERS = kinds_of("Classifier")


def _elsewhere(
    model: Model, user: tuple[Node, Relation], names: tuple[str, ...], start: contexts.Start
) -> Node | None:
    """A package of the model or of the library that has the name, and something of that kind.

    In the library only types and units are looked for: no step or part 'b' means the unit bel.
    """
    if len(names) > 1:
        return None
    node, relation = user
    around = _around(start)
    wanted = contexts.WANTED.get(relation.kind)
    for package in model.own_packages():
        if package not in around and _has(model.lookup, package, names[0], wanted):
            return package
    if relation.kind == "FeatureTyping":
        return _of_library(model, names[0], _TYPES_OF_LIBRARY, _CLASSIFIERS)
    if relation.kind == "Membership" and _is_unit(node):
        return _of_library(model, names[0], _UNITS_OF_LIBRARY, None)
    return None


def _is_unit(node: Node) -> bool:
    """Whether an expression stands in the brackets of a quantity."""
    while node.owner is not None and node.owner.kind in _OPERATORS:
        if node.owner.attributes.get("operator") == "[":
            return node is not node.owner.members[0]
        node = node.owner
    return False


_OPERATORS = frozenset({"OperatorExpression"})


def _of_library(
    model: Model, name: str, packages: tuple[str, ...], wanted: frozenset[str] | None
) -> Node | None:
    """A package of the library that gives the name: first those through which others are seen."""
    for through in packages:
        package, found = model.find(through), model.find(f"{through}::{name}")
        if found is not None and (wanted is None or found.kind in wanted):
            return package
    for package in model.library.packages(name) if wanted is not None else ():
        if package.name and _has(model.lookup, package, name, wanted):
            return package
    return None


def _has(lookup: Lookup, package: Node, name: str, wanted: frozenset[str] | None) -> bool:
    """Whether a package owns something by the name that others see."""
    for hit in lookup.owned(package).get(name, ()):
        element = lookup.element(hit)
        is_wanted = element is not None and (wanted is None or element.kind in wanted)
        if is_wanted and hit.visibility in ("", "public"):
            return True
    return False


def _not_imported(name: str, package: Node, lookup: Lookup, start: contexts.Start) -> str:
    """How to come by a name of a package; one imported itself does not bring its members."""
    for scope in _around(start):
        for one in lookup.imports(scope):
            if one.kind in _MEMBERS and any(
                lookup.target(one, relation) is package for relation in one.relations
            ):
                return f"'{name}' is in '{package.name}': import {package.name}::*, not it alone"
    return f"'{name}' is in '{package.name}', which is not imported here"


_MEMBERS = kinds_of("MembershipImport")


def _search(
    lookup: Lookup,
    names: tuple[str, ...],
    start: contexts.Start,
    within: Node | None,
    *,
    everything: bool,
) -> Node | None:
    if within is not None:
        return lookup.descend(within, names, 0, None, everything)
    if everything and start.inherited and start.scope is not None:
        hits = (lookup.own_members(general, names[0]) for general in lookup.reached(start.scope))
        return next((hit for found in hits for hit in found), None)
    return lookup.search(start._replace(everything=everything), names, None)


def _known(
    lookup: Lookup, names: tuple[str, ...], start: contexts.Start, within: Node | None
) -> list[str]:
    """Names that would be known instead: in what the name before leads to, else around."""
    if within is None and len(names) > 1:
        within = lookup.search(start, names[:-1], None)
    if within is None and start.inherited and start.scope is not None:
        scopes = lookup.reached(start.scope)
    elif within is not None:
        scopes = [within, *lookup.reached(within)]
    else:
        scopes = _around(start)
    return [name for scope in scopes for name in lookup.owned(scope) if name != names[-1]]


def _around(start: contexts.Start) -> list[Node]:
    """The namespaces in which a name is looked up, the nearest first."""
    scopes = []
    scope = start.scope
    while scope is not None:
        scopes.append(scope)
        scope = contexts.outer(scope)
    return scopes


def kind_of(node: Node) -> str:
    """The kind of an element in words: ``a part definition``."""
    if is_a(node.kind, "Package"):
        return "a package"
    words = "".join(f" {c.lower()}" if c.isupper() else c for c in node.kind).strip()
    words = words.removesuffix(" usage")
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"


_NAME = r"(?:'(?:[^'\\]|\\.)*'|[\w$~]+)"
_LINK = re.compile(rf"{_NAME}(?:\s*::\s*{_NAME})*")
"""A qualified name, one link of a chain."""


def report(model: Model, document: Document, node: Node, relation: Relation, sink: Sink) -> None:
    """Report the first name of a chain that was not found."""
    lookup = model.lookup
    reference = relation.reference
    index = len(reference.targets or ())
    start = contexts.start(node, relation)
    before = _before(node, lookup, reference, start)
    if before is None and (index or start.operand is not None or start.before is not None):
        return
    if _is_incomplete(before or (start.scope if start.inherited else None), lookup):
        return
    name = "::".join(reference.chain[index])
    if reference in lookup.given_up:
        sink.report(
            TOO_CIRCULAR, subject(document, node, _place(document, reference, index)), name=name
        )
        return
    inside = f" in '{before.name}'" if before is not None and before.name else ""
    sink.report(
        UNRESOLVED,
        subject(document, node, _place(document, reference, index)),
        name=name,
        inside=inside,
        advice=advice(model, (node, relation), reference.chain[index], start, before),
    )


def _before(node: Node, lookup: Lookup, reference: Reference, start: contexts.Start) -> Node | None:
    """The element in which the name that was not found should be, if it is not a scope."""
    if reference.targets:
        return reference.targets[-1]
    if start.operand is not None:
        return result(start.operand, lookup)
    return lookup.target(node, start.before) if start.before is not None else None


def _is_incomplete(scope: Node | None, lookup: Lookup) -> bool:
    """Whether a general of ``scope`` was not found: the name may come from it, once is enough."""
    waiting = [scope] if scope is not None else []
    seen = set(waiting)
    while waiting:
        node = waiting.pop()
        for relation in node.relations:
            if relation.kind in GENERAL:
                general = lookup.target(node, relation)
                if general is None:
                    return True
                if general not in seen:
                    seen.add(general)
                    waiting.append(general)
    return False


def _place(document: Document, reference: Reference, index: int) -> int:
    """Where the link of a chain stands that was not found."""
    if index == 0 or reference.start < 0:
        return reference.start
    links = list(_LINK.finditer(document.text, reference.start, reference.end))
    return links[index].start() if index < len(links) else reference.start


def subject(document: Document, node: Node, start: int) -> Subject:
    """The element, and the place of a name in it or, where that is not known, its own."""
    return Subject(node.name or "", place=locate(document, start if start >= 0 else node.start))
