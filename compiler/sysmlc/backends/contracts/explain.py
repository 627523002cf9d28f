"""The contract page: variables, assumptions and guarantees, each with its element.

All text that comes from the model is escaped here, so that templates need not do it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from functools import cache

from msgspec import Struct

from sysmlc.backends.templates import Templates
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic.contract import Class, Conjunct, Contract, Variable
from sysmlc.logic.domains import describe
from sysmlc.logic.printing import print_formula
from sysmlc.support.escapes import escape_code, escape_markdown

_SHIPPED = Templates("contracts", None)
_TITLES = {
    Class.INIT: "At the start",
    Class.SAFETY: "In every step",
    Class.LIVENESS: "Again and again",
    Class.OTHER: "In temporal logic",
}
_PREFIXES = {
    "at_": "a token is on the flow",
    "run_": "the action is running",
    "done_": "the environment says that it is done",
    "receive_": "the signal comes",
    "send_": "the signal is sent",
    "do_": "the behaviour of the state is being done",
    "ticks_": "steps that the state has been active",
    "taken_": "which of several possible transitions was taken",
    "last_": "what the region was when it was last active",
    "was_": "what the condition was in the step before",
}
"""What variables of diagrams begin with, up to the first ``_``."""
_UNSET = re.compile(r"!\w+$")
_MANY = 3
_CONSTRAINT = Kind.CONSTRAINT
_FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
_MARKUP = re.compile(r"[<>`|\[\]]")
"""What would not be shown as it is written."""


class Row(Struct, frozen=True):
    """One variable or conjunct as the template shows it, as Markdown.

    ``formula`` is the content of a code span between single backticks.
    """

    formula: str
    text: str
    element: str
    place: str


class Section(Struct, frozen=True):
    """Conjuncts of one class; ``unset`` are Booleans that are only false, when there are many."""

    title: str
    rows: tuple[Row, ...]
    unset: tuple[Row, ...] = ()


class Page(Struct, frozen=True):
    """Everything that the template needs."""

    component: str
    element: str
    place: str
    inputs: tuple[Row, ...]
    outputs: tuple[Row, ...]
    assumptions: tuple[Section, ...]
    guarantees: tuple[Section, ...]
    words: str = ""
    """What variables mean whose names begin alike."""
    about: str = ""
    """What the author says of the component."""


def explain(graph: Graph, contract: Contract, templates: Templates = _SHIPPED) -> str:
    """Return the contract as Markdown. Raises TemplateError."""
    return templates.render("contract.md.j2", page=_page(graph, contract))


_Told = Callable[[str], tuple[str, str]]
"""The element with an id in words, and the file that it stands in."""


def _page(graph: Graph, contract: Contract) -> Page:
    owned = {owner: [v for v in contract.variables if v.owner == owner] for owner in ("env", "sys")}
    told = cache(lambda id: (escape_markdown(_name(graph, id)), escape_code(_place(graph, id))))
    return Page(
        escape_markdown(contract.component),
        *told(contract.origin),
        tuple(_variable(told, one) for one in owned["env"]),
        tuple(_variable(told, one) for one in owned["sys"]),
        _sections(graph, told, contract.assumptions),
        _sections(graph, told, contract.guarantees),
        "; ".join(_words(contract)),
        escape_markdown(_about(graph, contract)),
    )


def _about(graph: Graph, contract: Contract) -> str:
    """The first paragraph of the author's comment on the component, or on what it is one of."""
    for one in _said_of(graph, graph[contract.origin]):
        comments = (
            each for each in graph.sources(one, Edge.REFERENCES) if each.kind is Kind.COMMENT
        )
        text = next((str(each.attrs.get("body", "")) for each in comments), "")
        paragraph = " ".join(text.strip().partition("\n\n")[0].split())
        if paragraph and not _MARKUP.search(paragraph):
            return paragraph
    return ""


