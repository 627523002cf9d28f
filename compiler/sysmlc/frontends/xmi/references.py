"""Children with ``xmi:idref`` or ``href``: edges, attributes with ids, or contained elements."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import papyrus
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.ir import Element


def is_reference(context: Context, row: int) -> bool:
    """Whether the row refers to an element instead of defining one."""
    attributes = context.document.attributes[row]
    return "href" in attributes or context.document.idref_key in attributes


def lower_reference(context: Context, row: int) -> int:
    """Lower a row that refers to an element; return the row after its content."""
    document = context.document
    end = context.mark_subtree(row, Verdict.MAPPED)
    for child in document.children(row):
        context.mark_subtree(child, Verdict.IGNORED_NOTATION)
    feature, parent = document.features[row], document.parents[row]
    owner = context.find_owner(row)
    href = document.href(row)
    reference = WrittenReference(href or document.idref(row), row, bool(href))
    if owner is not None and papyrus.is_contained_href(document, row):
        context.verdicts[row] = Verdict.EXTERNAL
        context.contained_hrefs.append(row)
    elif owner is None or feature in ("packagedElement", "nestedPackage"):
        context.verdicts[row] = Verdict.EXTERNAL if href else Verdict.MAPPED
    elif context.elements[parent]:
        _refer(context, owner, reference, feature)
    elif feature in v.FOLDED_REFERENCES:
        context.add_reference(v.FOLDED_REFERENCES[feature], owner.id, reference, feature)
    elif not href:
        context.defer_check(parent, feature, reference.target)
    return end


def _refer(context: Context, owner: Element, reference: WrittenReference, feature: str) -> None:
    target, row, is_href = reference
    edge = v.REFERENCES_BY_KIND.get((owner.kind, feature)) or v.REFERENCES.get(feature)
    reversed_edge = v.REVERSED.get((owner.kind, feature))
    if edge is not None:
        context.add_reference(edge, owner.id, reference, feature)
    elif reversed_edge is not None:
        context.add_reference(reversed_edge, owner.id, reference, feature, is_reversed=True)
    elif feature in v.CONDITIONS:
        context.defer_conditions([target], feature)
    elif feature in v.REDUNDANT:
        if not is_href:
            context.defer_check(context.document.parents[row], feature, target)
    elif feature not in ("partWithPort", "guard", "event"):
        _store_ids(context, owner, reference, feature)


def _store_ids(context: Context, owner: Element, reference: WrittenReference, feature: str) -> None:
    key = v.to_snake_case(feature)
    if reference.is_href:
        context.defer_ids(owner, key, [reference.target], is_href=True)
    elif feature not in ("sendEvent", "receiveEvent"):
        parent = context.document.parents[reference.row]
        context.defer_ids(owner, key, context.document.targets(parent, feature))
