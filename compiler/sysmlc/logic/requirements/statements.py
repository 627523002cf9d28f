"""Constraints of requirements, grouped by the subjects, and requirements as a model states them."""

from collections.abc import Iterable, Iterator, Mapping, Set

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.contract import Contract
from sysmlc.logic.formal_texts import is_formal, is_formal_constraint

_SUBJECTS = (*query.CLASSIFIERS, *query.BEHAVIORS)


class Statement(Struct, frozen=True):
    """A constraint of a requirement, assumed of the environment or demanded of the subject."""

    constraint: Element
    requirement: Element
    is_assumed: bool
    is_open: bool = False
    """The requirement does not separate assumptions from demands (SysML v1): a formula over inputs
    alone is then assumed.
    """
    has_demands: bool = False
    """The requirement states a demand; always false if it does not separate assumptions."""

    @property
    def language(self) -> str:
        """The language of the constraint, in small letters."""
        return _read_language(self.constraint)

    @property
    def is_temporal(self) -> bool:
        """Whether the constraint is temporal logic or a sentence of a property pattern."""
        return is_formal_constraint(self.constraint)


def collect_statements(graph: Graph) -> list[tuple[Element, list[Statement]]]:
    """Return the subjects in model order, each with the statements of all its requirements.

    A requirement about a definition applies to all its specialisations, and to the operations whose
    method the definition is. An abstract or external definition is no subject itself.
    """
    statements: dict[str, dict[str, Statement]] = {}
    for requirement in filter(query.is_requirement, graph.of_kind(Kind.CLASS)):
        new_statements = list(iter_statements(graph, requirement))
        if new_statements:
            for subject in _iter_subjects(graph, requirement):
                _merge_statements(statements.setdefault(subject.id, {}), new_statements)
    return [(graph[id], list(by_constraint.values())) for id, by_constraint in statements.items()]


def _merge_statements(by_constraint: dict[str, Statement], added: list[Statement]) -> None:
    """Add the statements of a requirement. A constraint that several requirements inherit is once.

    It belongs to the last requirement, except if that assumes more than those before: the
    constraint is demanded without the additional assumption, too.
    """
    new_assumptions = any(
        item.is_assumed and item.constraint.id not in by_constraint for item in added
    )
    for statement in added:
        if not (new_assumptions and statement.constraint.id in by_constraint):
            by_constraint[statement.constraint.id] = statement


def iter_statements(graph: Graph, requirement: Element) -> Iterator[Statement]:
    """Yield the constraints of a requirement and of those that it specialises."""
    family = (requirement, *query.generals(graph, requirement))
    is_open = not any(_separates_assumptions(graph, member) for member in family)
    constraints: list[tuple[Element, bool]] = []
    for member in family:
        assumed_ids = {constraint.id for constraint in graph.targets(member, Edge.ASSUMES)}
        constraints += (
            (element, element.id in assumed_ids or _is_marked_assumption(element))
            for element in graph.owned(member)
            if element.kind is Kind.CONSTRAINT and _has_text(element)
        )
    has_demands = not is_open and not all(is_assumed for _, is_assumed in constraints)
    for element, is_assumed in constraints:
        yield Statement(element, requirement, is_assumed, is_open, has_demands)


def _has_text(constraint: Element) -> bool:
    """Whether a constraint has a text, or a language in which an empty text is a fault."""
    language = str(constraint.attrs.get("language", ""))
    return bool(constraint.attrs.get("body")) or is_formal(language, "")


def _separates_assumptions(graph: Graph, requirement: Element) -> bool:
    """Whether the requirement states which of its constraints are assumptions."""
    has_subject = bool(graph.targets(requirement, Edge.SUBJECT))
    return has_subject or any(
        element.kind is Kind.CONSTRAINT
        and (_is_marked_assumption(element) or "require" in _read_language(element))
        for element in graph.owned(requirement)
    )


def _is_marked_assumption(constraint: Element) -> bool:
    """Whether the language of a constraint contains "assume".

    SysML v1 has no other way to mark an assumption.
    """
    return "assume" in _read_language(constraint)


def _read_language(constraint: Element) -> str:
    return str(constraint.attrs.get("language", "")).lower()


