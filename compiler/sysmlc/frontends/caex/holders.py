"""What holds the members of an internal element: a class of its own, an instance with values."""

from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element, Kind


def own(context: Context, site: Site) -> Type:
    """The class for what the declared class has not."""
    if site.own is not None:
        return site.own
    above = site.parent
    graph = context.graph
    owner = own(context, above).id if above is not None else graph[site.instance].owner
    base = site.node.attributes.get("ID") or f"{owner}/{site.node.name}"
    id = context.free(f"{base}#class", site.node)
    made = Element(id, Kind.CLASS, site.node.name, owner, site.node.ordinal, site.document.name)
    made.attrs.update(role="block", subkind="internal-element")
    graph.add(made)
    site.own = Type(id, site.node, site.document, Family.SYSTEM_UNIT)
    site.own.base = site.declared
    _retype(site, site.own)
    if site.declared is not None:
        graph.connect(Edge.SPECIALIZES, id, site.declared.id)
    if site.is_known and above is not None:
        _redefine_part(context, site, above, id)
    return site.own


def _redefine_part(context: Context, site: Site, above: Site, type_: str) -> None:
    """A part of the class whose instance has more in it: redefined, with the other type."""
    graph, owner = context.graph, own(context, above)
    id = context.free(f"{type_}#part", site.node)
    made = Element(
        id, Kind.PROPERTY, site.node.name, owner.id, site.node.ordinal, site.document.name
    )
    made.attrs.update(role="part", aggregation="composite")
    graph.add(made)
    graph.connect(Edge.TYPED_BY, id, type_)
    graph.connect(Edge.REDEFINES, id, site.part)
    owner.members["InternalElement", site.node.name] = Member(id, site.own, site.node)
    if site.instance:
        graph.replace_targets(Edge.REPRESENTS, graph[site.instance], [graph[id]])
    site.part = id


def _retype(site: Site, own: Type) -> None:
    """Let the class above know that its part has another type."""
    above = site.parent.own if site.parent is not None else None
    known = above.members.get(("InternalElement", site.node.name)) if above is not None else None
    if above is not None and known is not None and known.node is site.node:
        above.members["InternalElement", site.node.name] = known._replace(type=own)


def instance(context: Context, site: Site) -> str:
    """Id of the Instance that holds the values of an internal element."""
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
    graph = context.graph
    id = context.id_of(site.node, site.document, owner) if site.is_known else ""
    id = id or context.free(f"{site.part}#values", site.node)
    made = Element(id, Kind.INSTANCE, site.node.name, owner, site.node.ordinal, site.document.name)
    made.attrs["subkind"] = "part"
    graph.add(made)
    graph.connect(Edge.REPRESENTS, id, site.part)
    site.instance = id
    if site.is_known:
        site.node.element = id
