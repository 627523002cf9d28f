"""Packages and definitions, and usages that stand for themselves in a package."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes
from sysmlc.frontends.sysml.kinds import CLASSIFIERS, MARKED
from sysmlc.frontends.sysml.levels import give_levels, is_of_recipes
from sysmlc.frontends.sysml.libraries import FILES, READ
from sysmlc.frontends.sysml.measures import give_measures, is_measured
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.language.tree import Node, Reference

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_GENERALS = ("Subclassification", "Specialization", "Subsetting", "FeatureTyping", "Redefinition")


def package(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A package with its members; our own libraries and stand-ins are no part of the model."""
    is_ours = node.name in FILES and node.kind == "LibraryPackage"
    if owner is None and is_ours and node.name not in READ:
        low.external(node)
        return
    inside = [one for one in node.members if not one.kind.endswith("Import")]
    if owner is None and inside and all(map(_is_outside, inside)):
        low.external(node)
        return
    kind, subkind = marked(node, Kind.PACKAGE)
    said = visibility(node) | told(node)
    if inside and all(map(outside, inside)):
        said["external"] = True
    made = low.add(node, kind, nodes.name_of(node), owner, subkind=subkind, **said)
    low.lower_all(node.members, made)


def _is_outside(node: Node) -> bool:
    """Whether a definition stands for what no file of the model has."""
    return annotations.is_stand_in(node) and node.kind == "MetadataDefinition"


def marked(node: Node, kind: Kind) -> tuple[Kind, str]:
    """Kind and subkind of an element, as metadata of ours says; else ``kind``."""
    if not annotations.ours(node):
        return kind, ""
    name = annotations.said(node, "Kind", "name") or annotations.said(node, "AutomationML", "kind")
    if isinstance(name, str) and name in MARKED:
        return MARKED[name], ""
    return kind, str(name or "")


def visibility(node: Node) -> dict[str, AttrValue]:
    """The attribute for a visibility that is not public."""
    return {"visibility": node.visibility} if node.visibility in ("private", "protected") else {}


def outside(node: Node) -> dict[str, AttrValue]:
    """What metadata says of an element that no file of the model has."""
    href = annotations.said(node, "External", "href")
    return {"external": True, "href": href} if href else {}


_AML = {
    "dataType": "data_type",
    "unit": "unit",
    "category": "category",
    "semantics": "semantics",
    "version": "version",
    "changeMode": "change_mode",
    "copyright": "copyright",
    "ppr": "ppr",
    "associatedFacet": "associated_facet",
    "defaultValue": "default_value",
}


def told(node: Node) -> dict[str, AttrValue]:
    """What metadata says of an element of another model."""
    return outside(node) | _of_aml(node) if annotations.ours(node) else {}


def _of_aml(node: Node) -> dict[str, AttrValue]:
    """What metadata says of an element of AutomationML."""
    one = annotations.ours(node).get("AutomationML")
    if one is None:
        return {}
    known = dict(annotations.constants_of(one))
    found = {_AML[key]: value for key, value in known.items() if key in _AML}
    if isinstance(found.get("semantics"), str):
        found["semantics"] = (found["semantics"],)
    return found


def variant(node: Node) -> dict[str, AttrValue]:
    """Whether there is a choice, whether it is a choice, and which portion of a life it is."""
    if not node.attributes and node.membership != "VariantMembership":
        return {}
    return {
        "variation": bool(node.attributes.get("isVariation")),
        "variant": node.membership == "VariantMembership",
        "portion": str(node.attributes.get("portionKind") or ""),
    }


def flags(node: Node) -> dict[str, AttrValue]:
    """What the prefixes of a declaration say."""
    return {
        "abstract": bool(node.attributes.get("isAbstract")),
        **variant(node),
        "individual": bool(node.attributes.get("isIndividual")),
        **visibility(node),
        **told(node),
    }


def classifier(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A definition whose members are features."""
    kind, role = CLASSIFIERS[node.kind]
    define(low, node, owner, kind, role)


def item(low: "Lowering", node: Node, owner: Element | None) -> None:
    """An item definition: a signal when it is sent, received or said of nothing else."""
    is_signal = id(node) in low.accepted
    kind, role = (Kind.SIGNAL, "") if is_signal else (Kind.CLASS, "block")
    define(low, node, owner, kind, role)


def occurrence(low: "Lowering", node: Node, owner: Element | None) -> None:
    """An occurrence definition: an interaction when it has lifelines or messages, else a class."""
    is_interaction = any(map(_is_of_interaction, node.members))
    kind = Kind.INTERACTION if is_interaction else Kind.CLASS
    define(low, node, owner, kind, "")


def _is_of_interaction(node: Node) -> bool:
    return nodes.is_message(node) or node.kind == "EventOccurrenceUsage"


def define(
    low: "Lowering", node: Node, owner: Element | None, kind: Kind, role: str, **attrs: AttrValue
) -> Element:
    """The element of a definition with its generals and its members."""
    kind, subkind = marked(node, kind)
    domain = annotations.said(node, "Kind", "domain")
    given: dict[str, AttrValue] = {"role": role, "subkind": subkind, "domain": domain}
    made = low.add(node, kind, nodes.name_of(node), owner, **(given | flags(node) | attrs))
    if kind is Kind.DATA_TYPE:
        give_measures(low, node, made)
    generalize(low, node, made)
    low.lower_all(nodes.body_of(node), made)
    return made


def generalize(low: "Lowering", node: Node, made: Element) -> None:
    """Edges to the general classifiers; quantities and recipe levels are told otherwise."""
    if not node.relations:
        return
    give_levels(low, node, made)
    for found in nodes.references(node, *_GENERALS):
        if (target := found.target) is not None and is_of_recipes(target):
            continue
        if made.kind is not Kind.DATA_TYPE or not is_measured(found):
            low.later(lambda found=found: _general(low, made, found))  # type: ignore[misc]


def _general(low: "Lowering", made: Element, found: Reference) -> None:
    target = found.target
    if target is not None and low.element(target) is made:
        return
    low.lead(Edge.SPECIALIZES, made, target)
