"""Templates of back ends: the user's before ours, and no name left undefined in silence."""

from collections.abc import Callable, Mapping
from functools import cache
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
    folder, so that a template is compiled once; one of the user's that has changed is read anew.
    """
    from jinja2 import ChoiceLoader, Environment, FileSystemLoader, StrictUndefined

    from sysmlc.backends.compiled_templates import CompiledTemplates

    ours = resources.path("templates", folder)
    folders = [ours] if templates is None else [templates / folder, templates, ours]
    return Environment(
        loader=ChoiceLoader([FileSystemLoader(one) for one in folders]),
        undefined=StrictUndefined,
        **OPTIONS,
        auto_reload=templates is not None,
        bytecode_cache=CompiledTemplates(OPTIONS) if templates is None else None,
    )


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
