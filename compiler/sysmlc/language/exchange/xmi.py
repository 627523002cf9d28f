"""The XML of interchange files: elements as tags, attributes and references (KerML 1.0, 10.2)."""

import re
from collections.abc import Callable, Iterable, Iterator

from sysmlc.language.exchange.elements import Element
from sysmlc.language.exchange.features import stated
from sysmlc.language.metaclasses import is_a
from sysmlc.language.tree import Fact

NAMESPACE = "https://www.omg.org/spec/SysML/20250201"
_ROOT = (
    'xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    f' xmlns:sysml="{NAMESPACE}"'
)
_RELATIONSHIP, _RELATED = "ownedRelationship", "ownedRelatedElement"
_ESCAPES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#xA;", "\t": "&#x9;"}
    | {"\r": "&#xD;"}
)
FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
"""What XML 1.0 cannot have in any way."""
_REPLACEMENT = "\ufffd"
_OF_ANY_KIND = {"memberElement", "annotatedElement", "client", "supplier"}
"""Features typed by the abstract Element: a reference to another file says the metaclass."""

Targets = dict[str, list[tuple[str, str]]]
"""The targets of an element by feature: the id or the href, and for an href the metaclass."""


def lines(root: Element, targets: Callable[[Element], Targets]) -> Iterator[str]:
    """The lines of the file with this root namespace."""
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    tag = f"sysml:{root.kind}"
    stack: list[str | tuple[Element, str, str, str]] = [(root, tag, f"{tag} {_ROOT}", "")]
    while stack:
        item = stack.pop()
        if isinstance(item, str):
            yield item
        else:
            yield _begin(*item, stack, targets(item[0]))


def _begin(
    element: Element,
    tag: str,
    start: str,
    indent: str,
    stack: list[str | tuple[Element, str, str, str]],
    found: Targets,
) -> str:
    """The start tag of an element; what comes after it is put on the stack, last things first."""
    local = {name: [id for id, kind in ones if not kind] for name, ones in found.items()}
    texts = {name: _text(fact) for name, fact in element.attributes.items()}
    texts |= {name: " ".join(ids) for name, ids in local.items() if ids}
    said = "".join(f' {name}="{text.translate(_ESCAPES)}"' for name, text in texts.items())
    inner = f"{indent}  "
    hrefs = list(_hrefs(found, inner))
    begun = f'{indent}<{start} xmi:id="{element.id}" elementId="{element.id}"{said}'
    if not element.owned and not hrefs:
        return f"{begun}/>"
    stack += [f"{indent}</{tag}>", *reversed(hrefs)]
    for owned in reversed(element.owned):
        name = _tag(element, owned)
        stack.append((owned, name, f'{name} xsi:type="sysml:{owned.kind}"', inner))
    return f"{begun}>"


def _tag(element: Element, owned: Element) -> str:
    """What owns it: a plain relationship owns elements, but annotations as relationships."""
    is_plain = is_a(element.kind, "Relationship") and not is_a(element.kind, "Namespace")
    return _RELATED if is_plain and owned.kind != "Annotation" else _RELATIONSHIP


def _hrefs(found: Targets, indent: str) -> Iterable[str]:
    for name, ones in found.items():
        for href, kind in ones:
            if kind:
                type = f' xsi:type="sysml:{kind}"' if name in _OF_ANY_KIND else ""
                yield f'{indent}<{name}{type} href="{href.translate(_ESCAPES)}"/>'


def _text(fact: Fact) -> str:
    if isinstance(fact, bool):
        return "true" if fact else "false"
    return FORBIDDEN.sub(_REPLACEMENT, str(fact))


def is_writable(element: Element) -> Iterator[str]:
    """The features of the element with characters that XML cannot have."""
    for name, fact in element.attributes.items():
        if isinstance(fact, str) and name in stated(element.kind) and FORBIDDEN.search(fact):
            yield name
