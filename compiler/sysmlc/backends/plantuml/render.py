"""From view models to PlantUML text: jinja2 templates, the user's before ours."""

from __future__ import annotations

from pathlib import Path

from sysmlc.backends.plantuml.views import Diagram
from sysmlc.backends.templates import render_template

_FOLDER = "plantuml"


class Renderer:
    """Renders diagrams; ``templates`` is the user's folder, whose files replace ours by name."""

    def __init__(self, templates: Path | None = None) -> None:
        self._templates = templates
        self.has_templates = templates is not None
        """Whether files of the user's may say how diagrams are written."""

    def text(self, diagram: Diagram, header: tuple[str, ...]) -> str:
        """PlantUML text of the diagram.

        Raises ``jinja2.TemplateError`` when a template of the user's is wrong.
        """
        name = f"{diagram.kind}.puml.j2"
        values = {"diagram": diagram, "view": diagram.view, "header": header}
        return render_template(_FOLDER, name, self._templates, **values)
