"""Declarations: prefixes, keyword, name, types, specialisations, multiplicity, value."""

from dataclasses import dataclass

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry, Plan
from sysmlc.backends.sysml.expressions import expression
from sysmlc.backends.sysml.library import scalar_of
from sysmlc.backends.sysml.relating import ends_differ, is_apart, is_unlike
from sysmlc.backends.sysml.rules import UNSAID_ATTRIBUTE
from sysmlc.backends.sysml.specific import feature_of, types_of
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import bounds, type_of

_VISIBILITIES = ("private", "protected")
_REFERENTIAL = frozenset({"port", "attribute", "metadata"})
"""Keywords of what holds no composite features but ports and attributes."""


@dataclass(slots=True)
class Head:
    """What a declaration consists of; empty parts are left out."""

    prefixes: list[str]
    keyword: str
    name: str = ""
    types: list[str] | None = None
    multiplicity: str = ""
    subsets: list[str] | None = None
    redefines: list[str] | None = None
    value: str = ""

    def text(self) -> str:
        """The declaration."""
        words = [*self.prefixes, self.keyword, self.name]
        text = " ".join(word for word in words if word)
        typed = f" : {', '.join(self.types)}" if self.types else ""
        redefined = f" :>> {', '.join(self.redefines)}" if self.redefines else ""
        subset = f" :> {', '.join(self.subsets)}" if self.subsets else ""
        if not self.name and redefined:
            return f"{text}{redefined}{typed}{self.multiplicity}{subset}{self.value}".lstrip()
        return f"{text}{typed}{self.multiplicity}{subset}{redefined}{self.value}".lstrip()


def visibility(book: Book, element: Element) -> list[str]:
    """The prefix for a visibility that is not public, unless the text refers to the element."""
    found = element.attrs.get("visibility")
    if found not in _VISIBILITIES:
        return []
    if element.id in book.public:
        book.approximated(element, f"'{found}' of what others refer to", "public")
        return []
    return [str(found)]


def definition_head(book: Book, entry: Entry, is_quantity: bool = False) -> Head:
    """Declaration of a definition, or of a usage that stands for one, with its generals.

    Those of a quantity are left to its writer.
    """
    element = _element(entry)
    prefixes = visibility(book, element)
    prefixes += _kinds_of_life(element)
    head = Head(prefixes, entry.shape.keyword, quoted(entry.name) if entry.name else "")
    if not is_quantity:
        head.types, head.subsets = _generals(book, entry)
    return head


def _generals(book: Book, entry: Entry) -> tuple[list[str], list[str]]:
    """Types, which a usage has where a definition specialises; and what else is specialised."""
    element = _element(entry)
    types: list[str] = []
    found: list[str] = []
    for general in book.graph.targets(element, Edge.SPECIALIZES):
        other = book.plan.entry(general)
        if scalar_of(general) is not None:
            found.append(book.library(entry.parent, str(scalar_of(general))))
        elif other is not None and _is_odd(book.plan, other, entry):
            book.approximated(element, f"generalization of {entry.shape.keyword}", "dependency")
            name = book.name(entry, element, Edge.SPECIALIZES, general)
            if name is not None:
                mark = book.ours(entry, "generalization")
                book.beside(entry, f"#{mark} dependency from {quoted(entry.name)} to {name}")
        else:
            name = book.name(entry.parent, element, Edge.SPECIALIZES, general)
            is_definition = other is not None and other.shape.is_definition
            is_type = is_definition and not entry.shape.is_definition
            (types if is_type else found).extend([] if name is None else [name])
    return types, found


def _is_odd(plan: Plan, general: Entry, specific: Entry) -> bool:
    """Whether one kind of definition cannot specialise the other."""
    if ends_differ(plan, general, specific):
        return True
    pair = (specific.shape.plain, general.shape.plain)
    return (
        pair[0] != pair[1]
        and pair not in _CONFORMING
        and general.shape.is_definition == specific.shape.is_definition
    )


_CONFORMING = frozenset(
    {
        ("part", "item"),
        ("part", "occurrence"),
        ("item", "occurrence"),
        ("port", "occurrence"),
        ("action", "occurrence"),
        ("state", "action"),
        ("verification", "action"),
        ("enum", "attribute"),
        ("connection", "part"),
        ("interface", "connection"),
        ("interface", "part"),
        ("connection", "occurrence"),
    }
)


def feature_head(book: Book, entry: Entry) -> Head:
    """Declaration of a feature, without its value."""
    element = _element(entry)
    keyword = entry.shape.keyword
    head = Head(feature_prefixes(book, entry, keyword), keyword if keyword != "ref" else "")
    head.types, head.subsets = typing(book, entry.parent, element)
    head.multiplicity = multiplicity(book, entry.parent, element)
    _redefine(book, entry, head)
    return head


