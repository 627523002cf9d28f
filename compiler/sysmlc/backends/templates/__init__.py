"""Templates of back ends: the shipped ones, and files of a user that replace them by name."""

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Self

from sysmlc.backends.templates.files import (
    TemplateError,
    TemplateLimitError,
    UnusableFolderError,
    read_custom,
    read_shipped,
)
from sysmlc.backends.templates.process import RenderingProcess
from sysmlc.backends.templates.sandbox import make_environment, render

if TYPE_CHECKING:
    from jinja2.sandbox import ImmutableSandboxedEnvironment

__all__ = ["TemplateError", "Templates"]


MAX_CHARACTERS = 10_000_000
"""Size limit of one text; the largest diagram of the real models has 0.3 million characters."""


class Templates:
    """Templates of one back end; a context manager.

    Shipped templates are rendered in this process. If *folder* holds a template, which may be
    hostile, a ``RenderingProcess`` renders all templates.
    """

    def __init__(self, backend: str, folder: Path | None) -> None:
        self._backend = backend
        self._folder = folder
        self._process: RenderingProcess | None = None
        self._error: TemplateError | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        if self._process is not None:
            self._process.close()

    def render(self, name: str, **values: object) -> str:
        """Render a template. Raises TemplateError.

        If the folder cannot be read or a limit was exceeded, each later call raises that error
        again, so that one back end exceeds the limit of time once.
        """
        if self._error is not None:
            raise self._error
        try:
            process = self._start_process()
            if process is None:
                return render(_shipped_environment(self._backend), name, values, MAX_CHARACTERS)
            return process.render(name, values)
        except (TemplateLimitError, UnusableFolderError) as error:
            self._error = error
            raise

    def _start_process(self) -> RenderingProcess | None:
        """Return the process that renders; None if the folder replaces no template."""
        if self._process is None and self._folder is not None:
            custom = read_custom(self._folder, self._backend)
            if custom:
                templates = read_shipped(self._backend) | custom
                self._process = RenderingProcess(templates, MAX_CHARACTERS)
            else:
                self._folder = None
        return self._process


@cache
def _shipped_environment(backend: str) -> "ImmutableSandboxedEnvironment":
    return make_environment(read_shipped(backend))
