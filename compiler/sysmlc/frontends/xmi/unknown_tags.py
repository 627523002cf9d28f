"""Tags that no stereotype of SysML has, on stereotypes of SysML: each is told once for each file.

Only the shapes of the applications are looked at. Profiles of others say themselves what tags
they have, and are often not there.
"""

from collections.abc import Iterable, Iterator
from itertools import islice

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import namespaces, rules
from sysmlc.frontends.xmi.context import Context

_WORDS = (
    "allocatedfrom allocatedto bindingpath boundend concern concernlist concerns connector "
    "criterion definitionuri derived derivedfrom description dimension direction end "
    "featuredirection id isatomic isconjugated isencapsulated itemproperty language languages "
    "lower master max mean member method methods min name onnestedport ordered orderedmember "
    "original presentation principal probability propertypath purpose quantitykind rate "
    "reference refinedby refines risk satisfiedby satisfies size source sourcecontext "
    "sourcepropertypath stakeholder stakeholders standarddeviation structuralfeature symbol "
    "targetcontext targetpropertypath text tracedfrom tracedto unit upper verdict verifiedby "
    "verifies verifymethod viewpoint"
)
_TAGS = frozenset(_WORDS.split(" "))
"""Properties of all stereotypes of SysML 1.0 to 1.7 in lower case: tools differ in capitals."""

_MOST = 50
"""So many are told one by one, the others as a number."""

_NO_TAGS = ("base_", "__EA")


def is_known(tag: str) -> bool:
    """Whether a stereotype of SysML has a tag of this name."""
    return tag.lower() in _TAGS


def report(context: Context) -> None:
    """Report them; the applications that have them are approximated."""
    document = context.document
    found: dict[tuple[str, str], list[int]] = {}
    for row in context.applications:
        names = tuple(_unknown(document.attributes[row]))
        if document.ends[row] != row + 1:
            names += tuple(_unknown(document.features[at] for at in document.children(row)))
        is_read = bool(names) and context.gids[row] in context.graph
        if is_read and namespaces.is_sysml(document.namespace(row)):
            _approximate(context, row, names)
            for name in dict.fromkeys(names):
                found.setdefault((document.features[row], name), []).append(row)
    more = len(found) - _MOST
    for number, ((stereotype, name), rows) in enumerate(islice(found.items(), _MOST), 1):
        _report(context, stereotype, name, rows, more if number == _MOST else 0)


def _unknown(names: Iterable[str]) -> Iterator[str]:
    for name in names:
        if "}" not in name and not name.startswith(_NO_TAGS) and not is_known(name):
            yield name


def _approximate(context: Context, row: int, names: tuple[str, ...]) -> None:
    if context.verdicts[row] is Verdict.MAPPED:
        context.verdicts[row] = Verdict.APPROXIMATED
        context.told[row] = rules.UNKNOWN_TAG, f"SysML has no tag '{names[0]}'"


def _report(context: Context, stereotype: str, name: str, rows: list[int], more: int) -> None:
    first, others = rows[0], len(rows) - 1
    application = context.graph[context.gids[first]]
    element = context.graph.qualified_name(context.graph.owner(application) or application)
    context.sink.report(
        rules.UNKNOWN_TAG,
        Subject(element, application.id, context.place(first)),
        notes=(f"{more} more such tags are in the file",) if more > 0 else (),
        help=_near(name),
        tag=name,
        stereotype=stereotype,
        element=element,
        others=f" and {others} more" if others else "",
    )


def _near(name: str) -> str:
    from sysmlc.support.suggestions import did_you_mean

    told = did_you_mean(name, _TAGS)
    return told if told.startswith("did you mean") else ""
