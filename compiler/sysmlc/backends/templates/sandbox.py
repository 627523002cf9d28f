"""The sandbox that renders templates."""

from collections.abc import Mapping
from traceback import walk_tb

from jinja2 import FunctionLoader, StrictUndefined, TemplateNotFound, TemplateSyntaxError
from jinja2.sandbox import ImmutableSandboxedEnvironment

from sysmlc.backends.templates.files import TemplateError, TemplateText

_GLOBALS = ("range", "dict", "namespace")
"""Functions that a template can call. Jinja's others are random or only ornamental."""
_NOT_DETERMINISTIC = "random"
"""The filter that would make outputs differ from run to run."""


def make_environment(templates: Mapping[str, TemplateText]) -> ImmutableSandboxedEnvironment:
    """Return the environment that renders *templates*, which may include one another only.

    The sandbox refuses attributes that begin with an underscore, changes of lists and dicts, and
    ``str.format`` that reaches for such attributes.
    """

    def load(name: str) -> tuple[str, str, None] | None:
        template = templates.get(name)
        return None if template is None else (template.text, template.file, None)

    environment = ImmutableSandboxedEnvironment(
        loader=FunctionLoader(load),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
        auto_reload=False,
    )
    environment.globals = {name: environment.globals[name] for name in _GLOBALS}
    del environment.filters[_NOT_DETERMINISTIC]
    return environment


def render(
    environment: ImmutableSandboxedEnvironment,
    name: str,
    values: Mapping[str, object],
    max_characters: int,
) -> str:
    """Render one template. Raises TemplateError."""
    try:
        chunks, size = [], 0
        for chunk in environment.get_template(name).generate(**values):
            size += len(chunk)
            if size > max_characters:
                raise TemplateError(f"{name}: writes more than {max_characters:,} characters")
            chunks.append(chunk)
        return "".join(chunks)
    except TemplateError:
        raise
    except MemoryError as error:
        raise TemplateError(f"{name}: needs too much memory") from error
    except Exception as error:
        raise TemplateError(_describe(error, name)) from error


def _describe(error: Exception, name: str) -> str:
    """Return file, line and message of an error that Jinja or an operation in a template raised."""
    message = str(error) or type(error).__name__
    if isinstance(error, TemplateSyntaxError):
        return f"{error.filename or name}:{error.lineno}: {error.message}"
    if isinstance(error, TemplateNotFound):
        message = f"there is no template '{error}'"
    # Jinja rewrites tracebacks: their frames name files and lines of templates.
    lines = [
        (frame.f_code.co_filename, line)
        for frame, line in walk_tb(error.__traceback__)
        if frame.f_code.co_filename.endswith(".j2")
    ]
    file, line = lines[-1] if lines else (name, 1)
    return f"{file}:{line}: {message}"