def _iter_subjects(graph: Graph, requirement: Element) -> Iterator[Element]:
    """Yield the elements that satisfy the requirement, or if there are none its declared subject.

    A usage or instance counts as its type. All specialisations follow each element.
    """
    stated = graph.sources(requirement, Edge.SATISFIES)
    if not stated:
        stated = _list_declared_subjects(graph, requirement)
    for element in stated:
        if element.kind in _SUBJECTS:
            types = [element]
        elif element.kind is Kind.INSTANCE:
            types = graph.targets(element, Edge.INSTANCE_OF)
        else:
            types = [type_ for type_ in [query.type_of(graph, element)] if type_ is not None]
        for type_ in types:
            yield from _iter_specialisations(graph, type_, set())


def _iter_specialisations(graph: Graph, type_: Element, visited: set[str]) -> Iterator[Element]:
    """Yield a type and its specialisations, each followed by the operations that it implements.

    A behaviour implements an operation as its method. *visited* are the ids of types seen before.
    """
    # A faulty model may specialise in a circle.
    if type_.id in visited:
        return
    visited.add(type_.id)
    if not type_.attrs.get("external") and not type_.attrs.get("abstract"):
        yield type_
    yield from graph.sources(type_, Edge.METHOD)
    for special in graph.sources(type_, Edge.SPECIALIZES):
        yield from _iter_specialisations(graph, special, visited)


def component_of(graph: Graph, subject: Element) -> str:
    """Return the component name of a subject; that of an operation is ``<owner>.<operation>``."""
    owner = graph.owner(subject) if subject.kind is Kind.OPERATION else None
    if owner is None:
        return query.component_name(graph, subject)
    return f"{query.component_name(graph, owner)}.{subject.name}"


def list_component_names(graph: Graph, subject: Element) -> tuple[str, ...]:
    """Return the names of a subject, of its definition and of the generals of its definition.

    A structured requirement calls its subject by one of them.
    """
    definition = query.definition_of(graph, subject)
    elements = (subject, definition, *query.generals(graph, definition))
    return tuple(dict.fromkeys(element.name for element in elements if element.name))


def list_subject_names(graph: Graph, requirement: Element) -> Iterator[str]:
    """Yield the names of the subjects that a requirement declares, and of what satisfies it.

    The name of a dependency «satisfy», too: in SysML v1, nothing else names a subject.
    """
    for member in (requirement, *query.generals(graph, requirement)):
        satisfying = (element.name for element in graph.sources(member, Edge.SATISFIES))
        names = (element.name for element in graph.sources(member, Edge.SUPPLIER))
        yield from filter(None, (str(member.attrs.get("subject_name", "")), *satisfying, *names))


def find_redefining_operation(graph: Graph, subject: Element) -> Element | None:
    """Return *subject* if it is an operation that redefines parameters of its method, else None."""
    if subject.kind is not Kind.OPERATION:
        return None
    parameters = query.parameters(graph, subject)
    is_redefining = any(graph.targets(parameter, Edge.REDEFINES) for parameter in parameters)
    return subject if is_redefining else None


# -- stated requirements ---------------------------------------------------------------------------

_NO_SUBJECT = "the requirement has no subject, and no element satisfies it"
_LIBRARY_SUBJECT = "no element of the model satisfies it or specialises its subject '{subject}'"
_ONLY_TEXT = "not formalised: the requirement is only text"


class StatedRequirement(Struct, frozen=True):
    """A required constraint: its requirement, the component that has to satisfy it, its text.

    ``reason`` tells why the constraint is in no contract, or why nothing can be checked against
    it; it is empty if neither is so. A requirement without constraints has itself as its only
    constraint.
    """

    name: str
    """Qualified name of the requirement."""
    component: str
    constraint: str
    """Id of the constraint."""
    text: str
    reason: str = ""
    is_formal: bool = True
    """False for a requirement that is only text."""


