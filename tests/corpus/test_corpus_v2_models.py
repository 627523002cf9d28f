"""The OMG's SysML v2 models compile without errors and without diagnostics of SysML v1's rules."""

import pytest

from sysmlc.diagnostics import Severity
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.frontends.sysml.rules import SEVERITIES

pytestmark = pytest.mark.corpus
FOLDERS = ("omg-release/training", "omg-release/examples", "showcase")
SILENT_RULES = {code for code, severity in SEVERITIES.items() if severity is None}


@pytest.mark.parametrize("folder", FOLDERS)
def test_a_folder_of_valid_models_compiles_without_errors(corpus, folder):
    backends = tuple(select_backends(("contracts", "plantuml")))
    compilation = compile_model(Request((corpus / "sysml2" / folder,), backends=backends))
    diagnostics = list(compilation.diagnostics)
    assert [
        diagnostic.message for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR
    ] == []
    assert {diagnostic.rule.code for diagnostic in diagnostics} & SILENT_RULES == set()
    assert len(list(compilation.list_published())) > 5
