"""Dependencies and what they mean: requirements, allocation, realisation, tracing."""

from collections.abc import Callable

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.declarations import definition_head, visibility
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import qualified, reference
from sysmlc.backends.sysml.structure import classifier, contents
from sysmlc.backends.sysml.words import comment_lines, quoted
from sysmlc.ir import Edge, Kind

_KEYWORDS = {
    "trace": "trace",
    "copy": "copies",
    "satisfy": "satisfies",
    "verify": "verifies",
    "derive": "derives",
    "allocate": "allocates",
    "conform": "conforms",
    "expose": "exposes",
}
"""Keywords of our library for dependencies that nothing in SysML v2 says."""
_SUBKINDS = {
    "realization": "realization",
    "component-realization": "realization",
    "substitution": "substitution",
    "usage": "usage",
    "abstraction": "abstraction",
    "manifestation": "manifestation",
    "deployment": "deployment",
    "role-binding": "roleBinding",
    "internal-link": "internalLink",
    "ppr": "processLink",
    "succession": "orderLink",
}


def requirement(book: Book, entry: Entry) -> list[Line]:
    """A requirement: a usage with its id as short name and its text as documentation."""
    element = entry.element
    assert element is not None
    head = definition_head(book, entry)
    id = str(element.attrs.get("req_id", ""))
    beside = entry.parent.members if entry.parent is not None else book.plan.tops
    is_free = id and all(one.name != id for one in beside) and not _is_second(book, entry, id)
    if is_free:
        head.name = f"<{quoted(id)}> {head.name}"
    body = []
    if id and not is_free:
        body.append(annotations.ours(book, entry, "Requirement", {"id": id}))
    text = element.attrs.get("text")
    if text:
        body.append(Line("doc", text=comment_lines(str(text))))
    return [Line(head.text(), body + contents(book, entry))]


def _is_second(book: Book, entry: Entry, id: str) -> bool:
    """Whether a requirement before it in the namespace has the same id."""
    for one in entry.parent.members if entry.parent is not None else book.plan.tops:
        if one is entry:
            return False
        if one.element is not None and one.element.attrs.get("req_id") == id:
            return True
    return False


def dependency(book: Book, entry: Entry) -> list[Line]:
    """A dependency by what it means; what stands inside its client is added there."""
    element = entry.element
    assert element is not None
    if id(entry) in book.prepared:
        return book.prepared.pop(id(entry))
    return _BY_ROLE.get(element.role, _plain)(book, entry)


def _ends(book: Book, entry: Entry) -> tuple[list[Entry], list[Entry]]:
    element = entry.element
    assert element is not None
    found = []
    for edge in (Edge.CLIENT, Edge.SUPPLIER):
        known = []
        for one in book.graph.targets(element, edge):
            other = book.plan.entry(one)
            if other is None or reference(book.plan, entry.parent, other) is None:
                book.lost(element, str(edge.value))
            else:
                known.append(other)
        found.append(known)
    return found[0], found[1]


def _names(book: Book, scope: Entry | None, entries: list[Entry]) -> str:
    return ", ".join(str(reference(book.plan, scope, one)) for one in entries)


def _qualified(book: Book, scope: Entry | None, entries: list[Entry]) -> str:
    return ", ".join(str(qualified(book.plan, scope, one)) for one in entries)


def _plain(book: Book, entry: Entry) -> list[Line]:
    """A dependency, with a keyword when it is of a special kind."""
    element = entry.element
    assert element is not None
    clients, suppliers = _ends(book, entry)
    if not clients or not suppliers:
        return book.drop(entry, "client or supplier")
    word = _KEYWORDS.get(element.role) or _SUBKINDS.get(element.subkind)
    if element.role == "refine":
        mark = f"#{book.library(entry.parent, 'ModelingMetadata::refinement')} "
    else:
        mark = f"#{book.ours(entry.parent, word)} " if word else ""
    words = " ".join([*visibility(book, element), f"{mark}dependency"])
    name = f"{quoted(entry.name)} " if entry.name else ""
    ends = [_qualified(book, entry.parent, one) for one in (clients, suppliers)]
    body = contents(book, entry)
    return [Line(f"{words} {name}from {ends[0]} to {ends[1]}", body)]


def _satisfy(book: Book, entry: Entry) -> list[Line]:
    """Satisfaction by a definition stands in it, by a usage beside the dependency."""
    clients, suppliers = _ends(book, entry)
    are_requirements = all(one.shape.keyword == "requirement" for one in suppliers)
    if not are_requirements or len(clients) != 1 or not suppliers:
        return _plain(book, entry)
    client = clients[0]
    if client.shape.keyword in _SATISFYING:
        return _inside(book, entry, client, suppliers, "satisfy")
    if client.shape.is_usage and client.shape.keyword != "requirement":
        home = _definition_of(client)
        scope = entry.parent if home is None else home
        by = f" by {reference(book.plan, scope, client)}"
        lines = _requirements(book, entry, scope, suppliers, "satisfy", by)
        if home is None:
            return lines
        book.extra.setdefault(id(home), []).extend(lines)
        return []
    return _plain(book, entry)


