"""Attributes that no word of SysML v2 says: metadata keeps them and gives them back."""

from collections.abc import Callable, Iterator

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.facts import attribute, relation
from sysmlc.backends.sysml.relating import unsaid_edges
from sysmlc.backends.sysml.stereotypes import is_standard
from sysmlc.backends.sysml.values import literal
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query.activities import is_joined, pin_subkind
from sysmlc.logic.expressions.expression import ExpressionError, print_expression
from sysmlc.logic.expressions.parsing import parse_expression

_FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
_WHOLE = (Kind.DOCUMENT, Kind.METADATA, Kind.ALIAS, Kind.IMPORT)
"""Kinds whose attributes are all listed in a comment."""
_ATTRIBUTES = """
    role level subkind multiplicity direction conjugated abstract ordered derived readonly unique
    visibility aggregation default default_language default_instance default_bodies
    default_languages domain body language bodies languages external href library qualified_name
    unresolved origin value value_language value_instance value_bodies value_languages guard
    guard_language guard_literal guard_bodies guard_languages guard_instance req_id text symbol
    when when_language when_bodies when_languages condition condition_language condition_bodies
    condition_languages relative port path represents data_type unit default_value category
    semantics version change_mode copyright ppr interface_ids associated_facet tag data_type
    stereotype namespace lineage on diagram arguments
    message_kind description usage property_specific payload initial value_unit variation variant
    portion individual
"""
_SAID = frozenset(_ATTRIBUTES.split())
"""Attributes that the text says, or that say nothing more than what it says, for most kinds."""
_OF_LOOPS = ("mode", "collection")
_COMPOSITE = frozenset({"part", "item", "occurrence", "constraint"})
"""Keywords of features that are composite unless they are references."""
_SUBKINDS = frozenset({Kind.DATA_TYPE, Kind.ACTIVITY_PARAMETER})
"""Kinds whose subkind neither a keyword nor the metadata ``Kind`` says."""


def facts(book: Book, entry: Entry, element: Element) -> tuple[str, ...]:
    """What metadata keeps of an element and of its parts that are no members of the text."""
    found = [*_own(book, entry, element)]
    for part, one in parts(book, entry, element):
        given = {"node": element.name, "start": "start", "done": "done"}.get(part, "")
        found += [f"{part}.{fact}" for fact in _of_part(book, one, given)]
    return tuple(found)


def _own(book: Book, entry: Entry, element: Element) -> Iterator[str]:
    for key in unsaid(book, entry, element):
        text = attribute(book, key, element.attrs.get(key))
        if text is not None:
            book.kept.add((element.id, key))
            yield text
    for edge, target in unsaid_edges(book, element):
        led = relation(book, edge, target)
        if led is not None:
            book.kept_edges.add((edge, element.id, target.id))
            yield led


def whole(book: Book, element: Element) -> tuple[str, ...]:
    """All facts of an element for which SysML v2 has nothing at all."""
    found = []
    for key, value in element.attrs.items():
        text = attribute(book, key, value)
        if text is not None and key not in _NEVER:
            book.kept.add((element.id, key))
            found.append(text)
    for edge in _LEADING:
        for target in book.graph.targets(element, edge):
            led = relation(book, edge, target)
            if led is not None:
                book.kept_edges.add((edge, element.id, target.id))
                found.append(led)
    return tuple(found)


_NEVER = frozenset({"external", "library", "unresolved"})
_LEADING = tuple(edge for edge in Edge if edge not in (Edge.OWNS, Edge.FEATURE, Edge.SUBJECT))


def _of_part(book: Book, part: Element, given: str) -> Iterator[str]:
    """Facts of what has no member of its own: its name, unless it is what reading gives it."""
    book.kept.add((part.id, "name"))
    if part.name != given and not (part.name or given not in _WORDS):
        book.approximated(part, "a first or last node without a name", "start or done")
    elif part.name != given:
        yield attribute(book, "name", part.name) or ""
    if part.kind is Kind.ACTIVITY_PARAMETER and not book.graph.targets(part, Edge.TYPED_BY):
        book.approximated(part, "a parameter node without a type", "one of its parameter's type")
    for key in unsaid(book, None, part):
        text = attribute(book, key, part.attrs[key])
        if text is not None:
            book.kept.add((part.id, key))
            yield text


