"""How the generated model is written: as Papyrus saves it, or as MagicDraw does.

Text is made once for a cell, with a mark wherever an id or number of the cell belongs;
``xmi_model`` fills in the marks for every cell of the file.
"""

import hashlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from html import escape

from model_cells import Application, Node, Part, walk

MARK = "\x00"
"""Stands before and after a key in the text of a cell."""

NUMBER = "<n>"
_MODULUS = 1 << 64
_ODD = 0x9E3779B97F4A7C15
_DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"


@dataclass(frozen=True, slots=True)
class Dialect:
    """A way to write; ``id`` gives the id with a number in a file with a seed."""

    head: str
    tail: str
    model: str
    id: Callable[[int, int], str]
    node: Callable[[Node, int], Iterator[str]]
    application: Callable[[Application], str]
    extension: Callable[[Part], Iterator[str]]


# -- what both write ---------------------------------------------------------------------------


def marked(key: str) -> str:
    """The place of an id."""
    return f"{MARK}{key}{MARK}"


def _value(text: str) -> str:
    return escape(text).replace(escape(NUMBER), marked(NUMBER))


def _name(node: Node) -> str:
    return f' name="{_value(node.name)}"' if node.name else ""


def _attributes(pairs: Iterable[tuple[str, str]]) -> str:
    return "".join(f' {name}="{_value(value)}"' for name, value in pairs)


def _references(pairs: Iterable[tuple[str, tuple[str, ...]]]) -> str:
    return "".join(f' {name}="{" ".join(map(marked, keys))}"' for name, keys in pairs)


def _element(indent: str, start: str, node: Node, inside: list[str]) -> Iterator[str]:
    if not inside:
        yield f"{indent}{start}/>\n"
        return
    yield f"{indent}{start}>\n"
    yield from inside
    yield f"{indent}</{node.feature}>\n"


def _texts(indent: str, node: Node) -> list[str]:
    return [f"{indent}<{name}>{_value(text)}</{name}>\n" for name, text in node.texts]


def _mixed(number: int, seed: int) -> int:
    return (number * _ODD + seed) % _MODULUS


# -- Papyrus -----------------------------------------------------------------------------------


def _papyrus_id(number: int, seed: int) -> str:
    """``_`` and 22 characters, of which a session of the editor shares the last ones."""
    mixed = _mixed(number, seed)
    own = "".join(_DIGITS[mixed >> shift & 63] for shift in range(58, -6, -6) if shift >= 0)
    return f"_{own}{_DIGITS[mixed & 15]}{_session(seed)}"


def _session(seed: int) -> str:
    return "Eeu" + hashlib.sha256(str(seed).encode()).hexdigest()[:8]


def _papyrus_node(node: Node, depth: int) -> Iterator[str]:
    indent = "  " * depth
    inner = indent + "  "
    start = f'<{node.feature} xmi:type="uml:{node.metaclass}" xmi:id="{marked(node.key)}"'
    start += _name(node) + _references(node.refs) + _attributes(node.attrs)
    inside = [
        f'{inner}<{name} xmi:type="uml:{metaclass}" href="{href}"/>\n'
        for name, metaclass, href in node.hrefs
    ]
    inside += _texts(inner, node)
    for child in node.children:
        inside += _papyrus_node(child, depth + 1)
    yield from _element(indent, start, node, inside)


def _papyrus_application(one: Application) -> str:
    start = f'  <{one.stereotype} xmi:id="{marked(one.key)}"' + _attributes(one.tags)
    bases = ((feature, (one.base,)) for feature in one.bases)
    return start + _references(bases) + _references(one.refs) + "/>\n"


def _no_extension(_part: Part) -> Iterator[str]:
    yield from ()


_SYSML = "http://www.eclipse.org/papyrus/sysml/1.6/SysML"
_SPACES = "".join(
    f' xmlns:{package}="{_SYSML}/{package}"'
    for package in ("Blocks", "PortsAndFlows", "Requirements")
)
PAPYRUS = Dialect(
    head=(
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
        f'{_SPACES} xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">\n'
    ),
    tail="</xmi:XMI>\n",
    model=f'  <uml:Model xmi:id="{marked("@model")}" name="Plant">\n',
    id=_papyrus_id,
    node=_papyrus_node,
    application=_papyrus_application,
    extension=_no_extension,
)


# -- MagicDraw ---------------------------------------------------------------------------------

_LISTS = frozenset(
    {"annotatedElement", "conveyed", "informationSource", "informationTarget"}
    | {"realizingConnector", "client", "supplier", "node", "inPartition", "propertyPath"}
)
"""Features that MagicDraw writes as children with ``xmi:idref``."""

_DERIVED = frozenset({"incoming", "outgoing"})
_EXTENDER = "<xmi:Extension extender='MagicDraw UML 19.0'>"
_SHOWN = 3
"""Diagrams that show each element: with them about 80 % of the elements are notation."""


def _magicdraw_id(number: int, seed: int) -> str:
    """As ``_19_0_4_25dc056a_1611932257358_604987_43618``."""
    mixed = _mixed(number, seed)
    host = hashlib.sha256(str(seed).encode()).hexdigest()[:8]
    stamp = 1600000000000 + mixed % 90000000000
    return f"_19_0_4_{host}_{stamp}_{mixed >> 44:06d}_{number % 100000}"


