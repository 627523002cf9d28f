"""Every example of a rule, right or wrong, can be saved and read back."""

from saving import read, refine, save

from sysmlc.driver.registry import load_full_catalogue
from sysmlc.ir import Kind
from sysmlc.ir.text import IrSyntaxError

UNNAMED = (Kind.COMMENT, Kind.SLOT, Kind.IMPORT, Kind.CONNECTOR_END, Kind.APPLICATION)


def test_models_of_rules_can_be_saved_and_read():
    graphs = [graph for graph in map(parse_or_none, list_texts()) if graph is not None]
    assert len(graphs) > 150
    for graph in graphs:
        text, messages = save(graph)
        names = {element.name for element in read(text.encode())}
        has_losses = any(message.startswith(("SM720", "SM725")) for message in messages)
        for element in graph if not has_losses else ():
            is_named = element.kind not in UNNAMED and not element.attrs.get("external")
            is_written = is_named and "origin" not in element.attrs
            assert not is_written or element.name in names, (element, text)


def list_texts():
    return sorted(
        {
            text
            for rule in load_full_catalogue().values()
            for text in (rule.read_page().wrong, rule.read_page().right)
        }
    )


def parse_or_none(text):
    """Return the graph, or None for an example in another language than the text form."""
    try:
        return refine(text)
    except (IrSyntaxError, ValueError, KeyError):
        return None
