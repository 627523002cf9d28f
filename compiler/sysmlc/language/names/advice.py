"""What may help with a name that leads nowhere: another kind, not visible, misspelt, elsewhere."""

from collections.abc import Iterable

from sysmlc.language.metaclasses import is_a
from sysmlc.language.names import contexts
from sysmlc.language.names.lookup import Lookup
from sysmlc.language.tree import Node, Relation
from sysmlc.suggest import did_you_mean

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
    lookup: Lookup,
    relation: Relation,
    names: tuple[str, ...],
    start: contexts.Start,
    within: Node | None,
) -> str:
    """One sentence for the help of the message; ``within`` is the element before a dot."""
    other = _search(lookup, names, start, within, everything=False)
    if other is not None and relation.kind in _WANTED:
        return f"'{names[-1]}' is {kind_of(other)}, {_WANTED[relation.kind]} is needed here"
    hidden = _search(lookup, names, start, within, everything=True)
    if hidden is not None and hidden.visibility in ("private", "protected"):
        owner = f" in '{hidden.owner.name}'" if hidden.owner and hidden.owner.name else ""
        return f"'{names[-1]}' is {hidden.visibility}{owner}"
    return did_you_mean(names[-1], _known(lookup, names, start, within))


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
    return lookup.search(start._replace(everything=everything), names, None)


def _known(
    lookup: Lookup, names: tuple[str, ...], start: contexts.Start, within: Node | None
) -> Iterable[str]:
    """Names that would be known instead: in what the name before leads to, else around."""
    if within is None and len(names) > 1:
        within = lookup.search(start, names[:-1], None)
    if within is not None:
        scopes = [within, *lookup.reached(within)]
    else:
        scopes = []
        scope = start.scope
        while scope is not None:
            scopes.append(scope)
            scope = contexts.outer(scope)
    return [name for scope in scopes for name in lookup.owned(scope) if name != names[-1]]


def kind_of(node: Node) -> str:
    """The kind of an element in words: ``a part definition``."""
    if is_a(node.kind, "Package"):
        return "a package"
    words = "".join(f" {c.lower()}" if c.isupper() else c for c in node.kind).strip()
    words = words.removesuffix(" usage")
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"
