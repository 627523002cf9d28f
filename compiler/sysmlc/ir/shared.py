"""Attributes that many elements have alike: one dict for all of them."""

from typing import Never

from sysmlc.ir.element import AttrValue


class Shared(dict[str, AttrValue]):
    """Attributes that nobody changes in place: ``Graph.set`` gives an element others instead."""

    __slots__ = ()

    def _refuse(self, *_: object, **__: object) -> Never:
        raise TypeError("attributes that elements share are set by the graph")

    __setitem__ = __delitem__ = __ior__ = update = setdefault = _refuse
    pop = popitem = clear = _refuse


NOTHING = Shared()
"""No attributes."""
