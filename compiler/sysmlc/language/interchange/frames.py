"""Frames: open XML elements of an interchange file, and the meaning of their attributes."""

from collections.abc import Mapping
from functools import cache

from sysmlc.language.interchange.metamodel import list_features
from sysmlc.language.metaclasses import is_a
from sysmlc.language.tree import AttributeValue, Node

_NAMES = {"declaredName", "declaredShortName"}
_OPPOSITES = {"owningRelationship", "owningRelatedElement", "source", "target"}
_IGNORED = _OPPOSITES | {"elementId", "aliasIds", "isImpliedIncluded", "isImplied"}
_TEXTS = {
    "body",
    "locale",
    "language",
    "operator",
    "reqId",
    "direction",
    "portionKind",
    "kind",
    "visibility",
    "memberName",
    "memberShortName",
}
_TRUE_BY_DEFAULT = {"isUnique"}
_BOOLEANS = {"true": True, "false": False, "1": True, "0": False}
_TYPES: dict[str, type[int] | type[float]] = {"LiteralInteger": int, "LiteralRational": float}


class Frame:
    """An open XML element that is an element of the model.

    ``node`` is the node that it becomes, with its names and attributes. A relationship that is
    folded has a node too, which is discarded. ``targets`` has the ids that its features refer to,
    ``owned`` the closed ``ownedRelatedElement`` frames of a relationship.
    """

    __slots__ = ("id", "is_chain", "kind", "node", "ordinal", "owned", "targets")

    def __init__(self, kind: str, id: str, ordinal: int) -> None:
        self.kind = kind
        self.id = id
        self.ordinal = ordinal
        self.node = Node(kind, start=ordinal)
        self.targets: dict[str, list[str]] = {}
        self.owned: list[Frame] = []
        self.is_chain = False

    def set_attribute(self, feature: str, value: str) -> str:
        """Set one attribute; return the name of the expected type if the value has another one."""
        action = _plan_actions(self.kind).get(feature)
        if action is None or action == "ignored":
            return ""
        if action == "reference":
            self.targets.setdefault(feature, []).extend(value.split())
        elif action == "name":
            _set_name(self.node, feature, value)
        else:
            return _set_value(self.node, feature, value, action)
        return ""


@cache
def _plan_actions(kind: str) -> Mapping[str, str]:
    return {feature: _choose_action(kind, feature) for feature in list_features(kind)}


def _choose_action(kind: str, feature: str) -> str:
    if feature in _NAMES:
        return "name"
    if feature in _IGNORED or (feature == "operator" and kind != "OperatorExpression"):
        return "ignored"
    if feature in _TEXTS or (feature == "value" and kind == "LiteralString"):
        return "text"
    if feature == "value" and kind in _TYPES:
        return "number"
    return "boolean" if feature.startswith("is") or feature == "value" else "reference"


def _set_name(node: Node, feature: str, value: str) -> None:
    if feature == "declaredName":
        node.name = value
    else:
        node.short_name = value


def _set_value(node: Node, feature: str, value: str, action: str) -> str:
    parsed = _parse(node.kind, value, action)
    if parsed is None:
        return "number" if action == "number" else "truth value"
    # Files state defaults too; the tree has only values that differ from them.
    if action != "boolean" or feature == "value" or parsed != (feature in _TRUE_BY_DEFAULT):
        node.attributes[feature] = parsed
    return ""


def _parse(kind: str, value: str, action: str) -> AttributeValue | None:
    if action == "text":
        return value
    if action == "boolean":
        return _BOOLEANS.get(value)
    try:
        return _TYPES[kind](value)
    except ValueError:
        return None


def complete_literal(node: Node) -> None:
    """Set the value of a literal that files omit because it is the default of its type."""
    if is_a(node.kind, "LiteralExpression") and "value" not in node.attributes:
        default = {"LiteralBoolean": False, "LiteralInteger": 0, "LiteralRational": 0.0}
        if node.kind in default:
            node.attributes["value"] = default[node.kind]
        elif node.kind == "LiteralString":
            node.attributes["value"] = ""
