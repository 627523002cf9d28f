"""The whole plant: places of classes, then what everything holds, then links, then the account."""

from sysmlc.backends.aml import account, copies, files, libraries, links
from sysmlc.backends.aml.book import Book
from sysmlc.backends.aml.families import Families
from sysmlc.backends.aml.identity import Identity
from sysmlc.backends.aml.node import printed
from sysmlc.backends.aml.rules import ILLEGAL, Losses
from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Graph


def documents(graph: Graph, unit: str, sink: Sink) -> dict[str, str]:
    """The graph as CAEX files: text by path; what CAEX cannot say is reported."""
    made = files.files(graph, unit)
    sources = frozenset(file.name for file in made if file.document is not None)
    book = Book(graph, Losses(graph), made, Families(graph), Identity(sources))
    files.heads(book)
    libraries.place(book)
    libraries.fill(book)
    libraries.hierarchies(book)
    links.write(book)
    links.tie(book)
    copies.write(book)
    files.writers(book)
    account.account(book)
    texts = {}
    replaced = 0
    for file in book.files:
        texts[file.path], count = printed(file.root)
        replaced += count
    book.losses.report(sink)
    if replaced:
        first = next((graph.subject(one) for one in graph.roots()), Subject())
        sink.report(ILLEGAL, first, count=replaced)
    return texts
