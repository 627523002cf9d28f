"""The libraries and profiles that are shipped with sysmlc pass its own check."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc
from sysmlc.support import resources

FOLDER = Path(str(resources.path("metamodels", "RecipeLevels.sysml"))).parent
MODELS = (".aml", ".kerml", ".sysml", ".uml", ".xmi")
LIBRARIES = sorted(
    path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("*") if path.suffix in MODELS
)


def test_libraries_of_each_language_are_shipped():
    suffixes = {Path(library).suffix for library in LIBRARIES}
    assert {".aml", ".kerml", ".sysml", ".uml"} <= suffixes


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_shipped_library_passes_the_check(library):
    result = CliRunner().invoke(sysmlc, ["check", str(FOLDER / library)])
    assert result.exit_code == 0, result.output
