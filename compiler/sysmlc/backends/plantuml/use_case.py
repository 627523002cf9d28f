"""Use case diagrams: one for each package that owns use cases (UML 2.5.1 clause 18.1.5)."""

from collections.abc import Iterator, Sequence

from sysmlc.backends.plantuml import labels, partitioning
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.relations import Relation, relations
from sysmlc.backends.plantuml.views import Diagram, Figure, Line, Note, SubjectView, UseCaseView
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.plantuml_text import keyword_label, label, lines, padded, plain, small, stack

FIGURES = (Kind.USE_CASE, Kind.ACTOR)
_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)
_ROWS = (Kind.PROPERTY, Kind.OPERATION, Kind.CONSTRAINT)
_WIDTH = 28


def diagrams(graph: Graph) -> Iterator[Diagram]:
    """All use case diagrams, in the order of the packages."""
    cases = [item for item in graph.of_kind(Kind.USE_CASE) if not item.attrs.get("external")]
    homes: dict[str | None, list[Element]] = {}
    for case in cases:
        homes.setdefault(labels.home(graph, case), []).append(case)
    every = _relations(graph) if cases else []
    for package, own in homes.items():
        yield from _of_package(graph, graph.get(package), own, every)


def actors(graph: Graph) -> set[str]:
    """Actors that use case diagrams show and that have nothing more for other diagrams."""
    homes = {labels.home(graph, case) for case in graph.of_kind(Kind.USE_CASE)}
    if not homes:
        return set()
    found = {
        item.id
        for item in graph.of_kind(Kind.ACTOR)
        if labels.home(graph, item) in homes and not any(o.kind in _ROWS for o in graph.owned(item))
    }
    for relation in relations(graph):
        ends = {relation.source, relation.target}
        if any(graph[id].kind not in FIGURES for id in ends):
            found -= ends
    return found


def _relations(graph: Graph) -> list[Relation]:
    """Lines between use cases and actors."""
    from sysmlc.backends.plantuml.relations import use_case_relations

    between = [*relations(graph), *use_case_relations(graph)]
    return [r for r in between if {graph[r.source].kind, graph[r.target].kind} <= set(FIGURES)]


def _of_package(
    graph: Graph, package: Element | None, own: list[Element], every: Sequence[Relation]
) -> Iterator[Diagram]:
    at_home = package.id if package is not None else None
    alone = [one for one in graph.of_kind(Kind.ACTOR) if labels.home(graph, one) == at_home]
    parts = partitioning.chunks([item.id for item in own], _near(own, every))
    whole = graph.qualified_name(package) if package is not None else "model"
    for index, part in enumerate(parts):
        shown = [graph[id] for id in part]
        inside = [r for r in every if {r.source, r.target} & _with(part, alone, every)]
        yield Diagram(
            kind="uc",
            name=partitioning.numbered(whole, index, len(parts)),
            frame=plain(f"uc [package] {whole}"),
            heading=("Use case diagram", whole),
            view=view(graph, shown, alone if index == 0 else [], inside),
            about=package.id if package is not None else "",
            footer=plain(partitioning.footer(index, len(parts), whole)),
        )


def _near(own: list[Element], every: Sequence[Relation]) -> dict[str, list[str]]:
    near: dict[str, list[str]] = {item.id: [] for item in own}
    for relation in every:
        for one, other in ((relation.source, relation.target), (relation.target, relation.source)):
            if one in near and one != other:
                near[one].append(other)
    return near


def _with(part: list[str], alone: list[Element], every: Sequence[Relation]) -> set[str]:
    """The part, and actors of the package that nothing ties to other parts."""
    tied = {id for relation in every for id in (relation.source, relation.target)}
    return {*part, *(actor.id for actor in alone if actor.id in tied)}


# -- figures -----------------------------------------------------------------------------------


