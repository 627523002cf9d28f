"""The page of a contract: variables, assumptions and guarantees, each with its element.

All text of the model is escaped here, so that templates need not do it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.backends.activity_summaries import ActivitySummary
from sysmlc.backends.templates import Templates
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.compare.titles import separate_words
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Class, Conjunct, Contract, Variable
from sysmlc.logic.domains import describe, regions_of
from sysmlc.logic.expressions.named_elements import VALUE_KINDS
from sysmlc.logic.feature_writes import iter_writes
from sysmlc.logic.formula import rename_variables
from sysmlc.logic.formula import variables as list_variables
from sysmlc.logic.printing import print_formula
from sysmlc.logic.region_formulas import describe_literals, word_regions
from sysmlc.logic.regions import print_quantity
from sysmlc.logic.requirements.statements import list_texts_about
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
    "done_": "the environment reports that it is done",
    "receive_": "the signal is received",
    "send_": "the signal is sent",
    "do_": "the do behaviour of the state is running",
    "ticks_": "steps for which the state has been active",
    "taken_": "which of several possible transitions was taken",
    "last_": "the state of the region when it was last active",
    "was_": "whether the condition held in the previous step",
}
"""Meanings of variables that stand for a part of a diagram, by the start of their names."""
_UNSET = re.compile(r"!(\w+|running\([\w.]+\)|finished\([\w.]+\))$")
"""The formula of a Boolean that is false."""
_MANY_UNSET = 3
"""From this number on, Booleans that are initially false are one item with a list."""
_SIGNALS = ("send_", "receive_")
"""Prefixes of variables that are true when a signal is sent or received."""
_NOTHING_TO_STATE = (
    "No guarantee is about a feature or a signal: the behaviour only orders its actions; it "
    "assigns no feature, tests none in a guard, and exchanges no signals."
)
_FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
_MARKUP = re.compile(r"[<>`|\[\]]")
"""Characters of a comment that Markdown would not show as they are written."""


class Row(Struct, frozen=True):
    """A variable or conjunct in the table of the template; the texts are Markdown.

    ``formula`` is the content of a code span between single backticks.
    """

    formula: str
    text: str
    element: str
    place: str


class Section(Struct, frozen=True):
    """Conjuncts of one class; many Booleans that are initially false are listed in ``unset``."""

    title: str
    rows: tuple[Row, ...]
    unset: tuple[Row, ...] = ()


class Page(Struct, frozen=True):
    """The values of the template ``contract.md.j2``."""

    component: str
    element: str
    place: str
    inputs: tuple[Row, ...]
    outputs: tuple[Row, ...]
    assumptions: tuple[Section, ...]
    guarantees: tuple[Section, ...]
    words: str = ""
    """Meanings of variables whose names have a common prefix."""
    about: str = ""
    """The author's comment on the component."""
    texts: tuple[str, ...] = ()
    """Requirements on the component that are only text."""
    reason: str = ""
    """Why no guarantee is about a feature or a signal; empty if one is."""
    summary: tuple[str, ...] = ()
    """What an activity does, in sentences; empty for other components."""


def print_page(graph: Graph, contract: Contract, templates: Templates = _SHIPPED) -> str:
    """Return the page of a contract. Raises TemplateError."""
    return templates.render("contract.md.j2", page=_PageBuilder(graph).build_page(contract))