def parts(book: Book, entry: Entry, element: Element) -> Iterator[tuple[str, Element]]:
    """Parts of an element that its own member says, with the words that stand for them.

    ``node`` is the parameter node of a parameter, ``region`` the only region, ``trigger`` the only
    trigger; ``start`` and ``done`` begin and end a behaviour.
    """
    graph = book.graph
    if element.kind is Kind.PARAMETER:
        nodes = [o for o in graph.sources(element, Edge.REFERENCES) if _is_node(book, o)]
        yield from (("node", one) for one in nodes[:1])
    held = graph.owned(element) if element.kind in _HOLDERS else []
    triggers = [one for one in held if one.kind is Kind.TRIGGER]
    if len(triggers) == 1 and element.kind is not Kind.STATE:
        yield "trigger", triggers[0]
    regions = [one for one in held if one.kind is Kind.REGION]
    if len(regions) == 1 and book.plan.entry(regions[0]) is None:
        yield "region", regions[0]
        held = graph.owned(regions[0])
    for word, ends, edge in (
        ("start", _STARTS, Edge.FLOW_SOURCE),
        ("done", _ENDS, Edge.FLOW_TARGET),
    ):
        found = [one for one in held if (one.kind, one.subkind) in ends]
        found = [one for one in found if word == "start" or book.plan.entry(one) is None]
        yield from ((word, one) for one in found[:1] if graph.sources(one, edge))


_WORDS = ("start", "done")
_HOLDERS = (
    Kind.ACTION,
    Kind.TRANSITION,
    Kind.ACTIVITY,
    Kind.STRUCTURED,
    Kind.STATE_MACHINE,
    Kind.STATE,
    Kind.REGION,
)
_STARTS = ((Kind.CONTROL, "initial"), (Kind.PSEUDOSTATE, "initial"))
_ENDS = ((Kind.CONTROL, "final"), (Kind.CONTROL, "flow-final"), (Kind.FINAL_STATE, ""))


def _is_node(book: Book, element: Element) -> bool:
    return element.kind is Kind.ACTIVITY_PARAMETER and book.plan.entry(element) is None


def unsaid(book: Book, entry: Entry | None, element: Element) -> Iterator[str]:
    """Names of the attributes that nothing else in the text says."""
    if element.kind in _WHOLE or (element.kind is Kind.APPLICATION and not is_standard(element)):
        return
    for key, value in element.attrs.items():
        if value is None or (value == () and key not in _UNLIKE):
            continue
        is_unsaid = _UNLIKE.get(key)
        if is_unsaid is not None:
            if is_unsaid(book, entry, element):
                yield key
        elif key.startswith("value."):
            if element.kind is not Kind.SLOT:
                yield key
        elif key.startswith("tag."):
            if not _is_told(element, key):
                yield key
        elif key not in _SAID and not (element.id in book.loops and key.startswith(_OF_LOOPS)):
            yield key


# -- attributes that the text says for some elements only ----------------------------------------

_Asked = Callable[[Book, Entry | None, Element], bool]


def _aggregation(_book: Book, entry: Entry | None, element: Element) -> bool:
    if element.kind is Kind.PORT:
        return True
    if element.kind is not Kind.PROPERTY or element.attrs["aggregation"] != "composite":
        return False
    is_plain = entry is not None and entry.shape.keyword in _COMPOSITE
    return not is_plain or "direction" in element.attrs


def _subkind(book: Book, _entry: Entry | None, element: Element) -> bool:
    if element.kind is Kind.ACTIVITY:
        has_body = "body" in element.attrs or "bodies" in element.attrs
        return element.subkind == "function" or (element.subkind == "opaque" and not has_body)
    if element.kind is Kind.PACKAGE:
        return element.subkind == "model"
    if element.kind is Kind.PROPERTY:
        owner = book.graph.owner(element)
        is_of_loop = owner is not None and owner.kind is Kind.STRUCTURED
        return is_of_loop and element.subkind == "variable" and element.owner not in book.loops
    asked = _SUBKINDS_OF.get(element.kind)
    return element.kind in _SUBKINDS if asked is None else asked(book, element)


def _of_call(book: Book, action: Element) -> bool:
    """Reading a feature, and calling an operation that no file of the model has."""
    called = book.graph.target(action, Edge.CALLS)
    is_unknown = called is not None and bool(called.attrs.get("external"))
    return action.subkind == "read" or (action.subkind == "call-operation" and is_unknown)


def _of_end(book: Book, node: Element) -> bool:
    """The end of a flow where ``done`` is that of the behaviour."""
    is_end = node.subkind == "flow-final" and book.plan.entry(node) is None
    return is_end and is_joined(book.graph, node)


def _of_pin(book: Book, pin: Element) -> bool:
    """What a pin is where its action does not say it, or is told by metadata itself."""
    owner = book.graph.owner(pin)
    if owner is None or (owner.kind is Kind.ACTION and owner.subkind == "read"):
        return True
    return pin.subkind != pin_subkind(owner, pin)


