"""Use case diagrams: one for each package that owns use cases (UML 2.5.1 clause 18.1.5)."""

from collections.abc import Iterator, Sequence

from sysmlc.backends.plantuml import labels, partitioning
from sysmlc.backends.plantuml.relations import (
    Relation,
    find_neighbours,
    iter_use_case_relations,
    list_relations,
)
from sysmlc.backends.plantuml.views import (
    Aliases,
    Diagram,
    Figure,
    Line,
    Note,
    SubjectView,
    UseCaseView,
)
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.plantuml_text import (
    escape_line,
    format_keyword_label,
    format_label,
    join_rows,
    pad_label,
    shrink,
    wrap_lines,
)

FIGURES = (Kind.USE_CASE, Kind.ACTOR)
_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)
_ROW_KINDS = (Kind.PROPERTY, Kind.OPERATION, Kind.CONSTRAINT)
_ROW_WIDTH = 28


def draw_use_cases(graph: Graph) -> Iterator[Diagram]:
    """Yield all use case diagrams, in the order of the packages."""
    cases = [item for item in graph.of_kind(Kind.USE_CASE) if not item.attrs.get("external")]
    cases_by_package: dict[str | None, list[Element]] = {}
    for case in cases:
        cases_by_package.setdefault(labels.find_package(graph, case), []).append(case)
    candidates = _list_relations(graph) if cases else []
    for package, package_cases in cases_by_package.items():
        yield from _draw_package(graph, graph.get(package), package_cases, candidates)


def find_use_case_actors(graph: Graph) -> set[str]:
    """Return the ids of actors that only use case diagrams show.

    An actor with features, or with relations to other elements, also has a box elsewhere.
    """
    packages = {labels.find_package(graph, case) for case in graph.of_kind(Kind.USE_CASE)}
    if not packages:
        return set()
    ids_found = {
        item.id
        for item in graph.of_kind(Kind.ACTOR)
        if labels.find_package(graph, item) in packages
        and not any(feature.kind in _ROW_KINDS for feature in graph.owned(item))
    }
    # A line of a block definition diagram needs a box at both ends.
    for relation in list_relations(graph):
        ends = {relation.source, relation.target}
        if any(graph[id].kind not in FIGURES for id in ends):
            ids_found -= ends
    return ids_found


def _list_relations(graph: Graph) -> list[Relation]:
    """Return the lines between use cases and actors."""

    candidates = [*list_relations(graph), *iter_use_case_relations(graph)]
    return [r for r in candidates if {graph[r.source].kind, graph[r.target].kind} <= set(FIGURES)]


def _draw_package(
    graph: Graph,
    package: Element | None,
    package_cases: list[Element],
    candidates: Sequence[Relation],
) -> Iterator[Diagram]:
    package_id = package.id if package is not None else None
    package_actors = [
        actor
        for actor in graph.of_kind(Kind.ACTOR)
        if labels.find_package(graph, actor) == package_id
    ]
    ids = [use_case.id for use_case in package_cases]
    parts = partitioning.partition(ids, find_neighbours(ids, candidates))
    title = graph.qualified_name(package) if package is not None else "model"
    for index, part in enumerate(parts):
        shown = [graph[id] for id in part]
        inside = [
            r
            for r in candidates
            if {r.source, r.target} & _add_connected_actors(part, package_actors, candidates)
        ]
        diagram = Diagram(
            kind="uc",
            name=title,
            frame=escape_line(f"uc [package] {title}"),
            heading=("Use case diagram", title),
            view=build_view(graph, shown, package_actors if index == 0 else [], inside),
            about=package.id if package is not None else "",
        )
        yield partitioning.name_part(diagram, index, len(parts))


def _add_connected_actors(
    part: list[str], package_actors: list[Element], candidates: Sequence[Relation]
) -> set[str]:
    """Return the ids of *part* and of the actors of the package that have relations."""
    connected = {id for relation in candidates for id in (relation.source, relation.target)}
    return {*part, *(actor.id for actor in package_actors if actor.id in connected)}


# -- figures -----------------------------------------------------------------------------------


