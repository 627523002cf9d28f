"""Declarations: prefixes, keyword, name, types, specialisations, multiplicity, value."""

from dataclasses import dataclass

from sysmlc.backends.sysml.compatibility import (
    has_incompatible_ends,
    is_incompatible,
    is_invalid_subset,
)
from sysmlc.backends.sysml.elided_elements import find_specific_feature, iter_types
from sysmlc.backends.sysml.expressions import format_bounds
from sysmlc.backends.sysml.library import find_scalar_type
from sysmlc.backends.sysml.plan import Member, Plan
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import type_of

_VISIBILITIES = ("private", "protected")
_REFERENTIAL_OWNERS = frozenset({"port", "attribute", "metadata"})
"""Keywords of owners that may have no composite features but ports and attributes."""


@dataclass(slots=True)
class Head:
    """The parts of a declaration; empty parts are omitted."""

    prefixes: list[str]
    keyword: str
    name: str = ""
    types: list[str] | None = None
    multiplicity: str = ""
    subsets: list[str] | None = None
    redefines: list[str] | None = None
    value: str = ""

    def format(self) -> str:
        """Return the declaration as text; without a name, redefinitions stand first."""
        words = [*self.prefixes, self.keyword, self.name]
        text = " ".join(word for word in words if word)
        types = f" : {', '.join(self.types)}" if self.types else ""
        redefines = f" :>> {', '.join(self.redefines)}" if self.redefines else ""
        subsets = f" :> {', '.join(self.subsets)}" if self.subsets else ""
        if not self.name and redefines:
            return f"{text}{redefines}{types}{self.multiplicity}{subsets}{self.value}".lstrip()
        return f"{text}{types}{self.multiplicity}{subsets}{redefines}{self.value}".lstrip()


# -- definitions ---------------------------------------------------------------------------------


def make_definition_head(writer: Writer, member: Member, is_quantity: bool = False) -> Head:
    """Return the head of a definition, or of a usage that stands for one, with its generals.

    With *is_quantity*, the caller adds the generals.
    """
    element = member.require_element()
    prefixes = list_visibility(writer, element)
    prefixes += _list_modifiers(element)
    head = Head(prefixes, member.shape.keyword, quote_name(member.name) if member.name else "")
    if not is_quantity:
        head.types, head.subsets = _list_generals(writer, member)
    return head


def list_visibility(writer: Writer, element: Element) -> list[str]:
    """Return the prefix of a visibility; none for public elements and those that must be public."""
    visibility = element.attrs.get("visibility")
    if visibility not in _VISIBILITIES:
        return []
    if element.id in writer.public_ids:
        writer.record_approximation(element, f"'{visibility}' of what others refer to", "public")
        return []
    return [str(visibility)]


def _list_modifiers(element: Element) -> list[str]:
    attrs = element.attrs
    choice = "variation" if attrs.get("variation") else "abstract" if attrs.get("abstract") else ""
    return [*([choice] if choice else []), *(["individual"] if attrs.get("individual") else [])]


def _list_generals(writer: Writer, member: Member) -> tuple[list[str], list[str]]:
    """Return the generals: those that are types of a usage, and those that it specialises."""
    element = member.require_element()
    types: list[str] = []
    specialized: list[str] = []
    for general in writer.graph.targets(element, Edge.SPECIALIZES):
        general_member = writer.plan.find(general)
        scalar = find_scalar_type(general)
        if scalar is not None:
            specialized.append(writer.refer_to_library(member.parent, scalar))
        elif general_member is not None and _is_invalid(writer.plan, general_member, member):
            _add_generalization(writer, member, element, general)
        else:
            name = writer.refer_to(member.parent, element, Edge.SPECIALIZES, general)
            is_definition = general_member is not None and general_member.shape.is_definition
            is_type = is_definition and not member.shape.is_definition
            if name is not None:
                (types if is_type else specialized).append(name)
    return types, specialized


def _add_generalization(writer: Writer, member: Member, element: Element, general: Element) -> None:
    """Add a dependency in place of a generalisation that SysML v2 does not allow."""
    construct = f"generalization of {member.shape.keyword}"
    writer.record_approximation(element, construct, "dependency")
    name = writer.refer_to(member, element, Edge.SPECIALIZES, general)
    if name is not None:
        keyword = writer.refer_to_sysmlc(member, "generalization")
        source = quote_name(member.name)
        member.added_lines.append(Line(f"#{keyword} dependency from {source} to {name}"))


def _is_invalid(plan: Plan, general: Member, specific: Member) -> bool:
    """Whether a definition or usage must not specialise one of the other kind."""
    if has_incompatible_ends(plan, general, specific):
        return True
    return not specific.shape.may_specialize(general.shape)


# -- features ------------------------------------------------------------------------------------


def make_feature_head(writer: Writer, member: Member) -> Head:
    """Return the head of a feature, without its value."""
    element = member.require_element()
    keyword = member.shape.keyword
    prefixes = _list_feature_prefixes(writer, member, keyword)
    head = Head(prefixes, keyword if keyword != "ref" else "")
    head.types, head.subsets = list_types(writer, member.parent, element)
    head.multiplicity = format_multiplicity(writer, member.parent, element)
    _redefine(writer, member, head)
    return head


