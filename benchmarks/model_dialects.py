"""The dialects in which a generated model is printed: as Papyrus saves it, or as MagicDraw does.

A cell is printed once, with a mark in place of each id and of the number of the cell; ``xmi_model``
replaces the marks for every cell of the file.
"""

import hashlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from html import escape

from model_cells import Application, Node, Part, iter_subtree

MARK = "\x00"
"""Stands before and after a key in the text of a cell."""

NUMBER = "<n>"
_MODULUS = 1 << 64
_ODD = 0x9E3779B97F4A7C15
_DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"


@dataclass(frozen=True, slots=True)
class Dialect:
    """The texts around a model, and the functions that print its elements.

    ``make_id`` returns the id with a number in the file with a seed.
    """

    head: str
    tail: str
    model: str
    make_id: Callable[[int, int], str]
    print_node: Callable[[Node, int], Iterator[str]]
    print_application: Callable[[Application], str]
    print_extension: Callable[[Part], Iterator[str]]


# -- both dialects -----------------------------------------------------------------------------


def mark_key(key: str) -> str:
    """Return the mark that ``xmi_model`` replaces by the id of a key."""
    return f"{MARK}{key}{MARK}"


def _print_value(text: str) -> str:
    return escape(text).replace(escape(NUMBER), mark_key(NUMBER))


def _print_name(node: Node) -> str:
    return f' name="{_print_value(node.name)}"' if node.name else ""


def _print_attributes(pairs: Iterable[tuple[str, str]]) -> str:
    return "".join(f' {name}="{_print_value(value)}"' for name, value in pairs)


def _print_references(pairs: Iterable[tuple[str, tuple[str, ...]]]) -> str:
    return "".join(f' {name}="{" ".join(map(mark_key, keys))}"' for name, keys in pairs)


def _print_element(indent: str, start: str, node: Node, content: list[str]) -> Iterator[str]:
    if not content:
        yield f"{indent}{start}/>\n"
        return
    yield f"{indent}{start}>\n"
    yield from content
    yield f"{indent}</{node.feature}>\n"


def _print_texts(indent: str, node: Node) -> list[str]:
    return [f"{indent}<{name}>{_print_value(text)}</{name}>\n" for name, text in node.texts]


def _mix_bits(number: int, seed: int) -> int:
    """Return 64 bits that differ for each number of a file."""
    return (number * _ODD + seed) % _MODULUS


# -- Papyrus -----------------------------------------------------------------------------------


def _make_papyrus_id(number: int, seed: int) -> str:
    """Return ``_`` and 22 characters; the last ones are the same for a session of the editor."""
    bits = _mix_bits(number, seed)
    digits = "".join(_DIGITS[bits >> shift & 63] for shift in range(58, -6, -6) if shift >= 0)
    return f"_{digits}{_DIGITS[bits & 15]}{_name_session(seed)}"


def _name_session(seed: int) -> str:
    return "Eeu" + hashlib.sha256(str(seed).encode()).hexdigest()[:8]


def _print_papyrus_node(node: Node, depth: int) -> Iterator[str]:
    indent = "  " * depth
    inner = indent + "  "
    start = f'<{node.feature} xmi:type="uml:{node.metaclass}" xmi:id="{mark_key(node.key)}"'
    start += _print_name(node) + _print_references(node.refs) + _print_attributes(node.attrs)
    content = [
        f'{inner}<{name} xmi:type="uml:{metaclass}" href="{href}"/>\n'
        for name, metaclass, href in node.hrefs
    ]
    content += _print_texts(inner, node)
    for child in node.children:
        content += _print_papyrus_node(child, depth + 1)
    yield from _print_element(indent, start, node, content)


def _print_papyrus_application(application: Application) -> str:
    start = f'  <{application.stereotype} xmi:id="{mark_key(application.key)}"'
    start += _print_attributes(application.tags)
    bases = ((feature, (application.base,)) for feature in application.bases)
    return start + _print_references(bases) + _print_references(application.refs) + "/>\n"


def _print_no_extension(_part: Part) -> Iterator[str]:
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
    model=f'  <uml:Model xmi:id="{mark_key("@model")}" name="Plant">\n',
    make_id=_make_papyrus_id,
    print_node=_print_papyrus_node,
    print_application=_print_papyrus_application,
    print_extension=_print_no_extension,
)


# -- MagicDraw ---------------------------------------------------------------------------------

_LISTS = frozenset(
    {"annotatedElement", "conveyed", "informationSource", "informationTarget"}
    | {"realizingConnector", "client", "supplier", "node", "inPartition", "propertyPath"}
)
"""Features that MagicDraw saves as children with ``xmi:idref``."""

_DERIVED = frozenset({"incoming", "outgoing"})
_EXTENDER = "<xmi:Extension extender='MagicDraw UML 19.0'>"
_DIAGRAM_COUNT = 3
"""Diagrams that show each element. With 3 of them, about 80 % of the XML elements are notation."""


