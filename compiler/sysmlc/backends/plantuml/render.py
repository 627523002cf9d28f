"""From view models to PlantUML text: jinja2 templates, the user's before ours."""

from __future__ import annotations

from pathlib import Path

from sysmlc.backends.plantuml.views import Diagram
from sysmlc.backends.templates import environment

_FOLDER = "plantuml"


class Renderer:
    """Renders diagrams; ``templates`` is the user's folder, whose files replace ours by name."""

    def __init__(self, templates: Path | None = None) -> None:
        self._environment = environment(_FOLDER, templates)

    def text(self, diagram: Diagram, header: tuple[str, ...]) -> str:
        """PlantUML text of the diagram.

        Raises ``jinja2.TemplateError`` when a template of the user's is wrong.
        """
        template = self._environment.get_template(f"{diagram.kind}.puml.j2")
        return template.render(diagram=diagram, view=diagram.view, header=header)
