"""The models in IR text among the examples of all rules."""

from collections.abc import Callable

from sysmlc.driver.registry import load_full_catalogue
from sysmlc.ir import Graph
from sysmlc.ir.text import IrSyntaxError


def parse_rule_examples(parse: Callable[[str], Graph]) -> list[Graph]:
    """Return the graphs of the wrong and right examples; other languages are skipped."""
    pages = [rule.read_page() for rule in load_full_catalogue().values()]
    graphs = []
    for text in sorted({text for page in pages for text in (page.wrong, page.right)}):
        try:
            graphs.append(parse(text))
        except (IrSyntaxError, ValueError, KeyError):
            continue
    assert len(graphs) > 150
    return graphs
