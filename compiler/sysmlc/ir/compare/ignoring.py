"""Words that ``--ignore`` may name: attributes of elements, edges, kinds of details."""

from collections.abc import Iterable

from sysmlc.ir.compare.content import DETAILS, IMPLIED, WORDS
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge

_WORDS = frozenset({"id", "name", "value", "default", "default_value", "stereotype", "tag", "xml"})
"""``id``, and keys of facts that are no attributes in every model."""
_NEVER = frozenset({"source", "trace"})
"""Where elements are and what was made of them is never compared; ``id,source,trace`` says so."""


def words(graphs: Iterable[Graph]) -> frozenset[str]:
    """All words that may make a difference in these models, and the common ones."""
    found = {name for graph in graphs for element in graph for name in element.attrs}
    found |= {edge.value for edge in Edge} | {kind.value for kind in DETAILS}
    return frozenset(found | _WORDS | WORDS | IMPLIED | _NEVER)