_SUBKINDS_OF = {Kind.ACTION: _of_call, Kind.CONTROL: _of_end, Kind.PIN: _of_pin}


def _guard(_book: Book, _entry: Entry | None, element: Element) -> bool:
    is_plain = element.attrs.get("guard") not in ("", None)
    return element.kind in _FLOWS and ("guard_literal" in element.attrs or not is_plain)


def _direction(_book: Book, entry: Entry | None, element: Element) -> bool:
    if element.kind is Kind.PARAMETER:
        return element.attrs["direction"] == "return"
    return _of_part_port(_book, entry, element)


def _of_part_port(_book: Book, entry: Entry | None, element: Element) -> bool:
    is_part = entry is not None and entry.shape.keyword == "part"
    return element.kind is Kind.PORT and is_part


def _turned(book: Book, entry: Entry | None, element: Element) -> bool:
    """Conjugation is said with a type only."""
    is_typed = bool(book.graph.targets(element, Edge.TYPED_BY))
    is_part = entry is not None and entry.shape.keyword == "part"
    return element.kind is Kind.PORT and (is_part or not is_typed)


def _of_literals(_book: Book, _entry: Entry | None, element: Element) -> bool:
    return element.kind is Kind.ENUMERATION_LITERAL


def _visibility(book: Book, _entry: Entry | None, element: Element) -> bool:
    found = element.attrs["visibility"]
    owner = book.graph.owner(element)
    is_end = owner is not None and owner.kind is Kind.ASSOCIATION
    is_bare = is_end or element.kind is Kind.PIN
    is_said = found in ("private", "protected", "public") and element.id not in book.public
    return is_bare or not is_said


def _default(book: Book, entry: Entry | None, element: Element) -> bool:
    """What a port holds, and text that is written as a number or names an element."""
    given = element.attrs["default"]
    if element.kind is Kind.PORT or entry is None:
        return True
    if "default_instance" in element.attrs:
        return True
    if not isinstance(given, str):
        return False
    if "default_language" in element.attrs:
        return not given
    return not literal(book, entry.parent, element, given).startswith('"')


def _always(_book: Book, _entry: Entry | None, _element: Element) -> bool:
    return True


def _of_no_text(_book: Book, _entry: Entry | None, element: Element) -> bool:
    """The language of a default that has no text."""
    return element.attrs.get("default") == ""


def _of_chains(book: Book, _entry: Entry | None, element: Element) -> bool:
    """The way to an end, but for item flows that say it as the chain of features at the end."""
    is_flow = element.kind is Kind.ITEM_FLOW
    return not is_flow or bool(book.graph.targets(element, Edge.REALIZING))


def _body(book: Book, entry: Entry | None, element: Element) -> bool:
    """The text of a constraint whose expression is spelt otherwise, or has a language."""
    if element.kind is not Kind.CONSTRAINT:
        return False
    text = str(element.attrs["body"])
    if not text:
        return True
    try:
        is_same = print_expression(parse_expression(text)) == text
    except ExpressionError:
        return entry is None
    return not is_same or "language" in element.attrs


def _language(_book: Book, _entry: Entry | None, element: Element) -> bool:
    if element.kind is not Kind.ACTIVITY:
        return element.kind is Kind.CONSTRAINT
    return not (element.attrs.get("body") or element.attrs.get("bodies"))


def _on_flows(_book: Book, _entry: Entry | None, element: Element) -> bool:
    return element.kind in _FLOWS


_UNLIKE: dict[str, _Asked] = {
    "aggregation": _aggregation,
    "subkind": _subkind,
    "guard": _guard,
    "guard_literal": _on_flows,
    "direction": _direction,
    "conjugated": _turned,
    "value": _of_literals,
    "visibility": _visibility,
    "default": _default,
    "default_instance": _always,
    "decision_input_flow": _always,
    "source_path": _of_chains,
    "target_path": _of_chains,
    "default_language": _of_no_text,
    "body": _body,
    "language": _language,
}

_TOLD_TAGS = """
    id text direction unit quantityKind base isConjugated kind propertyPath sourceContext
    targetContext sourcePropertyPath targetPropertyPath refines derived derivedFrom satisfiedBy
    verifiedBy tracedTo master allocatedTo allocatedFrom itemProperty onNestedPort
"""
_TOLD = frozenset(name.lower() for name in _TOLD_TAGS.split())


def _is_told(element: Element, key: str) -> bool:
    """Whether a tag of a stereotype of SysML is said, or has its default."""
    tag = key.removeprefix("tag.").lower()
    return tag in _TOLD or element.attrs[key] in ("false", False)