def _make_magicdraw_id(number: int, seed: int) -> str:
    """Return an id such as ``_19_0_4_25dc056a_1611932257358_604987_43618``."""
    bits = _mix_bits(number, seed)
    host = hashlib.sha256(str(seed).encode()).hexdigest()[:8]
    stamp = 1600000000000 + bits % 90000000000
    return f"_19_0_4_{host}_{stamp}_{bits >> 44:06d}_{number % 100000}"


def _print_magicdraw_node(node: Node, depth: int) -> Iterator[str]:
    indent = "\t" * depth
    inner = indent + "\t"
    start = f"<{node.feature} xmi:type='uml:{node.metaclass}' xmi:id='{mark_key(node.key)}'"
    single = [pair for pair in node.refs if pair[0] not in _LISTS | _DERIVED]
    start += _use_single_quotes(
        _print_name(node) + _print_references(single) + _print_attributes(node.attrs)
    )
    content = _print_idrefs(inner, node.refs)
    for name, metaclass, href in node.hrefs:
        path = f"UML Standard Profile::UML2 Metamodel::PrimitiveTypes::{href.rpartition('#')[2]}"
        target = href.replace("pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml", _PRIMITIVES)
        content.append(f"{inner}<{name} href='{target}'>\n{inner}\t{_EXTENDER}\n")
        content.append(f"{inner}\t\t<referenceExtension referentPath='{path}'")
        content.append(f" referentType='{metaclass}'/>\n{inner}\t</xmi:Extension>\n")
        content.append(f"{inner}</{name}>\n")
    content += _print_texts(inner, node)
    for child in node.children:
        content += _print_magicdraw_node(child, depth + 1)
    yield from _print_element(indent, start, node, content)


def _print_idrefs(indent: str, refs: Iterable[tuple[str, tuple[str, ...]]]) -> list[str]:
    return [
        f"{indent}<{feature} xmi:idref='{mark_key(key)}'/>\n"
        for feature, keys in refs
        if feature in _LISTS
        for key in keys
    ]


def _use_single_quotes(text: str) -> str:
    return text.replace('"', "'")


def _print_magicdraw_application(application: Application) -> str:
    local = application.stereotype.partition(":")[2]
    tags = [(_CAPITALS.get((local, name), name), value) for name, value in application.tags]
    start = f"\t<sysml:{local} xmi:id='{mark_key(application.key)}' "
    start += _use_single_quotes(
        f'{application.bases[-1]}="{mark_key(application.base)}"' + _print_attributes(tags)
    )
    content = _print_idrefs("\t\t", application.refs)
    return f"{start}>\n{''.join(content)}\t</sysml:{local}>\n" if content else f"{start}/>\n"


def _print_diagrams(part: Part) -> Iterator[str]:
    """Yield the diagrams of a cell, which MagicDraw saves inside the model."""
    keys = [node.key for root in part.nodes for node in iter_subtree(root)]
    yield f"\t\t{_EXTENDER}\n\t\t\t<modelExtension>\n"
    for number in range(_DIAGRAM_COUNT):
        yield from _print_diagram(f"diagram{number}", keys)
    yield "\t\t\t</modelExtension>\n\t\t</xmi:Extension>\n"


def _print_diagram(name: str, keys: list[str]) -> Iterator[str]:
    id = mark_key(name)
    yield f"\t\t\t\t<ownedDiagram xmi:type='uml:Diagram' xmi:id='{id}' name='{name}'"
    yield f" ownerOfDiagram='{mark_key('cell')}'>\n\t\t\t\t\t{_EXTENDER}\n"
    yield "\t\t\t\t\t\t<diagramRepresentation>\n"
    yield f"\t\t\t\t\t\t\t<diagram:DiagramRepresentationObject ID='{id}' type='SysML Diagram'"
    yield " xmlns:diagram='http://www.nomagic.com/ns/magicdraw/core/diagram/1.0'>\n"
    yield "\t\t\t\t\t\t\t\t<diagramContents exporterName='MagicDraw UML'>\n"
    for key in keys:
        yield f"\t\t\t\t\t\t\t\t\t<usedObjects href='#{mark_key(key)}'/>\n"
    for key in keys:
        yield f"\t\t\t\t\t\t\t\t\t<usedElements>{mark_key(key)}</usedElements>\n"
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
    model=f"\t<uml:Model xmi:type='uml:Model' xmi:id='{mark_key('@model')}' name='Plant'>\n",
    make_id=_make_magicdraw_id,
    print_node=_print_magicdraw_node,
    print_application=_print_magicdraw_application,
    print_extension=_print_diagrams,
)

DIALECTS = {"papyrus": PAPYRUS, "magicdraw": MAGICDRAW}
