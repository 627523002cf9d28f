"""Templates of back ends: those of the user come before the shipped ones."""

from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from sysmlc import resources

if TYPE_CHECKING:
    from jinja2 import Environment


@cache
def _environment(folder: str, templates: Path | None) -> "Environment":
    """Return the environment that renders the templates of one back end.

    A template is looked up in ``templates/<folder>`` and ``templates`` of the user, then among the
    shipped ones. The environment compiles each template once; it reads a template of the user
    again when the file changes or when the user adds a file that replaces it.
    """
    # jinja2 takes 0.06 s to import, and only back ends with templates need it.
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    shipped = resources.path("templates", folder)
    folders = (shipped,) if templates is None else (templates / folder, templates, shipped)
    return Environment(
        loader=FunctionLoader(partial(_load, folders)),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
        auto_reload=templates is not None,
    )


def _load(folders: Iterable[Path], name: str) -> tuple[str, str, Callable[[], bool]] | None:
    """Return text and path of a template and a check that it is current (``FunctionLoader``)."""
    from jinja2.loaders import split_template_path

    paths = [path.joinpath(*split_template_path(name)) for path in folders]
    version = _find_version(paths)
    if version is None:
        return None
    path = version[0]
    return path.read_text(encoding="utf-8"), str(path), lambda: _find_version(paths) == version


def _find_version(paths: Iterable[Path]) -> tuple[Path, int, int] | None:
    """Return the first path that is a file, with its modification time and size."""
    for path in paths:
        with suppress(OSError):
            if path.is_file():
                status = path.stat()
                return path, status.st_mtime_ns, status.st_size
    return None


def render_template(folder: str, name: str, templates: Path | None, **values: object) -> str:
    """Render the template *name* of a back end.

    Raises ``jinja2.TemplateError`` if the template is faulty.
    """
    return _environment(folder, templates).get_template(name).render(**values)


def faults() -> type[Exception]:
    """Return the exception that a faulty template raises.

    It is a function because an ``except`` clause calls it only after something was raised, so
    that jinja2 need not be imported before.
    """
    from jinja2 import TemplateError

    return TemplateError
