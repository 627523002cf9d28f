"""XML elements of an interchange file while they are open, and what their attributes say."""

from collections.abc import Mapping
from functools import cache

from sysmlc.language.interchange.metamodel import stated
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

    ``node`` is what it becomes, with the names and facts that it states; a relationship that is
    folded has one too, which is thrown away. ``targets`` has the ids that its features refer
    to, ``owned`` the closed ``ownedRelatedElement`` frames of a relationship.
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

    def say(self, feature: str, value: str) -> str:
        """Take one attribute; returns the type that the value is not of, else nothing."""
        action = _plan(self.kind).get(feature)
        if action is None or action == "ignored":
            return ""
        if action == "reference":
            self.targets.setdefault(feature, []).extend(value.split())
        elif action == "name":
            _name(self.node, feature, value)
        else:
            return _state(self.node, feature, value, action)
        return ""


@cache
def _plan(kind: str) -> Mapping[str, str]:
    return {feature: _action(kind, feature) for feature in stated(kind)}


def _action(kind: str, feature: str) -> str:
    if feature in _NAMES:
        return "name"
    if feature in _IGNORED or (feature == "operator" and kind != "OperatorExpression"):
        return "ignored"
    if feature in _TEXTS or (feature == "value" and kind == "LiteralString"):
        return "text"
    if feature == "value" and kind in _TYPES:
        return "number"
    return "boolean" if feature.startswith("is") or feature == "value" else "reference"


def _name(node: Node, feature: str, value: str) -> None:
    if feature == "declaredName":
        node.name = value
    else:
        node.short_name = value


def _state(node: Node, feature: str, value: str, action: str) -> str:
    fact = _parsed(node.kind, value, action)
    if fact is None:
        return "number" if action == "number" else "truth value"
    if action != "boolean" or feature == "value" or fact != (feature in _TRUE_BY_DEFAULT):
        node.attributes[feature] = fact
    return ""


def _parsed(kind: str, value: str, action: str) -> AttributeValue | None:
    if action == "text":
        return value
    if action == "boolean":
        return _BOOLEANS.get(value)
    try:
        return _TYPES[kind](value)
    except ValueError:
        return None


def complete(node: Node) -> None:
    """State the value of a literal that is the default of its type, so that files omit it."""
    if is_a(node.kind, "LiteralExpression") and "value" not in node.attributes:
        default = {"LiteralBoolean": False, "LiteralInteger": 0, "LiteralRational": 0.0}
        if node.kind in default:
            node.attributes["value"] = default[node.kind]
        elif node.kind == "LiteralString":
            node.attributes["value"] = ""
