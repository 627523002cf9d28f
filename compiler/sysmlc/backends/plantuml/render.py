"""From view models to PlantUML text: jinja2 templates, the user's before ours."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from sysmlc import resources
from sysmlc.backends.plantuml.views import Diagram

if TYPE_CHECKING:
    from jinja2 import Environment

_FOLDER = "plantuml"


class Renderer:
    """Renders diagrams; ``templates`` is the user's folder, whose files replace ours by name."""

    def __init__(self, templates: Path | None = None) -> None:
        self._environment = _environment(templates)

    def text(self, diagram: Diagram, header: tuple[str, ...]) -> str:
        """PlantUML text of the diagram.

        Raises ``jinja2.TemplateError`` when a template of the user's is wrong.
        """
        template = self._environment.get_template(f"{diagram.kind}.puml.j2")
        return template.render(diagram=diagram, view=diagram.view, header=header)


def _environment(templates: Path | None) -> Environment:
    from jinja2 import ChoiceLoader, Environment, FileSystemLoader, StrictUndefined

    ours = resources.path("templates", _FOLDER)
    folders = [ours] if templates is None else [templates / _FOLDER, templates, ours]
    return Environment(
        loader=ChoiceLoader([FileSystemLoader(folder) for folder in folders]),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
