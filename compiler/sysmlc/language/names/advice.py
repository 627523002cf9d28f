"""What may help with a name that leads nowhere: another kind, not visible, misspelt, elsewhere."""

from typing import TYPE_CHECKING

from sysmlc.language.metaclasses import is_a
from sysmlc.language.names import contexts
from sysmlc.language.names.lookup import Lookup
from sysmlc.language.tree import Node, Relation
from sysmlc.suggest import did_you_mean

if TYPE_CHECKING:
    from sysmlc.language.names.model import Model

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
    model: "Model",
    relation: Relation,
    names: tuple[str, ...],
    start: contexts.Start,
    within: Node | None,
) -> str:
    """One sentence for the help of the message; ``within`` is the element before a dot."""
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
    package = _elsewhere(model, relation, names, start) if within is None else None
    if package is not None:
        return f"'{names[0]}' is in '{package.name}', which is not imported here"
    if relation.kind in _IMPORTED and lookup.search(start, names[:1], None) is None:
        around = _around(start)
        near = [p.name for p in model.packages() if p.name and p not in around]
        said = did_you_mean(names[0], near) if near else ""
        return said if said.startswith("did you mean") else _NOT_GIVEN
    known = _known(lookup, names, start, within)
    roots = [p.name for p in model.packages() if p.name] if len(names) > 1 else []
    return did_you_mean(names[-1], known or roots) if known or roots else _UNNAMED


_IMPORTED = frozenset({"importedNamespace", "importedMembership"})
_NOT_GIVEN = "give the file that has it as an input too, or the folder of all files"
_UNNAMED = "declare it, or import the package that has it"


def _elsewhere(
    model: "Model", relation: Relation, names: tuple[str, ...], start: contexts.Start
) -> Node | None:
    """A package of the model or of a library file in use that has the name.

    What a connector joins or a usage references is never in the library: a unit 'b' is not meant.
    """
    if len(names) > 1:
        return None
    is_own = relation.kind == "ReferenceSubsetting"
    around = _around(start)
    for package in model.own_packages() if is_own else model.packages():
        if package not in around and any(
            h.visibility in ("", "public") for h in model.lookup.owned(package).get(names[0], ())
        ):
            return package
    return None


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
        hits = (lookup.own(general, names[0]) for general in lookup.reached(start.scope))
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