class _PageBuilder:
    """Builds the page of one contract; the texts of elements are computed once."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._labels: dict[str, tuple[str, str]] = {}
        self._wordings: dict[str, str] = {}
        """Names in formulas of the author, by variable."""
        self._numbers: tuple[Variable, ...] = ()

    def build_page(self, contract: Contract) -> Page:
        variables = contract.variables
        self._numbers = tuple(item for item in variables if regions_of(item.domain) is not None)
        self._wordings = contract.wordings
        element, place = self._label_element(contract.origin)
        return Page(
            escape_markdown(contract.component),
            element,
            place,
            tuple(self._build_variable(v) for v in variables if v.owner == "env"),
            tuple(self._build_variable(v) for v in variables if v.owner == "sys"),
            self._build_sections(contract.assumptions),
            self._build_sections(contract.guarantees),
            "; ".join(_explain_prefixes(contract)),
            escape_markdown(_find_author_comment(self._graph, contract)),
            tuple(_list_texts(self._graph, contract)),
            escape_markdown(_explain_missing_features(self._graph, contract)),
            self._summarise(contract),
        )

    def _summarise(self, contract: Contract) -> tuple[str, ...]:
        """Return the paragraphs about an activity, or nothing for another component.

        The contract of the requirements of an activity says nothing about its steps.
        """
        games = (
            game
            for game in self._graph.derived(TokenGraph)
            if game.activity == contract.origin and game.component == contract.component
        )
        game = next(games, None)
        return () if game is None else tuple(ActivitySummary(game, contract).iter_paragraphs())

    def _label_element(self, id: str) -> tuple[str, str]:
        """Return the description of an element, and the file that contains it, as Markdown."""
        if id not in self._labels:
            element = self._graph.get(id)
            source = element.source if element is not None else ""
            name = _describe_element(self._graph, element) if element is not None else ""
            self._labels[id] = escape_markdown(name), escape_code(source or "")
        return self._labels[id]

    def _build_variable(self, variable: Variable) -> Row:
        name = escape_code(variable.wording or variable.name, in_table=True)
        domain = _describe_numbers(variable) or escape_markdown(describe(variable.domain))
        if variable.is_range_assumed:
            domain += " (assumed)"
        if variable.condition:
            domain += f", stands for `{escape_code(variable.condition, in_table=True)}`"
        if variable.reason:
            domain += f", which has no formula: {escape_markdown(variable.reason)}"
        if variable.wording:
            domain += f"; `{escape_code(variable.name, in_table=True)}` in the other files"
        return Row(name, domain, *self._label_element(variable.origin))

    def _build_sections(self, conjuncts: Iterable[Conjunct]) -> tuple[Section, ...]:
        rows: dict[Class, list[Row]] = {class_: [] for class_ in Class}
        for conjunct in conjuncts:
            rows[conjunct.class_].append(self._build_conjunct(conjunct))
        return tuple(_build_section(class_, rows[class_]) for class_ in Class if rows[class_])

    def _build_conjunct(self, conjunct: Conjunct) -> Row:
        """Build the row of a conjunct.

        The text of a conjunct from a named constraint begins with the quoted name. The row shows
        the name as a sentence instead, and the requirement or owner of the constraint as element.
        """
        worded = word_regions(conjunct.formula, self._numbers)
        named = conjunct.wording or rename_variables(worded, self._wordings)
        formula = escape_code(print_formula(named))
        element, place = self._label_element(conjunct.origin)
        constraint = self._graph.get(conjunct.origin)
        is_stated = conjunct.text.endswith(("demands it.", "assumes it."))
        sentence = _find_sentence(self._graph, constraint) if constraint and is_stated else ""
        if (
            constraint is None
            or constraint.kind is not Kind.CONSTRAINT
            or not constraint.name
            or conjunct.text.partition("' ")[0] != f"'{constraint.name}"
        ):
            text = f"{sentence} {conjunct.text}".strip()
            return Row(formula, escape_markdown(text), element, place)
        text = f"{constraint.name[:1].upper()}{constraint.name[1:]}. {sentence}".strip()
        owner = self._graph.owner(constraint)
        context = conjunct.viewpoint or ("" if owner is None else owner.name)
        kind = "requirement" if conjunct.viewpoint else "constraint of"
        return Row(formula, escape_markdown(text), escape_markdown(f"{kind} '{context}'"), place)


def _describe_numbers(variable: Variable) -> str:
    """Return the conditions for which the literals of a number stand; empty for other variables.

    The values of the constants in the conditions follow.
    """
    regions = regions_of(variable.domain)
    if regions is None:
        return ""
    conditions = (
        f"`{literal}`: `{escape_code(condition, in_table=True)}`"
        for literal, condition in describe_literals(variable)
    )
    values = (
        f"; `{escape_code(word, in_table=True)}` = {print_quantity(number, regions.symbol)}"
        for number, word in regions.labels
        if word.isidentifier()
    )
    return ", ".join(conditions) + "".join(values)


def _build_section(class_: Class, rows: list[Row]) -> Section:
    unset = [row for row in rows if _UNSET.match(row.formula)] if class_ is Class.INIT else []
    if len(unset) < _MANY_UNSET:
        return Section(_TITLES[class_], tuple(rows))
    shown = tuple(row for row in rows if not _UNSET.match(row.formula))
    names = tuple(Row(row.formula[1:], row.text, row.element, row.place) for row in unset)
    return Section(_TITLES[class_], shown, names)


def _explain_prefixes(contract: Contract) -> Iterator[str]:
    """Yield the meaning of each prefix of variable names that the contract contains."""
    names = [v.name for v in contract.variables if not v.wording]
    prefixes = {name[: name.find("_") + 1] for name in names}
    for prefix, meaning in _PREFIXES.items():
        if prefix in prefixes:
            yield f"`{prefix}...`: {meaning}"


def _explain_missing_features(graph: Graph, contract: Contract) -> str:
    """Return why no guarantee is about a feature or a signal, in a sentence; empty if one is."""
    formulas = (conjunct.formula for conjunct in contract.guarantees)
    used = {variable.name for formula in formulas for variable in list_variables(formula)}
    for variable in contract.variables:
        origin = graph.get(variable.origin)
        is_signal = variable.name.startswith(_SIGNALS) or variable.name.endswith("event")
        is_feature = origin is not None and origin.kind in VALUE_KINDS
        if variable.name in used and (is_feature or is_signal):
            return ""
    actions = (item for item in graph.subtree(graph[contract.origin]) if item.kind is Kind.ACTION)
    names = dict.fromkeys(write.name for action in actions for write in iter_writes(graph, action))
    if not names:
        return _NOTHING_TO_STATE
    listed = ", ".join(f"'{name}'" for name in names)
    return (
        f"No guarantee is about a feature or a signal: {listed} has no known value, no finite "
        "range, or other writers."
    )


def _find_sentence(graph: Graph, constraint: Element) -> str:
    """Return the sentence of the author behind a formula, or nothing.

    It is the text of the constraint if that is a sentence, else that of the requirement.
    """
    language = str(constraint.attrs.get("language", "")).lower()
    text = str(constraint.attrs.get("body", ""))
    if constraint.kind is not Kind.CONSTRAINT:
        return ""
    if not any(name in language for name in ("fret", "english", "pattern")):
        owner = graph.owner(constraint)
        text = "" if owner is None else query.requirement_text(graph, owner)
    sentence = " ".join(text.split())
    return sentence if not sentence or sentence.endswith((".", "!", "?")) else f"{sentence}."


def _list_texts(graph: Graph, contract: Contract) -> Iterator[str]:
    """Yield id, name and text of the requirements on a component that are only text."""
    origin = graph[contract.origin]
    owner = graph.owner(origin) if origin.kind is Kind.STATE_MACHINE else None
    for element in (origin,) if owner is None else (origin, owner):
        for requirement in list_texts_about(graph, element):
            text = " ".join(query.requirement_text(graph, requirement).split())
            id = query.requirement_id(graph, requirement)
            yield escape_markdown(f"{id} {requirement.name}: {text}".strip())


# -- comments of the author ----------------------------------------------------------------------


def _find_author_comment(graph: Graph, contract: Contract) -> str:
    """Return the first paragraph of a comment on the component or on its only generalization."""
    for element in _list_documented_elements(graph, graph[contract.origin]):
        annotations = graph.sources(element, Edge.REFERENCES)
        comments = (comment for comment in annotations if comment.kind is Kind.COMMENT)
        text = next((str(comment.attrs.get("body", "")) for comment in comments), "")
        paragraph = " ".join(text.strip().partition("\n\n")[0].split())
        if paragraph and not _MARKUP.search(paragraph):
            return paragraph
    return ""


def _list_documented_elements(graph: Graph, origin: Element) -> list[Element]:
    """Return the component, then the operation's method or the generalizations, nearest first.

    An element with several generalizations ends the list: none of them describes it alone.
    """
    elements = [origin]
    for element in elements:
        edge = Edge.METHOD if element.kind is Kind.OPERATION else Edge.SPECIALIZES
        targets = graph.targets(element, edge)
        if len(targets) == 1 and targets[0] not in elements:
            elements.append(targets[0])
    return elements


# -- elements in words -------------------------------------------------------------------------


def _describe_element(graph: Graph, element: Element) -> str:
    """Return ``transition 'Idle' to 'Busy'`` or ``property 'bay' of 'Gate'``, for example."""
    kind = separate_words(element.kind)
    if element.kind is Kind.TRANSITION or (element.kind in _FLOWS and not element.name):
        ends = (graph.target(element, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET))
        return f"{kind} {' to '.join(_name_end(graph, end) for end in ends if end is not None)}"
    owner = next((ancestor for ancestor in graph.ancestors(element) if ancestor.name), None)
    suffix = "" if owner is None or owner.kind is Kind.PACKAGE else f" of '{owner.name}'"
    return f"{kind} '{element.name}'{suffix}" if element.name else f"{kind}{suffix}"


def _name_end(graph: Graph, end: Element) -> str:
    """Return the name of an end of a flow; a pin has the name of its action."""
    owner = graph.owner(end) if end.kind is Kind.PIN else None
    vertex = owner or end
    return f"'{vertex.name}'" if vertex.name else vertex.subkind or "its end"
