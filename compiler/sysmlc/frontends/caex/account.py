"""What became of every element of a file: coverage, and findings about what leads nowhere."""

import re
from collections import Counter
from html import unescape

from sysmlc.diagnostics import Coverage, Subject, Verdict
from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.context import Context, path_of
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Missing
from sysmlc.sources import Source

_EXTERNAL = re.compile(rb"<(?:[\w.-]+:)?ExternalReference\b[^>]*")
_PATH = re.compile(rb"""\bPath\s*=\s*(?:"([^"]+)|'([^']+))""")


def links(source: Source) -> list[str]:
    """Files that external references name, each once and in order."""
    tags = _EXTERNAL.findall(source.data)
    found = (match for tag in tags if (match := _PATH.search(tag)))
    paths = (unescape((m[1] or m[2]).decode("utf-8", "replace")) for m in found)
    return list(dict.fromkeys(paths))


def account(context: Context, coverage: Coverage) -> None:
    """Count every element of each file once, and report what is not read or leads nowhere."""
    for document in context.documents:
        counts = coverage.file(document.name)
        table: Counter[tuple[str, Verdict]] = Counter()
        lost: dict[str, list[Node]] = {}
        for node in document.root.walk():
            verdict = node.verdict or Verdict.UNSUPPORTED
            table[node.tag, verdict] += 1
            for tag in node.texts or ():
                if tag:
                    table[tag, verdict] += 1
            if node.verdict is None:
                lost.setdefault(node.tag, []).append(node)
        for (tag, verdict), number in table.items():
            counts.count(tag, verdict, number)
        _report_lost(context, document, lost)
    _report_missing(context)
    context.report_repeated()


def _report_lost(context: Context, document: Document, lost: dict[str, list[Node]]) -> None:
    for tag, nodes in lost.items():
        count = "1 element" if len(nodes) == 1 else f"{len(nodes)} elements"
        context.report(rules.UNSUPPORTED, document, nodes[0], count=count, tag=tag)


def _report_missing(context: Context) -> None:
    together: dict[Missing, list[tuple[Document, Node]]] = {}
    for missing, uses in context.missing.items():
        for document, node in uses:
            if missing.what == "class":
                _report_class(context, missing, document, node)
            elif missing.what == "alias":
                element = f"'{path_of(node)}'"
                context.report(
                    rules.UNDECLARED_ALIAS, document, node, element=element, alias=missing.name
                )
            else:
                together.setdefault(missing, []).append((document, node))
    for missing, uses in together.items():
        _report_outside(context, missing, uses)


def _report_class(context: Context, missing: Missing, document: Document, node: Node) -> None:
    context.report(
        rules.MISSING_CLASS,
        document,
        node,
        element=f"'{path_of(node)}'",
        family="class",
        path=missing.name,
    )


def _report_outside(context: Context, missing: Missing, uses: list[tuple[Document, Node]]) -> None:
    document, node = uses[0]
    rule = rules.MISSING_CLASS_LIBRARY if missing.what == "library" else rules.MISSING_FILE
    count = "1 element" if len(uses) == 1 else f"{len(uses)} elements"
    subject = Subject(missing.name, place=document.place(node))
    names = [path_of(one) for _, one in uses]
    notes = tuple(names[:10]) + ((f"and {len(names) - 10} more",) if len(names) > 10 else ())
    context.sink.report(
        rule, subject, notes=notes, library=missing.name, file=missing.name, count=count
    )
