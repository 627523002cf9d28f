"""New features of a class that hold nothing inside: value properties and ports by their shape.

What an attribute states in attributes of XML decides its type and how its value is read, for
all attributes that state the same. Other features go the general way (``attributes`` and
``interfaces``), which gives the same result for every row.
"""

from collections.abc import Callable
from typing import NamedTuple

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import documents, fitting, measures, mirrors, ports, sameness, special
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.plans import KEPT
from sysmlc.frontends.caex.types import Missing, Type, member
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.shared import Shared

_Stated = tuple[str, str, str]
"""Data type, attribute type and unit of an attribute, or nothing."""


# To look a member of an enumeration up takes twice as long as to look these up.
_MAPPED = Verdict.MAPPED
_PROPERTY = Kind.PROPERTY
_PORT = Kind.PORT
_TYPED_BY = Edge.TYPED_BY


class _Shape(NamedTuple):
    """What attributes that state the same have in common."""

    type: Type | None
    target: Element | None
    """What types them; None where it is a primitive of UML."""
    attrs: Shared
    read: Callable[[str], AttrValue] | None
    given: dict[str, Shared]
    """Attributes by the text of the value."""


_Named = tuple[str, str, _Shape | None]
"""Name and data type of an attribute, and its shape, None where it is not plain."""


class _PortShape(NamedTuple):
    """What interfaces of one class have in common."""

    type: Type | None
    target: Element | None
    meaning: str


