"""Tables of attributes: where the graph keeps them, and which readers of single kinds take."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.feature_names import WORDS
from sysmlc.ir import AttrValue, Element

_FLAG: Mapping[str, AttrValue] = MappingProxyType({**dict.fromkeys(v.TRUE, True), "0": None})
_UNLESS_FALSE: Mapping[str, AttrValue] = MappingProxyType({"false": False, "0": False, "1": None})


class Key(NamedTuple):
    """Where the graph keeps the text of an attribute, or what ``meanings`` say of it.

    ``default`` is the text that is not kept; None is a meaning that needs no attribute.
    """

    name: str
    default: str
    meanings: Mapping[str, AttrValue] | None = None

    def keep(self, element: Element, value: str) -> bool:
        """Give the element the attribute; False for a value that means nothing."""
        if self.meanings is None:
            element.attrs[self.name] = value
        elif value in self.meanings:
            meant = self.meanings[value]
            if meant is not None:
                element.attrs[self.name] = meant
        else:
            return False
        return True


KEYS: Mapping[str, Key] = MappingProxyType(
    {
        **{name: Key(*said) for name, said in v.TEXTS.items()},
        "visibility": Key("visibility", "public", {w: w for w in WORDS["visibility"][1:]}),
        **{name: Key(key, "false", _FLAG) for name, key in v.FLAGS.items()},
        **{name: Key(key, "true", _UNLESS_FALSE) for name, key in v.UNLESS_FALSE.items()},
    }
)
"""Attributes that the graph keeps under names of their own."""


_HANDLED = frozenset(
    {"partWithPort", "guard", "event", "value"}
    | {"firstEvent", "interactionOperator", "messageKind", "messageSort"}
)
"""Attributes that the readers of single kinds take themselves."""

PASSED_OVER = (v.REDUNDANT | _HANDLED | {"name"}) - {name for _, name in v.REVERSED}
"""Attributes that never need a look at the other tables; most of a large file's."""