def build_view(
    graph: Graph, cases: list[Element], lone_actors: list[Element], inside: list[Relation]
) -> UseCaseView:
    """Return use cases in their subjects, actors, and the lines between them."""
    aliases = Aliases()
    related = [graph[id] for r in inside for id in (r.source, r.target)]
    shown = list(dict.fromkeys([*cases, *lone_actors, *related]))
    own_ids = {item.id for item in (*cases, *lone_actors)}
    figures = {item.id: _make_figure(graph, item, aliases, item.id in own_ids) for item in shown}
    groups: dict[str | None, list[Figure]] = {}
    for item in shown:
        if item.kind is Kind.USE_CASE:
            subject = _find_subject(graph, item)
            groups.setdefault(subject.id if subject else None, []).append(figures[item.id])
    return UseCaseView(
        tuple(figures[item.id] for item in shown if item.kind is Kind.ACTOR),
        tuple(_make_subject_frame(graph[id], group, aliases) for id, group in groups.items() if id),
        tuple(groups.get(None, ())),
        tuple(_make_line(relation, aliases) for relation in inside),
        tuple(_iter_notes(graph, shown, aliases)),
    )


def _find_subject(graph: Graph, case: Element) -> Element | None:
    """Return the subject of the use case, else the classifier that owns it.

    A use case or an actor has a figure of its own, which cannot be a frame at the same time.
    """
    subject = graph.target(case, Edge.SUBJECT) or graph.owner(case)
    return subject if subject is not None and subject.kind not in (*_PACKAGES, *FIGURES) else None


def _make_subject_frame(subject: Element, cases: list[Figure], aliases: Aliases) -> SubjectView:
    name = join_rows(f"**{row}**" for row in wrap_lines(labels.name(subject)))
    return SubjectView(aliases.make(subject.id, subject.name, "subject"), name, tuple(cases))


def _make_figure(graph: Graph, item: Element, aliases: Aliases, is_own: bool) -> Figure:
    is_case = item.kind is Kind.USE_CASE
    members = (
        [member for member in graph.owned(item) if member.kind in _ROW_KINDS] if is_own else []
    )
    points = [member for member in graph.owned(item) if member.kind is Kind.EXTENSION_POINT]
    alias = aliases.make(item.id, item.name, "case" if is_case else "actor")
    rows = [_format_title(graph, item), *_iter_compartments(graph, item, members, points)]
    shows = (item.id, *(member.id for member in (*members, *points)))
    style = "" if is_own else "elsewhere"
    return Figure(alias, join_rows(rows), "usecase" if is_case else "actor", style, shows)


def _format_title(graph: Graph, item: Element) -> str:
    words = shrink(escape_line(labels.guillemets(labels.list_stereotypes(graph, item))))
    mark = "//" if item.attrs.get("abstract") else ""
    return join_rows(
        [words, *(f"{mark}{row}{mark}" for row in wrap_lines(labels.name(item), _ROW_WIDTH))]
    )


def _iter_compartments(
    graph: Graph, item: Element, members: list[Element], points: list[Element]
) -> Iterator[str]:
    """Yield features, extension points and further subjects, each after a separator."""
    more_subjects = graph.targets(item, Edge.SUBJECT)[1:] if item.kind is Kind.USE_CASE else []
    rows = [_format_row(graph, member) for member in members]
    if points:
        rows.append(join_rows([shrink("extension points"), *map(_format_name, points)]))
    if more_subjects:
        rows.append(join_rows([shrink("further subjects"), *map(_format_name, more_subjects)]))
    for row in rows:
        yield "----"
        yield row


def _format_row(graph: Graph, member: Element) -> str:
    if member.kind is Kind.CONSTRAINT:
        return format_label(labels.condition(member), _ROW_WIDTH)
    if member.kind is Kind.OPERATION:
        return format_label(labels.operation(graph, member), _ROW_WIDTH)
    return format_label(labels.feature(graph, member), _ROW_WIDTH)


def _format_name(element: Element) -> str:
    return format_label(labels.name(element), _ROW_WIDTH)


# -- lines and notes ---------------------------------------------------------------------------


def _make_line(relation: Relation, aliases: Aliases) -> Line:
    """Return the line; a generalization starts at the general use case or actor."""
    source, arrow, target = relation.source, relation.arrow, relation.target
    if arrow == "--|>":
        source, arrow, target = target, "<|--", source
    return Line(
        aliases[source],
        arrow,
        aliases[target],
        format_keyword_label(relation.label),
        pad_label(relation.near),
        pad_label(relation.far),
        relation.shows,
    )


def _iter_notes(graph: Graph, shown: list[Element], aliases: Aliases) -> Iterator[Note]:
    for item in shown:
        for note in graph.sources(item, Edge.REFERENCES):
            text = format_label(str(note.attrs.get("body", "")), 44)
            if note.kind is Kind.COMMENT and text and note.id not in aliases:
                alias = aliases.make(note.id, "", "note")
                about = [target.id for target in graph.targets(note, Edge.REFERENCES)]
                ends = tuple(aliases[id] for id in about if id in aliases)
                yield Note(alias, text, ends, (note.id,))