def _said_of(graph: Graph, origin: Element) -> list[Element]:
    """The component, the method of an operation, and what these alone specialise."""
    found = [origin]
    for one in found:
        edge = Edge.METHOD if one.kind is Kind.OPERATION else Edge.SPECIALIZES
        above = graph.targets(one, edge)
        found += above if len(above) == 1 and above[0] not in found else []
    return found


def _words(contract: Contract) -> Iterator[str]:
    """What the names say that stand for something of the diagram, not for a feature."""
    begun = {one.name[: one.name.find("_") + 1] for one in contract.variables}
    for prefix, said in _PREFIXES.items():
        if prefix in begun:
            yield f"`{prefix}...`: {said}"


def _variable(told: _Told, variable: Variable) -> Row:
    name = escape_code(variable.name, in_table=True)
    return Row(name, escape_markdown(describe(variable.domain)), *told(variable.origin))


def _sections(graph: Graph, told: _Told, conjuncts: Iterable[Conjunct]) -> tuple[Section, ...]:
    rows: dict[Class, list[Row]] = {class_: [] for class_ in Class}
    for one in conjuncts:
        rows[one.class_].append(_row(graph, told, one))
    return tuple(_section(c, found) for c, found in rows.items() if found)


def _row(graph: Graph, told: _Told, one: Conjunct) -> Row:
    """A conjunct; what a constraint demands has the author's name for it, where it has one."""
    formula, (element, place) = escape_code(print_formula(one.formula)), told(one.origin)
    said = graph.get(one.origin)
    is_named = said is not None and said.kind is _CONSTRAINT and bool(said.name)
    if said is None or not is_named or one.text.partition("' ")[0] != f"'{said.name}":
        return Row(formula, escape_markdown(one.text), element, place)
    text = f"{said.name[:1].upper()}{said.name[1:]}."
    owner = graph.owner(said)
    where = one.viewpoint or ("" if owner is None else owner.name)
    kind = "requirement" if one.viewpoint else "constraint of"
    return Row(formula, escape_markdown(text), escape_markdown(f"{kind} '{where}'"), place)


def _section(class_: Class, rows: list[Row]) -> Section:
    unset = [one for one in rows if _UNSET.match(one.formula)] if class_ is Class.INIT else []
    if len(unset) < _MANY:
        return Section(_TITLES[class_], tuple(rows))
    hidden = {*map(id, unset)}
    shown = tuple(one for one in rows if id(one) not in hidden)
    names = tuple(Row(one.formula[1:], one.text, one.element, one.place) for one in unset)
    return Section(_TITLES[class_], shown, names)


def _name(graph: Graph, id: str) -> str:
    """The element in words: ``transition 'Idle' to 'Busy'``, ``property 'bay' of 'Gate'``."""
    element = graph.get(id)
    if element is None:
        return ""
    kind = _in_words(element.kind)
    if element.kind is Kind.TRANSITION or (element.kind in _FLOWS and not element.name):
        ends = [graph.target(element, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
        return f"{kind} {' to '.join(_quote(_end(graph, end)) for end in ends if end is not None)}"
    owner = next((up for up in graph.ancestors(element) if up.name), None)
    of = "" if owner is None or owner.kind is Kind.PACKAGE else f" of '{owner.name}'"
    return f"{kind} '{element.name}'{of}" if element.name else f"{kind}{of}"


@cache
def _in_words(kind: str) -> str:
    return re.sub(r"(?<!^)(?=[A-Z])", " ", kind).lower()


def _end(graph: Graph, end: Element) -> Element:
    """What a flow leads to, as it is called: of a pin the action that has it."""
    owner = graph.owner(end) if end.kind is Kind.PIN else None
    return owner or end


def _quote(vertex: Element) -> str:
    return f"'{vertex.name}'" if vertex.name else vertex.subkind or "its end"


def _place(graph: Graph, id: str) -> str:
    element = graph.get(id)
    return "" if element is None or not element.source else element.source
