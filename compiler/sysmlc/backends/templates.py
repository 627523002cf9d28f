"""Templates of back ends: the user's before ours, and no name left undefined in silence."""

from functools import cache
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


_OPTIONS: _Options = {
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

    ours = resources.path("templates", folder)
    if templates is not None:
        loaders = [FileSystemLoader(one) for one in (templates / folder, templates, ours)]
        return Environment(
            loader=ChoiceLoader(loaders), undefined=StrictUndefined, **_OPTIONS, auto_reload=True
        )
    from sysmlc.backends.compiled_templates import CompiledTemplates, WholeTemplates

    return Environment(
        loader=WholeTemplates(ours),
        undefined=StrictUndefined,
        **_OPTIONS,
        auto_reload=False,
        bytecode_cache=CompiledTemplates(_OPTIONS),
    )
