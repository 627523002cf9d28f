"""The OMG's SysML v2 models, each folder as one unit: no error, and nothing of SysML v1's rules."""

import pytest

from sysmlc.diagnostics import Severity
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.frontends.sysml.rules import SEVERITIES

pytestmark = pytest.mark.corpus
FOLDERS = ("omg-release/training", "omg-release/examples", "showcase")
SILENT = {code for code, severity in SEVERITIES.items() if severity is None}


@pytest.mark.parametrize("folder", FOLDERS)
def test_valid_models_compile_without_an_error(corpus, folder):
    backends = tuple(select_backends(("contracts", "plantuml")))
    made = compile_model(Request((corpus / "sysml2" / folder,), backends=backends))
    found = list(made.diagnostics)
    assert [one.message for one in found if one.severity is Severity.ERROR] == []
    assert {one.rule.code for one in found} & SILENT == set()
    assert len(list(made.list_published())) > 5
