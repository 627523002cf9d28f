"""The words of formatted texts; imported only when a model has one."""

from html.parser import HTMLParser

_BLOCKS = frozenset(["p", "br", "li", "tr", "div", "h1", "h2", "h3", "h4", "ul", "ol", "table"])
_SILENT = frozenset(["head", "style", "script"])


def words(text: str) -> str:
    """The words of an HTML document, a line for each block."""
    reader = _Words()
    reader.feed(text)
    reader.close()
    rows = (" ".join(row.split()) for row in "".join(reader.found).splitlines())
    return "\n".join(row for row in rows if row)


class _Words(HTMLParser):
    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.found: list[str] = []
        self._silent = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._silent += tag in _SILENT
        if tag in _BLOCKS:
            self.found.append("\n")

    def handle_endtag(self, tag: str) -> None:
        self._silent = max(0, self._silent - (tag in _SILENT))
        if tag in _BLOCKS:
            self.found.append("\n")

    def handle_data(self, data: str) -> None:
        if not self._silent:
            self.found.append(data.replace("\n", " "))
