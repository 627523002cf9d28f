"""What holds the members of an internal element: a class of its own, an instance with values."""

from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import AttrValue, Edge, Element, Kind

# To look a member of an enumeration up takes twice as long as to look these up.
_INSTANCE = Kind.INSTANCE
_REPRESENTS = Edge.REPRESENTS

_CLASS: dict[str, AttrValue] = {"subkind": "internal-element", "role": "block"}
_PART: dict[str, AttrValue] = {"aggregation": "composite", "role": "part"}
_VALUES: dict[str, AttrValue] = {"subkind": "part"}


def own(context: Context, site: Site) -> Type:
    """The class for what the declared class has not."""
    if site.own is not None:
        return site.own
    above = site.parent
    graph, document = context.graph, site.document
    owner = own(context, above).id if above is not None else graph[site.instance].owner
    base = document.ids[site.row] or f"{owner}/{site.name}"
    made = _add(context, site, f"{base}#class", Kind.CLASS, owner, _CLASS)
    site.own = Type(made.id, document, site.row, Family.SYSTEM_UNIT)
    site.own.base = site.declared
    _retype(site, site.own)
    if site.declared is not None:
        graph.connect(Edge.SPECIALIZES, made, site.declared.id)
    if site.is_known and above is not None:
        _redefine_part(context, site, above, made)
    return site.own


def _add(
    context: Context,
    site: Site,
    id: str,
    kind: Kind,
    owner: str | None,
    attrs: dict[str, AttrValue],
) -> Element:
    """An element that stands for an internal element beside the one that has its ID."""
    document = site.document
    ordinal = document.ordinals[site.row]
    if id in context.graph:
        id = context.free(id, site.node)
    return context.graph.add(Element(id, kind, site.name, owner, ordinal, document.name, {**attrs}))


def _redefine_part(context: Context, site: Site, above: Site, type_: Element) -> None:
    """A part of the class whose instance has more in it: redefined, with the other type."""
    graph, owner = context.graph, own(context, above)
    part = f"{type_.id}#part"
    made = _add(context, site, part, Kind.PROPERTY, owner.id, _PART)
    graph.connect(Edge.TYPED_BY, made, type_)
    graph.connect(Edge.REDEFINES, made, site.part)
    member = Member(made.id, site.own, site.document, site.row)
    owner.members["InternalElement", site.name] = member
    if site.instance:
        graph.replace_targets(Edge.REPRESENTS, graph[site.instance], [made])
    site.part = made.id


def _retype(site: Site, own: Type) -> None:
    """Let the class above know that its part has another type."""
    above = site.parent.own if site.parent is not None else None
    if above is None:
        return
    key = ("InternalElement", site.name)
    known = above.members.get(key)
    if known is not None and known.row == site.row and known.document is site.document:
        above.members[key] = known._replace(type=own)


def instance(context: Context, site: Site) -> str:
    """Id of the Instance that holds the values of an internal element."""
    if site.parent is not None and site.parent.instance and not site.instance:
        _add_instance(context, site)
        return site.instance
    waiting = []
    one: Site | None = site
    while one is not None and not one.instance and one.parent is not None:
        waiting.append(one)
        one = one.parent
    for below in reversed(waiting):
        _add_instance(context, below)
    return site.instance or own(context, site).id


def _add_instance(context: Context, site: Site) -> None:
    above = site.parent
    owner = None if above is None else above.instance or own(context, above).id
    document = site.document
    id = context.id_at(document, site.row, owner) if site.is_known else f"{site.part}#values"
    made = _add(context, site, id, _INSTANCE, owner, _VALUES)
    context.graph.connect(_REPRESENTS, made, site.part)
    site.instance, site.instance_made = made.id, made
    if site.is_known:
        document.elements[site.row] = made.id