class Plain:
    """Adds plain features of one file."""

    def __init__(self, context: Context, document: Document) -> None:
        self._context = context
        self.document = document
        self._shapes: dict[_Stated, _Shape | None] = {}
        self._named: dict[int, _Named] = {}
        """By the first row that states the same."""
        self._values = document.texts["Value"]
        self._defaults = document.texts["DefaultValue"]
        self._ports: dict[str, _PortShape | None] = {}
        self._more: dict[tuple[int, Type | None, bool], bool] = {}
        self._told: dict[tuple[int, str | None], Shared] = {}
        self._sources: list[Element] = []
        self._targets: list[Element] = []

    def attribute(self, owner: Type, row: int) -> bool:
        """Add an attribute of a class; False when it is not plain."""
        document = self.document
        if document.ends[row] > row + 1:
            return False
        name, data_type, shape = self._named.get(document.alike[row]) or self.named(row)
        if shape is None or document.ids[row] or row in self._defaults:
            return False
        if owner.inherits("Attribute", name):
            return False
        made = self.new(f"{owner.id}/{name or 'Attribute'}", name, owner.id, row, shape.attrs)
        if made is None:
            return False
        text = self._values.get(row)
        if text:
            made.attrs = shape.given.get(text) or self._given(row, text, data_type, shape)
        if shape.target is not None:
            self._sources.append(made)
            self._targets.append(shape.target)
        else:
            measures.refer(self._context, _TYPED_BY, made, data_type, made.ordinal)
        owner.members["Attribute", name] = member((made.id, shape.type, document, row))
        return True

    def named(self, row: int) -> _Named:
        """The name, data type and shape of an attribute, and of all that state the same."""
        values = self.document.attributes[row]
        name, data_type = values.get("Name", ""), values.get("AttributeDataType", "")
        stated = (data_type, values.get("RefAttributeType", ""), values.get("Unit", ""))
        shape = self._shapes[stated] if stated in self._shapes else self._shape(stated, row)
        found = self._named[self.document.alike[row]] = name, data_type, shape
        return found

    def _given(self, row: int, text: str, stated: str, shape: _Shape) -> dict[str, AttrValue]:
        """Attributes with a value; those of frequent values are kept for all that have them."""
        try:
            value = text if shape.read is None else shape.read(text)
        except ValueError:
            return {**shape.attrs, "default": self._unfit(row, text, stated, shape)}
        given: dict[str, AttrValue] = {**shape.attrs, "default": value}
        if len(shape.given) < KEPT:
            given = shape.given[text] = Shared(given)
        return given

    def _unfit(self, row: int, text: str, stated: str, shape: _Shape) -> AttrValue:
        data_type = fitting.data_type_of(stated, shape.type)
        return fitting.unfit(self._context, self.document, row, text, data_type, stated)

    def new(self, id: str, name: str, owner: str, row: int, attrs: Shared) -> Element | None:
        """Add an attribute; None when the graph has the id."""
        document = self.document
        source, ordinal = document.name, document.ordinals[row]
        if document.is_built_in:
            source, ordinal = "", -1
        made = self._context.graph.new(id, _PROPERTY, name, owner, ordinal, source, attrs)
        if made is not None:
            document.elements[row] = id
            document.verdicts[row] = _MAPPED
        return made

    def _shape(self, stated: _Stated, row: int) -> _Shape | None:
        data_type, path, unit = stated
        context, document = self._context, self.document
        declared = self._declared(path.strip(), Family.ATTRIBUTE)
        shape = None
        if not isinstance(declared, Missing) and measures.is_unit(unit):
            attrs: dict[str, AttrValue] = {"role": "value"}
            if data_type:
                attrs["data_type"] = data_type
            measures.multiply(attrs, declared)
            target = measures.target(context, document.node(row), document, declared, attrs)
            read = fitting.reader(data_type, declared)
            shape = _Shape(declared, target, Shared(attrs), read, {})
            fitting.know(context, document, row, data_type)
        self._shapes[stated] = shape
        return shape

    def _declared(self, path: str, family: Family) -> Type | Missing | None:
        """The class that a path means; a mirror counts as missing."""
        if not path:
            return None
        id = path.partition("/")[0] if family is Family.ATTRIBUTE else path
        if mirrors.is_reference(self._context, id):
            return Missing("class", path)
        return self._context.look_up(path, family, self.document)

    def interface(self, owner: Type, row: int) -> bool:
        """Add an interface of a class; False when it is not plain."""
        document, context = self.document, self._context
        if not self._has_only_attributes(row):
            return False
        values = document.attributes[row]
        name, path = values.get("Name", ""), values.get("RefBaseClassPath", "")
        shape = self._ports[path] if path in self._ports else self._port(path)
        if shape is None:
            return False
        if owner.inherits("ExternalInterface", name) or self._says_more(row, shape.type):
            return False
        made = context.add_at(_PORT, document, row, owner.id)
        if shape.target is not None:
            self._sources.append(made)
            self._targets.append(shape.target)
        owner.members["ExternalInterface", name] = member((made.id, shape.type, document, row))
        inside = document.ends[row] - row - 1
        if inside:
            made.attrs = self._said(row)
            document.verdicts[row + 1 : row + 1 + inside] = [_MAPPED] * inside
        if shape.meaning:
            self._mean(shape.meaning, owner, made, row)
        return True

    def _says_more(self, row: int, type: Type | None) -> bool:
        """Whether attributes of an interface say more than values, told once of a single one."""
        document = self.document
        inside = document.ends[row] - row - 1
        if not inside:
            return False
        if inside > 1 or row + 1 in self._defaults or row + 1 in document.texts["Description"]:
            return self._has_more(row, type)
        key = document.alike[row + 1], type, row + 1 in self._values
        known = self._more.get(key)
        if known is None:
            known = self._more[key] = self._has_more(row, type)
        return known

    def _has_more(self, row: int, type: Type | None) -> bool:
        types, node = self._context.types, self.document.node(row)
        return any(True for _ in sameness.more_than_values(types, self.document, node, type))

    def _said(self, row: int) -> Shared:
        """What the attributes of an interface say, told once of a single one and its value."""
        document, context = self.document, self._context
        if document.ends[row] > row + 2 or row + 1 in self._defaults:
            return Shared(ports.said_of(context, document.node(row)))
        key = document.alike[row + 1], self._values.get(row + 1)
        known = self._told.get(key)
        if known is None:
            unfit = len(context.unfit)
            known = Shared(ports.said_of(context, document.node(row)))
            if len(context.unfit) == unfit and key[1] not in {text for _, _, text in context.unfit}:
                self._told[key] = known
        return known

    def _mean(self, meaning: str, owner: Type, made: Element, row: int) -> None:
        """What a port of a special class is for; it may name a file of another language."""
        context, document = self._context, self.document
        context.special[made.id] = meaning
        if meaning in special.DOCUMENTS:
            node = document.node(row)
            documents.lower(context, node, document, owner.id, made.id, meaning, made.attrs)

    def _has_only_attributes(self, row: int) -> bool:
        document = self.document
        if document.ends[row] == row + 1:
            return True
        tags = document.tags
        return all(tags[child] == "Attribute" for child in document.children(row))

    def _port(self, path: str) -> _PortShape | None:
        declared = self._declared(path.strip(), Family.INTERFACE)
        shape = None
        if not isinstance(declared, Missing):
            target = None if declared is None else self._context.graph[declared.id]
            shape = _PortShape(declared, target, special.meaning(declared))
        self._ports[path] = shape
        return shape

    def finish(self) -> None:
        """Tie the features to what types them."""
        self._context.graph.connect_each(Edge.TYPED_BY, self._sources, self._targets)
        self._sources.clear()
        self._targets.clear()