def feature_prefixes(book: Book, entry: Entry, keyword: str) -> list[str]:
    """Visibility, direction, and the other words before the keyword of a feature."""
    element, attrs = _element(entry), _element(entry).attrs
    prefixes = visibility(book, element)
    direction = attrs.get("direction")
    if direction in ("in", "out", "inout", "return"):
        prefixes.append("out" if direction == "return" else str(direction))
    life = _kinds_of_life(element)
    type_ = type_of(book.graph, element)
    if type_ is not None and type_.attrs.get("variation"):
        is_own = feature_of(book.graph, type_) is element
        life = ["variation"] if is_own else [word for word in life if word != "variation"]
    prefixes += ["variant"] if attrs.get("variant") else []
    prefixes += [word for word in ("derived",) if attrs.get(word)]
    prefixes += [word for word in life if word in ("abstract", "variation")]
    if attrs.get("readonly"):
        prefixes.append("constant")
    is_part = attrs.get("aggregation") == "composite" or element.role == "part"
    if keyword == "ref" and direction is None:
        prefixes.append("ref")
    elif direction is None and keyword not in ("attribute", "port") and not is_part:
        is_property = element.kind in (Kind.PROPERTY, Kind.FLOW_PROPERTY)
        prefixes += ["ref"] if is_property or _is_referential(entry) else []
    elif direction is None and keyword not in ("attribute", "port") and _is_referential(entry):
        prefixes.append("ref")
    prefixes += [word for word in life if word not in ("abstract", "variation")]
    return [*prefixes, *([str(attrs["portion"])] if "portion" in attrs else [])]


def _kinds_of_life(element: Element) -> list[str]:
    """Whether it is abstract or a choice, and one individual."""
    attrs = element.attrs
    choice = "variation" if attrs.get("variation") else "abstract" if attrs.get("abstract") else ""
    return [*([choice] if choice else []), *(["individual"] if attrs.get("individual") else [])]


def _is_referential(entry: Entry) -> bool:
    return entry.parent is not None and entry.parent.shape.plain in _REFERENTIAL


def typing(book: Book, scope: Entry | None, element: Element) -> tuple[list[str], list[str]]:
    """Types of a feature, and features that it subsets because they stand for its type."""
    types, subsets = [], []
    for type_ in types_of(book.graph, element):
        name = type_name(book, scope, element, type_)
        other = book.plan.entry(type_)
        if name is None:
            continue
        if other is not None and not other.shape.is_definition:
            subsets.append(name)
        else:
            types.append(f"~{name}" if element.attrs.get("conjugated") else name)
    for feature in book.graph.targets(element, Edge.SUBSETS):
        if feature is element:
            book.lost(element, "subsets")
            continue
        if is_apart(book, element, feature):
            continue
        name = book.name(scope, element, Edge.SUBSETS, feature)
        subsets += [] if name is None else [name]
    return types, [*subsets, *_referred(book, scope, element)]


def _referred(book: Book, scope: Entry | None, element: Element) -> list[str]:
    """Features of other classifiers that a feature of a model in SysML v2 is one of."""
    is_feature = element.kind in (Kind.PROPERTY, Kind.PORT)
    found = book.graph.targets(element, Edge.REFERENCES) if is_feature else []
    names = (book.name(scope, element, Edge.REFERENCES, one) for one in found)
    return [one for one in names if one is not None]


def type_name(book: Book, scope: Entry | None, holder: Element, type_: Element) -> str | None:
    """The name of a type; scalar types are those of the standard library."""
    scalar = scalar_of(type_)
    if scalar is not None:
        return book.library(scope, scalar)
    return book.name(scope, holder, Edge.TYPED_BY, type_)


def multiplicity(book: Book, scope: Entry | None, element: Element) -> str:
    """Multiplicity in brackets, with ``ordered`` and ``nonunique``; exactly one says nothing."""
    given = element.attrs.get("multiplicity")
    text = "" if given is None else _bounds(book, scope, element, str(given))
    text += " ordered" if element.attrs.get("ordered") else ""
    return text + (" nonunique" if element.attrs.get("unique") is False else "")


def _bounds(book: Book, scope: Entry | None, element: Element, given: str) -> str:
    if bounds(given) is not None:
        return f"[{given}]"
    parts = [expression(book, scope, part) for part in given.split("..")]
    if all(parts):
        return f"[{'..'.join(str(part) for part in parts)}]"
    facts = {"attribute": "multiplicity", "kind": str(element.kind)}
    book.losses.note(UNSAID_ATTRIBUTE, element, **facts)
    return ""


def _redefine(book: Book, entry: Entry, head: Head) -> None:
    element = _element(entry)
    head.redefines = []
    is_same = False
    redefined = book.graph.targets(element, Edge.REDEFINES)
    for feature in redefined:
        if is_unlike(book.plan, element, feature):
            continue
        other = book.plan.entry(feature)
        name = book.redefined(entry.parent, feature)
        if name is None or other is None:
            book.lost(element, "redefines")
            continue
        if other.parent is entry.parent:
            book.approximated(element, "redefinition within one owner", "a subset")
            head.subsets = [*(head.subsets or ()), name]
            continue
        is_same = is_same or other.name == entry.name
        head.redefines.append(name)
    head.name = "" if is_same else quoted(entry.name)
    if is_same and all(_has_type(book, one, element) for one in redefined):
        head.types = []


def _has_type(book: Book, redefined: Element, element: Element) -> bool:
    """Whether what is redefined says the type already."""
    return list(types_of(book.graph, redefined)) == list(types_of(book.graph, element))


def _element(entry: Entry) -> Element:
    assert entry.element is not None
    return entry.element