def _magicdraw_node(node: Node, depth: int) -> Iterator[str]:
    indent = "\t" * depth
    inner = indent + "\t"
    start = f"<{node.feature} xmi:type='uml:{node.metaclass}' xmi:id='{marked(node.key)}'"
    single = [pair for pair in node.refs if pair[0] not in _LISTS | _DERIVED]
    start += _quoted(_name(node) + _references(single) + _attributes(node.attrs))
    inside = _idrefs(inner, node.refs)
    for name, metaclass, href in node.hrefs:
        path = f"UML Standard Profile::UML2 Metamodel::PrimitiveTypes::{href.rpartition('#')[2]}"
        target = href.replace("pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml", _PRIMITIVES)
        inside.append(f"{inner}<{name} href='{target}'>\n{inner}\t{_EXTENDER}\n")
        inside.append(f"{inner}\t\t<referenceExtension referentPath='{path}'")
        inside.append(f" referentType='{metaclass}'/>\n{inner}\t</xmi:Extension>\n")
        inside.append(f"{inner}</{name}>\n")
    inside += _texts(inner, node)
    for child in node.children:
        inside += _magicdraw_node(child, depth + 1)
    yield from _element(indent, start, node, inside)


def _idrefs(indent: str, refs: Iterable[tuple[str, tuple[str, ...]]]) -> list[str]:
    return [
        f"{indent}<{feature} xmi:idref='{marked(key)}'/>\n"
        for feature, keys in refs
        if feature in _LISTS
        for key in keys
    ]


def _quoted(text: str) -> str:
    return text.replace('"', "'")


def _magicdraw_application(one: Application) -> str:
    local = one.stereotype.partition(":")[2]
    tags = [(_CAPITALS.get((local, name), name), value) for name, value in one.tags]
    start = f"\t<sysml:{local} xmi:id='{marked(one.key)}' "
    start += _quoted(f'{one.bases[-1]}="{marked(one.base)}"' + _attributes(tags))
    inside = _idrefs("\t\t", one.refs)
    return f"{start}>\n{''.join(inside)}\t</sysml:{local}>\n" if inside else f"{start}/>\n"


def _diagrams(part: Part) -> Iterator[str]:
    """Diagrams of a cell as MagicDraw keeps them inside the model."""
    keys = [node.key for top in part.nodes for node in walk(top)]
    yield f"\t\t{_EXTENDER}\n\t\t\t<modelExtension>\n"
    for number in range(_SHOWN):
        yield from _diagram(f"diagram{number}", keys)
    yield "\t\t\t</modelExtension>\n\t\t</xmi:Extension>\n"


def _diagram(name: str, keys: list[str]) -> Iterator[str]:
    id = marked(name)
    yield f"\t\t\t\t<ownedDiagram xmi:type='uml:Diagram' xmi:id='{id}' name='{name}'"
    yield f" ownerOfDiagram='{marked('cell')}'>\n\t\t\t\t\t{_EXTENDER}\n"
    yield "\t\t\t\t\t\t<diagramRepresentation>\n"
    yield f"\t\t\t\t\t\t\t<diagram:DiagramRepresentationObject ID='{id}' type='SysML Diagram'"
    yield " xmlns:diagram='http://www.nomagic.com/ns/magicdraw/core/diagram/1.0'>\n"
    yield "\t\t\t\t\t\t\t\t<diagramContents exporterName='MagicDraw UML'>\n"
    for key in keys:
        yield f"\t\t\t\t\t\t\t\t\t<usedObjects href='#{marked(key)}'/>\n"
    for key in keys:
        yield f"\t\t\t\t\t\t\t\t\t<usedElements>{marked(key)}</usedElements>\n"
    yield "\t\t\t\t\t\t\t\t</diagramContents>\n"
    yield "\t\t\t\t\t\t\t</diagram:DiagramRepresentationObject>\n"
    yield "\t\t\t\t\t\t</diagramRepresentation>\n\t\t\t\t\t</xmi:Extension>\n"
    yield "\t\t\t\t</ownedDiagram>\n"


_CAPITALS = {("Requirement", "id"): "Id", ("Requirement", "text"): "Text"}
_PRIMITIVES = "http://www.omg.org/spec/UML/20131001/PrimitiveTypes.xmi"
MAGICDRAW = Dialect(
    head=(
        "<?xml version='1.0' encoding='UTF-8'?>\n\n"
        "<xmi:XMI xmlns:uml='http://www.omg.org/spec/UML/20131001'"
        " xmlns:xmi='http://www.omg.org/spec/XMI/20131001'"
        " xmlns:sysml='http://www.omg.org/spec/SysML/20150709/SysML'>\n"
        "\t<xmi:Documentation>\n\t\t<xmi:exporter>MagicDraw UML</xmi:exporter>\n"
        "\t\t<xmi:exporterVersion>19.0 v9</xmi:exporterVersion>\n\t</xmi:Documentation>\n"
    ),
    tail="</xmi:XMI>\n",
    model=f"\t<uml:Model xmi:type='uml:Model' xmi:id='{marked('@model')}' name='Plant'>\n",
    id=_magicdraw_id,
    node=_magicdraw_node,
    application=_magicdraw_application,
    extension=_diagrams,
)

DIALECTS = {"papyrus": PAPYRUS, "magicdraw": MAGICDRAW}