def _list_feature_prefixes(writer: Writer, member: Member, keyword: str) -> list[str]:
    """Return visibility, direction, and the other words before the keyword, in their order."""
    element = member.require_element()
    attrs = element.attrs
    direction = attrs.get("direction")
    modifiers = _list_modifiers(element)
    type_ = type_of(writer.graph, element)
    if type_ is not None and type_.attrs.get("variation"):
        if find_specific_feature(writer.graph, type_) is element:
            modifiers = ["variation"]
        else:
            modifiers = [word for word in modifiers if word != "variation"]
    prefixes = list_visibility(writer, element)
    if direction in ("in", "out", "inout", "return"):
        prefixes.append("out" if direction == "return" else str(direction))
    prefixes += ["variant"] if attrs.get("variant") else []
    prefixes += ["derived"] if attrs.get("derived") else []
    prefixes += [word for word in modifiers if word in ("abstract", "variation")]
    prefixes += ["constant"] if attrs.get("readonly") else []
    prefixes += ["ref"] if _needs_ref(member, keyword) else []
    prefixes += [word for word in modifiers if word not in ("abstract", "variation")]
    return [*prefixes, *([str(attrs["portion"])] if "portion" in attrs else [])]


def _needs_ref(member: Member, keyword: str) -> bool:
    """Whether a feature is marked as a reference; directed features are references anyway."""
    element = member.require_element()
    if element.attrs.get("direction") is not None:
        return False
    if keyword == "ref":
        return True
    if keyword in ("attribute", "port"):
        return False
    is_part = element.attrs.get("aggregation") == "composite" or element.role == "part"
    is_property = element.kind in (Kind.PROPERTY, Kind.FLOW_PROPERTY)
    return is_referential_owner(member.parent) or (is_property and not is_part)


def is_referential_owner(namespace: Member | None) -> bool:
    """Whether a namespace may have no composite features but ports and attributes."""
    return namespace is not None and namespace.shape.usage_keyword in _REFERENTIAL_OWNERS


def list_types(
    writer: Writer, scope: Member | None, element: Element
) -> tuple[list[str], list[str]]:
    """Return the types of a feature, and the features that it subsets.

    A type that is written as a usage is subsetted, too.
    """
    types, subsets = [], []
    for type_ in iter_types(writer.graph, element):
        name = refer_to_type(writer, scope, element, type_)
        member = writer.plan.find(type_)
        if name is None:
            continue
        if member is not None and not member.shape.is_definition:
            subsets.append(name)
        else:
            types.append(f"~{name}" if element.attrs.get("conjugated") else name)
    for feature in writer.graph.targets(element, Edge.SUBSETS):
        if feature is element:
            writer.record_unreachable(element, "subsets")
            continue
        if is_invalid_subset(writer.plan, element, feature):
            continue
        name = writer.refer_to(scope, element, Edge.SUBSETS, feature)
        subsets += [] if name is None else [name]
    return types, [*subsets, *_list_referenced_features(writer, scope, element)]


def _list_referenced_features(writer: Writer, scope: Member | None, element: Element) -> list[str]:
    """Return the names of features that the source references by ``::>`` (SysML v2)."""
    is_feature = element.kind in (Kind.PROPERTY, Kind.PORT)
    features = writer.graph.targets(element, Edge.REFERENCES) if is_feature else []
    names = (writer.refer_to(scope, element, Edge.REFERENCES, feature) for feature in features)
    return [name for name in names if name is not None]


def refer_to_type(
    writer: Writer, scope: Member | None, holder: Element, type_: Element
) -> str | None:
    """Return the name of a type; primitive types become those of the standard library."""
    scalar = find_scalar_type(type_)
    if scalar is not None:
        return writer.refer_to_library(scope, scalar)
    return writer.refer_to(scope, holder, Edge.TYPED_BY, type_)


def format_multiplicity(writer: Writer, scope: Member | None, element: Element) -> str:
    """Return the multiplicity in brackets, with ``ordered`` and ``nonunique``; empty for none."""
    multiplicity = element.attrs.get("multiplicity")
    text = "" if multiplicity is None else format_bounds(writer, scope, str(multiplicity)) or ""
    text += " ordered" if element.attrs.get("ordered") else ""
    return text + (" nonunique" if element.attrs.get("unique") is False else "")


def _redefine(writer: Writer, member: Member, head: Head) -> None:
    """Add name and redefinitions to a head.

    A feature with the name of a redefined one needs no name, and no type if it has the same.
    """
    element = member.require_element()
    head.redefines = []
    has_redefined_name = False
    redefined_features = writer.graph.targets(element, Edge.REDEFINES)
    for feature in redefined_features:
        if is_incompatible(writer.plan, element, feature):
            continue
        feature_member = writer.plan.find(feature)
        name = writer.refer_to_redefined(member.parent, feature)
        if name is None or feature_member is None:
            writer.record_unreachable(element, "redefines")
            continue
        if feature_member.parent is member.parent:
            writer.record_approximation(element, "redefinition within one owner", "a subset")
            head.subsets = [*(head.subsets or ()), name]
            continue
        has_redefined_name = has_redefined_name or feature_member.name == member.name
        head.redefines.append(name)
    head.name = "" if has_redefined_name else quote_name(member.name)
    types = list(iter_types(writer.graph, element))
    # Only a type states that a port is conjugated.
    is_conjugated = bool(element.attrs.get("conjugated"))
    if (
        has_redefined_name
        and not is_conjugated
        and all(list(iter_types(writer.graph, feature)) == types for feature in redefined_features)
    ):
        head.types = []
