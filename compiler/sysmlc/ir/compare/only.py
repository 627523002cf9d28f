"""What one of the two models has alone."""

from collections.abc import Collection, Iterator

from sysmlc.ir.compare.change import Change, Ref, What
from sysmlc.ir.compare.content import is_external
from sysmlc.ir.compare.pairs import Pairs
from sysmlc.ir.compare.plants import holders, is_own_class, is_told_of_another, own_classes
from sysmlc.ir.compare.side import Side
from sysmlc.ir.compare.titles import title, whole, word
from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Kind


def only(pairs: Pairs, side: Side, what: What) -> Iterator[Change]:
    """Additions or removals: the topmost elements that are in no pair."""
    known = pairs.new_of if side is pairs.old else pairs.old_of
    for owner, children in side.things.items():
        if owner is None or owner in known or _is_transparent(side, side.graph[owner], known):
            for child in children:
                if not (child.id in known or is_external(child) or _follows(side, child, known)):
                    yield _alone(side, child, what, known)


def _is_transparent(side: Side, owner: Element, known: Collection[str]) -> bool:
    """Whether what it owns is told by itself: a new class of an InternalElement that is not new."""
    is_new = owner.id not in known and is_own_class(owner)
    return is_new and any(one.id in known for one in holders(side, owner))


def _follows(side: Side, element: Element, known: Collection[str]) -> bool:
    """Whether it is there only because of something else that is told.

    What a message does at its ends comes and goes with the message.
    """
    if element.kind is Kind.OCCURRENCE:
        into = side.into.get(element.id, ())
        return any(one.kind is Kind.MESSAGE and one.id not in known for _, one in into)
    return is_told_of_another(side, element, known)


def _alone(side: Side, element: Element, what: What, known: Collection[str]) -> Change:
    tops = [element, *own_classes(side, element)]
    contents = sum(one.id not in known for top in tops for one in side.below(top)) - len(tops)
    ref = ref_of(side, element)
    is_old = what is What.REMOVED
    return Change(
        what=what,
        owner=owner_of(side, element),
        name=title(side, element),
        kind=word(side, element),
        contents=contents,
        old=ref if is_old else None,
        new=None if is_old else ref,
    )


def ref_of(side: Side, element: Element) -> Ref:
    """The element for who wants to find it again."""
    return Ref(element.id, whole(side, element), element.source, element.ordinal)


def owner_of(side: Side, element: Element) -> str:
    """Qualified name of the owner; empty when there is none."""
    owner = side.graph.owner(element)
    return "" if owner is None else whole(side, owner)