def list_stated_requirements(
    graph: Graph,
    contracts: Iterable[Contract],
    reasons: Mapping[str, str],
    unused: Set[str] = frozenset(),
) -> Iterator[StatedRequirement]:
    """Yield the required constraints of each subject, then those of requirements without subject.

    Requirements that are only text follow. *reasons* are messages about constraints, by the id of
    the constraint. Nothing is listed about *unused* elements of libraries.
    """
    contracts = list(contracts)
    described = {contract.origin for contract in contracts}
    origins = {
        conjunct.origin
        for contract in contracts
        for conjunct in (*contract.assumptions, *contract.guarantees)
    }
    listed: set[str] = set()
    for subject, statements in collect_statements(graph):
        gap = _find_gap(graph, subject, described)
        for statement in statements:
            constraint = statement.constraint
            listed.add(constraint.id)
            if statement.is_assumed or subject.id in unused:
                continue
            reason = reasons.get(constraint.id, "the contract of its subject cannot express it")
            yield StatedRequirement(
                graph.qualified_name(statement.requirement),
                component_of(graph, subject),
                constraint.id,
                str(constraint.attrs.get("body", "")).strip(),
                gap if constraint.id in origins else reason,
            )
    requirements = [
        requirement
        for requirement in filter(query.is_requirement, graph.of_kind(Kind.CLASS))
        if _is_relevant(graph, requirement, unused)
    ]
    for requirement in requirements:
        reason = _explain_missing_subject(graph, requirement)
        for statement in iter_statements(graph, requirement):
            if statement.constraint.id not in listed and not statement.is_assumed:
                listed.add(statement.constraint.id)
                yield StatedRequirement(
                    graph.qualified_name(requirement),
                    "",
                    statement.constraint.id,
                    str(statement.constraint.attrs.get("body", "")).strip(),
                    reason,
                )
    for requirement in requirements:
        if is_only_text(graph, requirement):
            yield _describe_text(graph, requirement)


def _is_relevant(graph: Graph, requirement: Element, unused: Set[str]) -> bool:
    """Whether a requirement or its subject belongs to the model or is used by it."""
    subjects = _list_declared_subjects(graph, requirement)
    return requirement.id not in unused or any(subject.id not in unused for subject in subjects)


def _list_declared_subjects(graph: Graph, requirement: Element) -> list[Element]:
    """Return the subjects that a requirement declares, or that its nearest general declares."""
    family = (requirement, *query.generals(graph, requirement))
    declared = (graph.targets(member, Edge.SUBJECT) for member in family)
    return next(filter(None, declared), [])


def _find_gap(graph: Graph, subject: Element, described: Set[str]) -> str:
    """Return that a state machine of the subject has no contract, or nothing if each has one."""
    family = (subject, *query.generals(graph, subject))
    machines = (
        element
        for member in family
        for element in graph.owned(member)
        if element.kind is Kind.STATE_MACHINE and element.id not in described
    )
    machine = next(machines, None)
    return (
        ""
        if machine is None
        else f"state machine '{machine.name}' has no contract (see 'sysmlc check')"
    )


def is_only_text(graph: Graph, requirement: Element) -> bool:
    """Whether a requirement of the model has a text and no required constraint.

    The text of a definition is that of its usages, and counts for these only.
    """
    statements = iter_statements(graph, requirement)
    usages = filter(query.is_requirement, graph.sources(requirement, Edge.SPECIALIZES))
    return (
        bool(query.requirement_text(graph, requirement))
        and all(str(usage.attrs.get("text", "")).strip() for usage in usages)
        and not requirement.attrs.get("external")
        and all(statement.is_assumed for statement in statements)
    )


def list_texts_about(graph: Graph, element: Element) -> list[Element]:
    """Return the requirements that are only text and that an element satisfies or is subject of.

    The usages of a definition follow it, because they have its subject.
    """
    candidates = [*graph.targets(element, Edge.SATISFIES), *graph.sources(element, Edge.SUBJECT)]
    requirements: dict[str, None] = {}
    for item in candidates:
        if query.is_requirement(item) and item.id not in requirements:
            requirements[item.id] = None
            candidates += graph.sources(item, Edge.SPECIALIZES)
    return [graph[id] for id in requirements if is_only_text(graph, graph[id])]


def _explain_missing_subject(graph: Graph, requirement: Element) -> str:
    subject = next(iter(_list_declared_subjects(graph, requirement)), None)
    if subject is None or not subject.attrs.get("external"):
        return _NO_SUBJECT
    return _LIBRARY_SUBJECT.format(subject=graph.qualified_name(subject))


def _describe_text(graph: Graph, requirement: Element) -> StatedRequirement:
    subject = next(_iter_subjects(graph, requirement), None)
    return StatedRequirement(
        graph.qualified_name(requirement),
        "" if subject is None else component_of(graph, subject),
        requirement.id,
        query.requirement_text(graph, requirement),
        _ONLY_TEXT,
        is_formal=False,
    )
