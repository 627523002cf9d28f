"""Draw the packages of sysmlc and their imports into ``docs/architecture.md``.

Run ``python docs/draw_packages.py`` after a change of the imports between packages; a test compares
the page with the code. The drawing is a Mermaid diagram, which code hosts render. An arrow leads
from a package to one that it imports; arrows that follow from others are omitted.
"""

import ast
from pathlib import Path

import networkx

PAGE = Path(__file__).with_name("architecture.md")
ROOT = Path(__file__).parents[1] / "compiler" / "sysmlc"
START, END = "<!-- packages: docs/draw_packages.py -->\n", "<!-- end of packages -->\n"


def read_package_imports() -> networkx.DiGraph:
    """Return the graph of top-level packages and modules of sysmlc and their imports."""
    graph = networkx.DiGraph()
    for path in sorted(ROOT.rglob("*.py")):
        importer = path.relative_to(ROOT).with_suffix("").parts[0]
        if importer in ("__init__", "__main__"):
            continue
        graph.add_node(importer)
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                names = (f"{node.module}.{alias.name}" for alias in node.names)
                imported = {name.split(".")[1] for name in names if name.startswith("sysmlc.")}
                graph.add_edges_from(
                    (importer, package) for package in imported if is_package(package, importer)
                )
    return graph


def is_package(name: str, importer: str) -> bool:
    """Whether *name* is a package or module of sysmlc other than the one that imports it."""
    return name != importer and ((ROOT / name).is_dir() or (ROOT / f"{name}.py").is_file())


def draw(graph: networkx.DiGraph) -> str:
    """Return a Mermaid diagram of the transitive reduction of an acyclic graph."""
    reduced = networkx.transitive_reduction(graph)
    arrows = [f"  {importer} --> {imported}" for importer, imported in sorted(reduced.edges)]
    return "\n".join(["```mermaid", "flowchart TD", *arrows, "```", ""])


def insert(page: str, drawing: str) -> str:
    """Return *page* with *drawing* between the two marks."""
    before, _, rest = page.partition(START)
    return f"{before}{START}{drawing}{END}{rest.partition(END)[2]}"


def main() -> None:
    """Write the drawing into the page."""
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(insert(page, draw(read_package_imports())), encoding="utf-8")


if __name__ == "__main__":
    main()
