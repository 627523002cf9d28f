"""Ends of associations and connectors, bindings, and cross features (KerML 8.3.3.3.5, 8.3.4.5)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.conformance import find_direction
from sysmlc.language.checks.findings import Finding, iter_stated, name_of
from sysmlc.language.checks.memberships import TOO_MANY_ENDS
from sysmlc.language.metaclasses import USAGES, is_a, is_end, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.implied import find_own_features, find_owning_type
from sysmlc.language.tree import Node, Reference, Relation
from sysmlc.support.counts import count as count_nouns

END_TYPE = rule(
    "SM269",
    "end-types",
    Severity.ERROR,
    "the end '{name}' of '{owner}' has {count} types, but must have exactly one",
    help="keep one type, or let it specialise the inherited type",
)
TOO_FEW = rule(
    "SM270",
    "connects-too-few",
    Severity.ERROR,
    "'{name}' connects {count}, but must connect at least two",
    help="name a connected element at each of two or more ends",
)
NO_FLOW_END = rule(
    "SM271",
    "flow-end-without-dot",
    Severity.ERROR,
    "'{name}' does not name the element whose feature the flow connects",
    help="write the element, a dot, and its feature",
)
FLOW_DIRECTION = rule(
    "SM242",
    "flow-direction",
    Severity.WARNING,
    "the flow {way} '{name}', whose direction is {is} there",
    help="reverse the flow, conjugate the port, or name another feature of it",
)
FLOW_TYPES = rule(
    "SM244",
    "flow-types",
    Severity.WARNING,
    "{one} and {other} of the flow have unrelated types: '{type}' and '{other_type}'",
    help="let one type specialise the other, or name features and a payload that fit",
)
CONNECTED_UNLIKE = rule(
    "SM245",
    "connected-unlike",
    Severity.WARNING,
    "'{name}' of type '{type}' is connected as '{end}', whose type '{end_type}' is unrelated",
    help="connect a feature of the type of the end, or choose another definition",
)
ENDS_EXCHANGED = rule(
    "SM348",
    "ends-exchanged",
    Severity.WARNING,
    "{connected}: each has the directions of the other end of the definition",
    help="exchange the connected features, or conjugate the types of both (~)",
)

_ASSOCIATIONS = kinds_of("Association")
_CONNECTORS = kinds_of("Connector") - kinds_of("Flow")
_SUCCESSIONS = kinds_of("Succession")
_PORTS = frozenset({"PortUsage", "ReferenceUsage"})
"""Valid ends of interfaces; ``memberships`` reports others."""
_FLOWS = kinds_of("FlowDefinition")
_FLOW_USAGES = kinds_of("FlowUsage")
_PORT_USAGES = kinds_of("PortUsage")
_REDEFINITIONS = frozenset({"Redefinition"})
_REVERSED = {"in": "out", "out": "in"}


def check_end_types(model: Model, node: Node) -> Iterator[Finding]:
    """Report ends of an association with several types."""
    for end in filter(is_end, node.members):
        if node.kind == "InterfaceDefinition" and end.kind not in _PORTS:
            continue
        typings = [relation for relation in end.relations if relation.kind == "FeatureTyping"]
        count = len(typings if end.find_relation("CrossSubsetting") else model.types(end))
        if count > 1:
            facts = {"name": name_of(model, end), "owner": name_of(model, node)}
            yield Finding(END_TYPE, end.start, {**facts, "count": str(count)})


def check_related(model: Model, node: Node) -> Iterator[Finding]:
    """Report a connector with ends of its own that has less than two related elements."""
    ends = find_own_features(node, "end")
    if not ends or node.attributes.get("isAbstract") or node.kind in _SUCCESSIONS:
        return
    ends += model.lookup.features_of_role(node, "end")
    count = len({end for end in ends if _is_related(end)})
    if count < 2:
        facts = {"name": name_of(model, node), "count": count_nouns(count, "element")}
        yield Finding(TOO_FEW, node.start, facts)


def _is_related(end: Node) -> bool:
    return end.find_relation("ReferenceSubsetting") is not None


def check_flow_end(model: Model, node: Node) -> Iterator[Finding]:
    """Report a flow end that names, without a dot, a feature that no other feature owns.

    A feature that a usage owns is reached through that usage, which is the end of the flow.
    """
    if _is_related(node):
        return
    for member in node.members:
        for relation in member.relations:
            if relation.kind == "Redefinition" and _is_owned_by_type(relation):
                text = "::".join(relation.reference.chain[0])
                yield Finding(NO_FLOW_END, node.start, {"name": text})


def check_connected_types(model: Model, node: Node) -> Iterator[Finding]:
    """Report an end that connects a feature of another type than the definition states."""
    for end in find_own_features(node, "end"):
        for feature in _list_referenced(end):
            for defined in _list_redefined(model, end):
                unlike = _find_unrelated_types(model, feature, defined)
                if unlike is not None:
                    facts = {"name": name_of(model, feature), "type": name_of(model, unlike[0])}
                    facts |= {"end": name_of(model, defined)}
                    facts |= {"end_type": name_of(model, unlike[1])}
                    yield Finding(CONNECTED_UNLIKE, end.start, facts)


def check_exchanged_ends(model: Model, node: Node) -> Iterator[Finding]:
    """Report two connected ports whose directions are opposite to those of the ends they stand for.

    If only one port does not fit its end, pass ``flows`` reports that both have equal directions.
    """
    ends = find_own_features(node, "end")
    texts = [
        f"'{name_of(model, feature)}' is connected as '{name_of(model, defined)}'"
        for end in ends
        for feature in _list_referenced(end)
        if feature.kind in _PORT_USAGES
        for defined in _list_redefined(model, end)
        # An end redefines by its position. With the name of the other end, it is meant as that one.
        if end.name in (None, "", defined.name) and _is_reversed(model, feature, defined)
    ]
    if len(ends) == len(texts) == 2:
        yield Finding(ENDS_EXCHANGED, node.start, {"connected": " and ".join(texts)})


def _list_redefined(model: Model, end: Node) -> list[Node]:
    return sorted(model.lookup.redefined_features(end), key=model.qualified_name)


def _is_reversed(model: Model, feature: Node, end: Node) -> bool:
    """Whether inputs of the end are outputs of the feature, or the other way round."""
    directions = [
        (find_direction(model, feature, member), find_direction(model, end, member))
        for member in model.members(end)
    ]
    opposites = [_REVERSED.get(direction) for direction, _ in directions if direction in _REVERSED]
    return bool(opposites) and opposites == [
        end_direction for direction, end_direction in directions if direction in _REVERSED
    ]


def _is_owned_by_type(relation: Relation) -> bool:
    target = relation.reference.target
    owner = target.owner if target is not None else None
    return owner is not None and not is_a(owner.kind, "Feature")


def check_flow(model: Model, node: Node) -> Iterator[Finding]:
    """Report a definition of flows that inherits more than two ends."""
    ends = model.lookup.features_of_role(node, "end")
    if len(ends) > 2 and len(find_own_features(node, "end")) <= 2:
        facts = {"name": name_of(model, ends[2]), "owner": name_of(model, node)}
        yield Finding(TOO_MANY_ENDS, node.start, facts)


def check_flow_directions(model: Model, node: Node) -> Iterator[Finding]:
    """Report a flow that leaves an ``in`` feature or enters an ``out`` feature of a part or port.

    From the inside of the element with the port it is the other way round.
    """
    ends = [member for member in node.members if member.kind == "FlowEnd"]
    for end, wrong, way in zip(ends, ("in", "out"), ("leaves", "enters"), strict=False):
        path, feature = _read_flow_end(end)
        if feature is None or not path or _is_judged_by_port(model, path):
            continue
        # The end of an interface is a port of another element.
        is_inside = all(step.kind in _PORT_USAGES and not is_end(step) for step in path)
        if find_direction(model, path[-1], feature) == (_REVERSED[wrong] if is_inside else wrong):
            names = ".".join(name_of(model, step) for step in (*path, feature))
            direction = find_direction(model, path[-1], feature)
            yield Finding(FLOW_DIRECTION, end.start, {"way": way, "name": names, "is": direction})


def _is_judged_by_port(model: Model, path: list[Node]) -> bool:
    """Whether pass ``flows`` judges the end by the one direction of its port (SM310).

    The end is not judged at all if its port is nested in another one, which may be conjugated, or
    if it refers to such a port.
    """
    if path[-1].kind not in _PORT_USAGES:
        return False
    if any(map(_is_related, path)):
        return True
    members = model.members(path[-1])
    directions = {find_direction(model, path[-1], member) for member in members}
    return len(directions - {""}) == 1 or sum(step.kind in _PORT_USAGES for step in path) > 1


def check_flow_types(model: Model, node: Node) -> Iterator[Finding]:
    """Report a flow whose payload and connected features cannot have a value in common."""
    ends = [_read_flow_end(member) for member in node.members if member.kind == "FlowEnd"]
    connected = [(path, feature) for path, feature in ends if feature is not None]
    payloads = [member for member in node.members if member.kind == "PayloadFeature"]
    payloads = payloads or [item for item in model.members(node) if model.name(item) == "payload"]
    pairs = [
        (("the payload", payload), (_quote_path(model, path, feature), feature))
        for payload in payloads
        for path, feature in connected
        if not _is_refused_by_port(model, path, payload)
    ]
    if len(connected) == 2:
        source, target = ((_quote_path(model, *end), end[1]) for end in connected)
        pairs.append((source, target))
    for (name, feature), (other_name, other_feature) in pairs:
        unlike = _find_unrelated_types(model, feature, other_feature)
        if unlike is not None:
            facts = {"one": name, "other": other_name}
            facts |= {"type": name_of(model, unlike[0]), "other_type": name_of(model, unlike[1])}
            yield Finding(FLOW_TYPES, node.start, facts)
            return


def _quote_path(model: Model, path: list[Node], feature: Node) -> str:
    return f"'{'.'.join(name_of(model, step) for step in (*path, feature))}'"


def _is_refused_by_port(model: Model, path: list[Node], payload: Node) -> bool:
    """Whether pass ``flows`` reports that the port at an end passes no such payload (SM311)."""
    if not path or path[-1].kind not in _PORT_USAGES:
        return False
    members = model.members(path[-1])
    items = [member for member in members if find_direction(model, path[-1], member)]
    return all(_find_unrelated_types(model, payload, item) is not None for item in items)


def _read_flow_end(end: Node) -> tuple[list[Node], Node | None]:
    """Return the features that an end of a flow names before the last dot, and the last one."""
    path = [
        step
        for relation in end.relations
        if relation.kind == "ReferenceSubsetting"
        for step in relation.reference.targets or ()
    ]
    features = (
        target for member in end.members for _, target in iter_stated(member, _REDEFINITIONS)
    )
    return path, next(features, None)


END_CHECKS = (
    (_ASSOCIATIONS, check_end_types),
    (_CONNECTORS, check_related),
    (frozenset({"FlowEnd"}), check_flow_end),
    (_FLOWS, check_flow),
    (_FLOW_USAGES, check_flow_directions),
    (_FLOW_USAGES, check_flow_types),
    (_CONNECTORS & USAGES, check_connected_types),
    (_CONNECTORS & USAGES, check_exchanged_ends),
)


BOUND_UNLIKE = rule(
    "SM283",
    "bound-unlike",
    Severity.WARNING,
    "'{one}' is bound to '{other}', but no value can have both types: {types}",
    help="bind features of types that conform",
)


def check_binding(model: Model, node: Node) -> Iterator[Finding]:
    """Report a binding of features whose types have no common values."""
    features = [
        feature for end in find_own_features(node, "end") for feature in _list_referenced(end)
    ]
    if len(features) != 2:
        return
    unlike = _find_unrelated_types(model, *features)
    if unlike is not None:
        types = " and ".join(f"'{name_of(model, type_)}'" for type_ in unlike)
        left_name, right_name = (name_of(model, feature) for feature in features)
        facts = {"one": left_name, "other": right_name, "types": types}
        yield Finding(BOUND_UNLIKE, node.start, facts)


def _list_referenced(end: Node) -> list[Node]:
    references = [
        relation.reference for relation in end.relations if relation.kind == "ReferenceSubsetting"
    ]
    return [reference.target for reference in references if reference.target is not None]


def _find_unrelated_types(model: Model, left: Node, right: Node) -> tuple[Node, Node] | None:
    """Return the types of two features if no type of one conforms to a type of the other."""
    left_types, right_types = model.types(left), model.types(right)
    if not left_types or not right_types:
        return None
    if any(
        model.specializes(left_type, right_type) or model.specializes(right_type, left_type)
        for left_type in left_types
        for right_type in right_types
    ):
        return None
    return left_types[0], right_types[0]


BINDING_CHECKS = ((kinds_of("BindingConnector"), check_binding),)


NOT_OPPOSITE = rule(
    "SM285",
    "crosses-own-end",
    Severity.ERROR,
    "'{name}' does not lead through the opposite end of '{owner}'",
    help="start with the name of the other end, then a dot and its feature",
)
OTHER_TYPE = rule(
    "SM286",
    "crosses-other-type",
    Severity.ERROR,
    "'{name}' does not have the type of the end that crosses it",
    help="let the end and the feature have the same type",
)
NOT_SPECIAL = rule(
    "SM287",
    "crosses-unrelated",
    Severity.ERROR,
    "'{name}' does not specialise '{general}', which the redefined end crosses",
    help="cross a feature that subsets '{general}'",
)
OTHER_OWN = rule(
    "SM288",
    "crosses-past-own",
    Severity.ERROR,
    "'{owner}' has the cross feature '{name}' but crosses another feature",
    help="cross '{name}', or remove it",
)

_CROSSES = frozenset({"CrossSubsetting"})
_CROSS_FEATURE = ("OwningMembership", "Feature")
_TYPING = frozenset({"FeatureTyping"})


def check_cross_feature(model: Model, node: Node) -> Iterator[Finding]:
    """Report an end that crosses a feature which is not its cross feature."""
    if not _is_binary(node.owner):
        return
    for relation, crossed in iter_stated(node, _CROSSES):
        facts = {"name": name_of(model, crossed), "owner": name_of(model, node.owner)}
        start = relation.reference.start
        if not _is_opposite(node, relation.reference):
            yield Finding(NOT_OPPOSITE, start, {**facts, "name": str(relation.reference)})
        types = {target for _, target in iter_stated(node, _TYPING)}
        is_typed = bool(types and model.lookup.generals(crossed))
        if is_typed and types != set(model.types(crossed)):
            yield Finding(OTHER_TYPE, start, facts)
        # The cross features of the ends that the end redefines.
        for end in _list_redefined(model, node):
            for _, general in iter_stated(end, _CROSSES):
                if not model.specializes(crossed, general):
                    names = {**facts, "general": name_of(model, general)}
                    yield Finding(NOT_SPECIAL, start, names)
        for own_feature in node.members:
            is_cross_feature = (own_feature.membership, own_feature.kind) == _CROSS_FEATURE
            if is_cross_feature and own_feature is not crossed:
                names = {"name": name_of(model, own_feature), "owner": name_of(model, node)}
                yield Finding(OTHER_OWN, own_feature.start, names)


def _is_binary(owner: Node | None) -> bool:
    """Whether the owner has two ends.

    With more ends, an end crosses through links between the other ends.
    """
    return owner is not None and sum(map(is_end, owner.members)) == 2


def _is_opposite(node: Node, reference: Reference) -> bool:
    """Whether a chain starts at the other end and leads to a feature of that end."""
    targets = reference.targets or []
    is_other = bool(targets) and targets[0] is not node and is_end(targets[0])
    return len(targets) == 2 and is_other and find_owning_type(targets[0]) is not None


BY_RELATION = ((_CROSSES, check_cross_feature),)
