"""SysML 1.6 as Papyrus has it: where its stereotypes are, and which of them gives which role."""

import json
import re
from collections.abc import Iterator
from functools import cache

from sysmlc.backends.uml.meant import applications
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support import resources

NAMESPACE = "http://www.eclipse.org/papyrus/sysml/1.6/SysML/"
_OTHERS = re.compile(
    r"https?://www\.omg\.org/spec/SysML/|https?://www\.sparxsystems\.com/profiles/SysML"
)
"""Namespaces of SysML's stereotypes in the dialects of other tools."""
_NOT_IN_PAPYRUS = frozenset({"Unit", "QuantityKind", "Dimension", "Allocated"})
_CLASSIFIERS = {
    "block": "Block",
    "interface block": "InterfaceBlock",
    "constraint block": "ConstraintBlock",
    "requirement": "Requirement",
    "view": "View",
    "viewpoint": "Viewpoint",
    "stakeholder": "Stakeholder",
}
_BEHAVIOURS = {"test case": "TestCase", "control operator": "ControlOperator"}
_ROLES: dict[Kind, dict[str, str]] = {
    Kind.CLASS: _CLASSIFIERS,
    Kind.COMPONENT: _CLASSIFIERS,
    Kind.REQUIREMENT: {"requirement": "Requirement"},
    **dict.fromkeys(
        (Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.INTERACTION, Kind.OPERATION, Kind.TEST_CASE),
        _BEHAVIOURS,
    ),
    Kind.DATA_TYPE: {"value type": "ValueType"},
    Kind.ENUMERATION: {"value type": "ValueType"},
    Kind.PROPERTY: {"flow property": "FlowProperty"},
    Kind.FLOW_PROPERTY: {"flow property": "FlowProperty"},
    Kind.PORT: {"full port": "FullPort", "proxy port": "ProxyPort", "flow port": "FlowPort"},
    Kind.CONNECTOR: {"binding connector": "BindingConnector"},
    Kind.ITEM_FLOW: {"item flow": "ItemFlow"},
    Kind.DEPENDENCY: {
        "satisfy": "Satisfy",
        "derive": "DeriveReqt",
        "verify": "Verify",
        "copy": "Copy",
        "refine": "Refine",
        "trace": "Trace",
        "allocate": "Allocate",
        "expose": "Expose",
    },
    Kind.COMMENT: {
        "problem": "Problem",
        "rationale": "Rationale",
        "element group": "ElementGroup",
    },
    Kind.PARTITION: {"allocate partition": "AllocateActivityPartition"},
}
_PORTS = ("full port", "proxy port", "flow port")


@cache
def packages() -> dict[str, str]:
    """Package of SysML, as namespaces write it, by the name of a stereotype."""
    elements = json.loads(resources.read_text("metamodels", "libraries.json"))["elements"]
    found = {}
    for name, entry in elements.items():
        parts = name.split("::")
        if parts[0] == "SysML" and len(parts) == 3 and entry["kind"] == "Stereotype":
            found[parts[2]] = parts[1].replace("&", "And")
    return found


@cache
def bases() -> dict[str, tuple[str, ...]]:
    """Metaclasses that SysML's stereotypes extend, by the name of the stereotype."""
    elements = json.loads(resources.read_text("metamodels", "libraries.json"))["elements"]
    return {
        name.rpartition("::")[2]: tuple(entry.get("extends", ()))
        for name, entry in elements.items()
        if name.startswith("SysML::") and entry["kind"] == "Stereotype"
    }


def is_foreign(namespace: str, name: str) -> bool:
    """Whether it is a stereotype of SysML in another tool's dialect that Papyrus has too."""
    is_other = _OTHERS.match(namespace) is not None
    return is_other and name in packages() and name not in _NOT_IN_PAPYRUS


def missing(graph: Graph, element: Element) -> str:
    """The stereotype of SysML that the element's role needs and no application gives, or empty."""
    name = _ROLES.get(element.kind, {}).get(element.role, "")
    if not name or element.attrs.get("external") or _is_structural(graph, element):
        return ""
    given = {one for app in applications(graph, element) for one in _told(graph, app)}
    giving = {other for other, role in _giving(element.kind) if role == element.role}
    return "" if given & giving else name


def _told(graph: Graph, application: Element) -> tuple[str, ...]:
    """Names of the lineage that a reader of the saved model knows.

    What a stereotype in a library outside specialises, only the library says; that of SysML's
    own is known everywhere.
    """
    stereotype = graph.target(application, Edge.INSTANCE_OF)
    is_inside = stereotype is None or not stereotype.attrs.get("external")
    name = str(application.attrs.get("stereotype", ""))
    space = str(application.attrs.get("namespace", ""))
    if is_inside or space.startswith(NAMESPACE) or is_foreign(space, name):
        return lineage(application)
    return lineage(application) if "additional_stereotypes" in space else (name,)


def lineage(application: Element) -> tuple[str, ...]:
    """Names of an applied stereotype and its generals, as ``classify`` left them."""
    found = application.attrs.get("lineage")
    names = found if isinstance(found, tuple) else (application.attrs.get("stereotype", ""),)
    return tuple(re.sub(r"\W", "_", str(name)) for name in names)


def _giving(kind: Kind) -> Iterator[tuple[str, str]]:
    for role, name in _ROLES.get(kind, {}).items():
        yield name, role
    yield from (("FlowSpecification", "interface block"), ("AbstractRequirement", "requirement"))


def _is_structural(graph: Graph, element: Element) -> bool:
    """Whether ports or constraint parameters give the role again (SysML 1.6 clauses 9.3, 10.3)."""
    if element.role == "interface block":
        users = graph.sources(element, Edge.TYPED_BY)
        return any(one.role == "proxy port" for one in users)
    if element.role == "block":
        return any(one.role in _PORTS for one in graph.owned(element))
    if element.role == "binding connector":
        ends = graph.targets(element, Edge.END)
        roles = (role for end in ends for role in graph.targets(end, Edge.ROLE))
        return any(one.role == "constraint parameter" for one in roles)
    return False


def tags(graph: Graph, element: Element, name: str) -> dict[str, str | list[Element]]:
    """Tags that an application needs to say what the element's attributes say."""
    attrs = element.attrs
    if name == "Requirement":
        given = {"id": attrs.get("req_id"), "text": attrs.get("text")}
        return {key: str(value) for key, value in given.items() if value not in (None, "")}
    if name in ("FlowProperty", "FlowPort") and "direction" in attrs:
        return {"direction": str(attrs["direction"])}
    if name == "Block" and attrs.get("encapsulated"):
        return {"isEncapsulated": "true"}
    if name == "ItemFlow":
        item = graph.get(str(attrs.get("item_property", "")))
        return {"itemProperty": [item]} if item is not None else {}
    return _measures(graph, element) if name == "ValueType" else {}


def _measures(graph: Graph, element: Element) -> dict[str, str | list[Element]]:
    found: dict[str, str | list[Element]] = {}
    if isinstance(element.attrs.get("unit"), str):
        found["unit"] = str(element.attrs["unit"])
    for one in graph.targets(element, Edge.REFERENCES):
        is_unit = one.kind is Kind.UNIT or one.role == "unit"
        is_kind = one.kind is Kind.QUANTITY_KIND or one.role == "quantity kind"
        if is_unit or is_kind:
            found["unit" if is_unit else "quantityKind"] = [one]
    return found
