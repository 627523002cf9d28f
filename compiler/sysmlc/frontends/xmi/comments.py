"""Comments of what is no element of its own: values, events, extensions of metaclasses.

Their readers take in all that is below such a row; a comment belongs to the nearest element then.
"""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.making import make
from sysmlc.frontends.xmi.structure import reference
from sysmlc.ir import Kind

_FEATURE = "ownedComment"


def restore(context: Context) -> None:
    """Make the comments that the walk passed over; references must not be flushed yet."""
    document = context.document
    for row in [row for row, feature in enumerate(document.features) if feature == _FEATURE]:
        is_swallowed = context.verdicts[row] is Verdict.MAPPED and not context.lowered.own[row]
        if is_swallowed and not _is_reference(context, row):
            make(context, row, Kind.COMMENT, "", "Comment", _FEATURE)
            _content(context, row)


def _content(context: Context, row: int) -> None:
    for child in context.document.children(row):
        feature = context.document.features[child]
        if _is_reference(context, child):
            reference(context, child, feature)
        elif feature == "body":
            context.text(child, feature)


def _is_reference(context: Context, row: int) -> bool:
    return bool(context.document.idref(row)) or "href" in context.document.attributes[row]
