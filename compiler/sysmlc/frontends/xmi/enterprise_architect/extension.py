"""What Enterprise Architect keeps beside the model: notes, tagged values, stereotypes.

Its extension repeats most of the model. Read are notes (as comments), constraints, tagged values
without a stereotype, and stereotypes without an application; the rest is notation.
"""

import re
from collections import deque
from collections.abc import Callable, Iterator

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.enterprise_architect.constraints import constraints
from sysmlc.frontends.xmi.enterprise_architect.profiles import id_of, qualified
from sysmlc.frontends.xmi.profiles import mangled
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.identity import derived_id

_STEREOTYPE = re.compile(r"@STEREO;(.*?)@ENDSTEREO", re.DOTALL)
_PREFIX = "EAID_"
_LISTS = ("elements", "connectors", "attributes", "operations", "parameters")
"""What holds descriptions of elements, by which they are nested."""


def finish(context: Context) -> None:
    """Read what the extensions say of elements; applications must be in the graph already."""
    waiting = deque(row for extension in context.extensions for row in _parts(context, extension))
    while waiting:
        row = waiting.popleft()
        _element(context, row)
        waiting.extend(_parts(context, row))


def _element(context: Context, row: int) -> None:
    document = context.document
    id = document.idref(row)
    _details(context, row, id)
    for holder, ends in (("source", "src"), ("target", "dst")):
        for end in document.children(row, holder):
            # An end has the id of the connector with its first two digits replaced.
            _details(context, end, f"{_PREFIX}{ends}{id[len(_PREFIX) + 2 :]}")


def _parts(context: Context, row: int) -> Iterator[int]:
    document = context.document
    for features in _LISTS:
        for holder in document.children(row, features):
            yield from document.children(holder)


def _details(context: Context, row: int, id: str) -> None:
    place = context.unit.find(context.lowered, id, False)
    element = context.graph.get(place[0].gids[place[1]]) if place else None
    if element is None or place is None:
        return
    if not place[0].own[place[1]]:
        _note_on_part(context, element, row, id)
        return
    for child in context.document.children(row):
        reader = _DETAILS.get(context.document.features[child])
        if reader is not None:
            reader(context, element, child)


def _note_on_part(context: Context, element: Element, row: int, id: str) -> None:
    """A note on what is no element of its own (an event, say) is one on the element around it."""
    for feature in ("properties", "documentation"):
        for child in context.document.children(row, feature):
            _note(context, element, child, id)


def _note(context: Context, element: Element, row: int, about: str = "") -> None:
    values = context.document.attributes[row]
    text = values.get("value") or values.get("documentation", "")
    if text:
        context.verdicts[row] = Verdict.MAPPED
    if text and not any(_says(one, text) for one in context.graph.owned(element)):
        id = derived_id(about or element.id, "documentation")
        note = Element(id, Kind.COMMENT, "", element.id, *_place(context, row))
        note.attrs["body"] = text
        context.graph.add(note)
        context.graph.connect(Edge.REFERENCES, note, element)


def _says(comment: Element, text: str) -> bool:
    return comment.kind is Kind.COMMENT and comment.attrs.get("body") == text


def _tags(context: Context, element: Element, row: int) -> None:
    for tag in context.document.children(row):
        values = context.document.attributes[tag]
        name, value = values.get("name", ""), values.get("value", "")
        if name and value:
            context.verdicts[tag] = Verdict.MAPPED
            if not any(_has_tag(one, name) for one in _applications(context, element)):
                key = f"tag.{name.rpartition('::')[2]}"
                element.attrs[key] = id_of(context, value) or value


def _has_tag(application: Element, name: str) -> bool:
    short = mangled(name.rpartition("::")[2])
    return any(f"tag.{tag}" in application.attrs for tag in (name, mangled(name), short))


def _references(context: Context, element: Element, row: int) -> None:
    text = context.document.attributes[row].get("value", "")
    for written in _STEREOTYPE.findall(text):
        context.verdicts[row] = Verdict.MAPPED
        facts = dict(fact.partition("=")[::2] for fact in written.split(";"))
        _apply(context, element, row, facts.get("FQName") or facts.get("Name", ""))


def _apply(context: Context, element: Element, row: int, whole: str) -> None:
    name, namespace = qualified(context, whole)
    known = {mangled(one.name) for one in _applications(context, element)}
    if not name or mangled(name) in known:
        return
    id = derived_id(element.id, f"{mangled(name)}[{context.document.ordinals[row]}]")
    made = Element(id, Kind.APPLICATION, name, element.id, *_place(context, row))
    made.attrs["stereotype"], made.attrs["namespace"] = name, namespace
    context.graph.add(made)
    context.graph.connect(Edge.SUBJECT, made, element)
    defined = context.unit.profiles.find(context.graph, namespace, name)
    if defined is not None:
        context.graph.connect(Edge.INSTANCE_OF, made, defined)


def _applications(context: Context, element: Element) -> list[Element]:
    return [one for one in context.graph.owned(element) if one.kind is Kind.APPLICATION]


def _place(context: Context, row: int) -> tuple[int, str]:
    return context.document.ordinals[row], context.document.name


_DETAILS: dict[str, Callable[[Context, Element, int], None]] = {
    "constraints": constraints,
    "properties": _note,
    "documentation": _note,
    "tags": _tags,
    "xrefs": _references,
}
"""Readers of what stands in an element, attribute, operation, parameter, connector or end."""