def _definition_of(usage: Entry) -> Entry | None:
    """The definition that a usage is a feature of: only there it has a name by itself."""
    return next((one for one in usage.above if one.shape.is_definition), None)


_SATISFYING = frozenset({"part def", "item def", "action def", "state def", "occurrence def"})


def _requirements(
    book: Book, entry: Entry, scope: Entry | None, suppliers: list[Entry], keyword: str, end: str
) -> list[Line]:
    name, lines = entry.name, []
    for supplier in suppliers:
        target = reference(book.plan, scope, supplier)
        said = f"requirement {quoted(name)} references {target}" if name else str(target)
        lines.append(Line(f"{keyword} {said}{end}"))
        name = ""
    lines[0].body += contents(book, entry)
    return lines


def _inside(
    book: Book, entry: Entry, client: Entry, suppliers: list[Entry], keyword: str
) -> list[Line]:
    """Add the members to the client; the name goes with them."""
    lines = _requirements(book, entry, client, suppliers, keyword, "")
    kept = book.objectives if keyword == "verify" else book.extra
    kept.setdefault(id(client), []).extend(lines)
    return []


def prepare(book: Book) -> None:
    """Write what stands inside other elements, so that it is there when these are written."""
    for element in book.graph.of_kind(Kind.DEPENDENCY):
        entry = book.plan.entry(element)
        if entry is not None and element.role in ("satisfy", "verify", "allocate"):
            book.prepared[id(entry)] = _BY_ROLE[element.role](book, entry)


def _verify(book: Book, entry: Entry) -> list[Line]:
    """A verification case names the requirements in its objective."""
    clients, suppliers = _ends(book, entry)
    is_case = len(clients) == 1 and clients[0].shape.plain == "verification"
    if not suppliers or not is_case or any(one.shape.keyword != "requirement" for one in suppliers):
        return _plain(book, entry)
    return _inside(book, entry, clients[0], suppliers, "verify")


def _derive(book: Book, entry: Entry) -> list[Line]:
    """A derivation connection of the standard library."""
    element = entry.element
    assert element is not None
    clients, suppliers = _ends(book, entry)
    both = [*clients, *suppliers]
    are_requirements = all(one.shape.keyword == "requirement" for one in both)
    if len(suppliers) != 1 or not clients or not are_requirements:
        return _plain(book, entry)
    scope = entry.parent
    mark = [book.library(scope, f"RequirementDerivation::{one}") for one in _DERIVATION]
    ends = [Line(f"end #{mark[1]} ::> {_names(book, entry, suppliers)}")]
    ends += [Line(f"end #{mark[2]} ::> {_names(book, entry, [one])}") for one in clients]
    name = f" {quoted(entry.name)}" if entry.name else ""
    return [Line(f"#{mark[0]} connection{name}", ends + contents(book, entry))]


_DERIVATION = ("derivation", "original", "derive")


def _allocate(book: Book, entry: Entry) -> list[Line]:
    """An allocation between usages; between definitions it is a definition."""
    clients, suppliers = _ends(book, entry)
    both = [*clients, *suppliers]
    name = quoted(entry.name) if entry.name else ""
    if len(clients) == len(suppliers) == 1 and all(one.shape.is_usage for one in both):
        head = f"allocation {name} allocate" if name else "allocate"
        homes = [_definition_of(one) for one in both]
        scope = homes[0] if homes[0] is homes[1] and homes[0] is not None else entry.parent
        ends = [_names(book, scope, [one]) for one in both]
        line = Line(f"{head} {ends[0]} to {ends[1]}", contents(book, entry))
        if scope is entry.parent or scope is None:
            return [line]
        book.extra.setdefault(id(scope), []).append(line)
        return []
    if len(clients) == len(suppliers) == 1 and all(one.shape.is_definition for one in both):
        pairs = zip(("allocated", "allocatedTo"), both, strict=True)
        lines = [Line(f"end {word} : {_names(book, entry, [one])}") for word, one in pairs]
        return [Line(f"allocation def {name}".strip(), lines + contents(book, entry))]
    return _plain(book, entry)


_BY_ROLE: dict[str, Callable[[Book, Entry], list[Line]]] = {
    "satisfy": _satisfy,
    "verify": _verify,
    "derive": _derive,
    "allocate": _allocate,
}


def class_(book: Book, entry: Entry) -> list[Line]:
    """A class: a requirement, or a definition."""
    write = requirement if entry.shape.keyword == "requirement" else classifier
    return write(book, entry)
