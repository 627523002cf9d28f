"""Through which parts an item flow leads from one feature to another."""

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge


def flow_path(graph: Graph, flow: Element, edge: Edge) -> list[Element]:
    """Parts of the owner of an item flow that lead to the feature at one of its ends.

    Empty where the feature alone says it. ``edge`` is FLOW_SOURCE or FLOW_TARGET.
    """
    found = flow.attrs.get("source_path" if edge is Edge.FLOW_SOURCE else "target_path")
    ids = found if isinstance(found, tuple) else ()
    return [one for id_ in ids if (one := graph.get(str(id_))) is not None]
