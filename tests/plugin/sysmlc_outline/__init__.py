"""Back end ``outline``: one Markdown file for each block, with its ports."""

from dataclasses import dataclass
from pathlib import Path

from sysmlc.backends.base import EmitOptions
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, Kind
from sysmlc.support.output import Output, assign_file_names

NO_PORTS = rule(
    "ACME001",
    "outline-without-ports",
    Severity.WARNING,
    "block '{block}' has no ports to outline",
    page=Path(__file__).with_name("ACME001.md").read_text(encoding="utf-8"),
)


@dataclass(frozen=True, slots=True)
class Outline:
    """List the ports of each class."""

    name: str = "outline"
    summary: str = "ports of each block, outlines/*.md"
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add one file for each class that has ports."""
        blocks = graph.of_kind(Kind.CLASS)
        names = assign_file_names(graph.qualified_name(block) for block in blocks)
        for block in blocks:
            ports = [owned for owned in graph.owned(block) if owned.kind is Kind.PORT]
            if not ports:
                sink.report(NO_PORTS, graph.subject(block), block=block.name)
                continue
            path = f"outlines/{names[graph.qualified_name(block)]}.md"
            trace = [block.id, *(port.id for port in ports)]
            output.add(path, _text(block, ports), trace, self.name)


def _text(block: Element, ports: list[Element]) -> str:
    return f"# {block.name}\n\n" + "".join(f"- {port.name}\n" for port in ports)


BACKEND = Outline()
