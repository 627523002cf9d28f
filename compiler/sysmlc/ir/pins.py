"""What a pin is to its action where nothing else is said (UML 2.5.1, 16.3 and 16.2)."""

from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Kind

_OF_CALLS = {"in": "argument", "out": "result"}
_OF_OPAQUE = {"in": "input-value", "out": "output-value"}
_BY_ACTION = {
    "call-behavior": _OF_CALLS,
    "call-operation": _OF_CALLS,
    "opaque": _OF_OPAQUE,
    "send": {"in": "argument"},
    "accept": {"out": "result"},
    "value": {"out": "result"},
    "read": {"out": "result"},
}


def pin_subkind(action: Element, pin: Element) -> str:
    """The UML feature that a pin is for by its direction; empty for actions with several."""
    if action.kind is not Kind.ACTION:
        return ""
    return _BY_ACTION.get(action.subkind, {}).get(str(pin.attrs.get("direction", "")), "")