def view(
    graph: Graph, cases: list[Element], alone: list[Element], inside: list[Relation]
) -> UseCaseView:
    """Use cases in their subjects, actors, and the lines between them."""
    aliases = Aliases()
    tied = [graph[id] for r in inside for id in (r.source, r.target)]
    shown = list(dict.fromkeys([*cases, *alone, *tied]))
    own = {item.id for item in (*cases, *alone)}
    figures = {item.id: _figure(graph, item, aliases, item.id in own) for item in shown}
    groups: dict[str | None, list[Figure]] = {}
    for item in shown:
        if item.kind is Kind.USE_CASE:
            subject = _subject(graph, item)
            groups.setdefault(subject.id if subject else None, []).append(figures[item.id])
    return UseCaseView(
        tuple(figures[item.id] for item in shown if item.kind is Kind.ACTOR),
        tuple(_frame(graph[id], group, aliases) for id, group in groups.items() if id),
        tuple(groups.get(None, ())),
        tuple(_line(relation, aliases) for relation in inside),
        tuple(_notes(graph, shown, aliases)),
    )


def _subject(graph: Graph, case: Element) -> Element | None:
    """What the use case is about: its subject, else the classifier that owns it."""
    owner = graph.owner(case)
    nested = owner if owner is not None and owner.kind not in _PACKAGES else None
    return graph.target(case, Edge.SUBJECT) or nested


def _frame(subject: Element, cases: list[Figure], aliases: Aliases) -> SubjectView:
    name = stack(f"**{row}**" for row in lines(labels.name(subject)))
    return SubjectView(aliases.make(subject.id, subject.name, "subject"), name, tuple(cases))


def _figure(graph: Graph, item: Element, aliases: Aliases, is_own: bool) -> Figure:
    is_case = item.kind is Kind.USE_CASE
    owned = [one for one in graph.owned(item) if one.kind in _ROWS] if is_own else []
    points = [one for one in graph.owned(item) if one.kind is Kind.EXTENSION_POINT]
    alias = aliases.make(item.id, item.name, "case" if is_case else "actor")
    rows = [_title(graph, item), *_compartments(graph, item, owned, points)]
    shows = (item.id, *(one.id for one in (*owned, *points)))
    style = "" if is_own else "elsewhere"
    return Figure(alias, stack(rows), "usecase" if is_case else "actor", style, shows)


def _title(graph: Graph, item: Element) -> str:
    words = small(plain(labels.guillemets(labels.applied(graph, item))))
    mark = "//" if item.attrs.get("abstract") else ""
    return stack([words, *(f"{mark}{row}{mark}" for row in lines(labels.name(item), _WIDTH))])


def _compartments(
    graph: Graph, item: Element, owned: list[Element], points: list[Element]
) -> Iterator[str]:
    """Features, extension points and further subjects, below a line."""
    others = graph.targets(item, Edge.SUBJECT)[1:] if item.kind is Kind.USE_CASE else []
    rows = [_row(graph, one) for one in owned]
    if points:
        rows.append(stack([small("extension points"), *map(_name, points)]))
    if others:
        rows.append(stack([small("further subjects"), *map(_name, others)]))
    for row in rows:
        yield "----"
        yield row


def _row(graph: Graph, one: Element) -> str:
    if one.kind is Kind.CONSTRAINT:
        return label(labels.condition(one), _WIDTH)
    if one.kind is Kind.OPERATION:
        return label(labels.operation(graph, one), _WIDTH)
    return label(labels.feature(graph, one), _WIDTH)


def _name(one: Element) -> str:
    return label(labels.name(one), _WIDTH)


# -- lines and notes ---------------------------------------------------------------------------


def _line(relation: Relation, aliases: Aliases) -> Line:
    """The general use case or actor stands first; the other lines lead as they are read."""
    source, arrow, target = relation.source, relation.arrow, relation.target
    if arrow == "--|>":
        source, arrow, target = target, "<|--", source
    return Line(
        aliases[source],
        arrow,
        aliases[target],
        keyword_label(relation.label),
        padded(relation.near),
        padded(relation.far),
        relation.shows,
    )


def _notes(graph: Graph, shown: list[Element], aliases: Aliases) -> Iterator[Note]:
    for item in shown:
        for note in graph.sources(item, Edge.REFERENCES):
            text = label(str(note.attrs.get("body", "")), 44)
            if note.kind is Kind.COMMENT and text and note.id not in aliases:
                alias = aliases.make(note.id, "", "note")
                about = [one.id for one in graph.targets(note, Edge.REFERENCES)]
                ends = tuple(aliases[id] for id in about if id in aliases)
                yield Note(alias, text, ends, (note.id,))
