"""What of the model the text does not say: elements, edges and attributes that nobody wrote."""

from sysmlc.backends.sysml.book import Book


def account(book: Book) -> None:
    """Note all that is not said."""
