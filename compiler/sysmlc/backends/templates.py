"""Templates of back ends: the user's before ours, and no name left undefined in silence."""

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from sysmlc import resources

if TYPE_CHECKING:
    from jinja2 import Environment


class _Options(TypedDict):
    trim_blocks: bool
    lstrip_blocks: bool
    keep_trailing_newline: bool
    autoescape: bool


OPTIONS: _Options = {
    "trim_blocks": True,
    "lstrip_blocks": True,
    "keep_trailing_newline": True,
    "autoescape": False,
}


@cache
def environment(folder: str, templates: Path | None) -> "Environment":
    """Templates of one back end, from ``templates/<folder>`` of the user, ``templates``, ours.

    jinja2 is imported here, because only back ends with templates need it. There is one for each
    folder, so that a template is compiled once; one of the user's that has changed is read anew,
    and so is one in whose place the user has put another.
    """
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    from sysmlc.backends.compiled_templates import CompiledTemplates

    ours = resources.path("templates", folder)
    folders = (ours,) if templates is None else (templates / folder, templates, ours)
    return Environment(
        loader=FunctionLoader(partial(_source, folders)),
        undefined=StrictUndefined,
        **OPTIONS,
        auto_reload=templates is not None,
        bytecode_cache=CompiledTemplates(OPTIONS) if templates is None else None,
    )


def _source(folders: Iterable[Path], name: str) -> tuple[str, str, Callable[[], bool]] | None:
    """The text of a template, where it is, and whether it is still that (``FunctionLoader``)."""
    from jinja2.loaders import split_template_path

    paths = [one.joinpath(*split_template_path(name)) for one in folders]
    found = _first(paths)
    if found is None:
        return None
    path = found[0]
    return path.read_text(encoding="utf-8"), str(path), lambda: _first(paths) == found


def _first(paths: Iterable[Path]) -> tuple[Path, int, int] | None:
    """The first file that is there, with time of change and size."""
    for path in paths:
        with suppress(OSError):
            if path.is_file():
                now = path.stat()
                return path, now.st_mtime_ns, now.st_size
    return None


def filled(folder: str, name: str, templates: Path | None, **values: object) -> str:
    """The text of a template: of ours by a function (``translate``), without importing jinja2.

    Raises ``jinja2.TemplateError`` when a template of the user's is wrong (``faults``).
    """
    if templates is None:
        return _functions(folder)[name](**values)
    return environment(folder, templates).get_template(name).render(**values)


@cache
def _functions(folder: str) -> Mapping[str, Callable[..., str]]:
    texts: Mapping[str, Callable[..., str]]
    texts = import_module(f"sysmlc.backends.{folder}.written").TEXTS
    return texts


def faults() -> type[Exception]:
    """What a wrong template raises; asked when something is raised, for jinja2 takes long."""
    from jinja2 import TemplateError

    return TemplateError
