"""sysmlc and the OpenMBEE toolkit accept the SysML v2 text of all XMI and AutomationML models."""

import gc

import pytest
from reading_corpus import XMI_FOLDERS, XMI_SUFFIXES, list_models, lower

from backends.sysml.sysml_texts import write
from backends.sysml.toolkit import load
from examples.compiling import compile_example
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.sources import Source

pytestmark = [pytest.mark.corpus, pytest.mark.long]

MODELS = [
    *list_models(*(f"xmi/{folder}" for folder in XMI_FOLDERS), suffixes=XMI_SUFFIXES),
    *list_models("aml/baygate", "aml/dev", suffixes=(".aml", ".amlx")),
]
ERRORS = {"Alf.library.uml": (12, 19)}
"""Errors of sysmlc and complaints of the toolkit by model; all others have none.

The library of Alf has template parameters, for which SysML v2 has no construct: what redefines an
operation of a template has another type, and an outside template has none of its parameters.
"""


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.name)
def test_both_tools_accept_the_text(path):
    files, _ = write(compile_example(path, "ir").graph)
    _, sink = lower(
        [Source(name, text.encode()) for name, text in files.items()],
        ("resolve", "inherit", "classify", "ports"),
        FRONTEND,
    )
    errors = [f"{error.rule.code} {error.message}" for error in sink if error.is_error]
    complaints = load(files).complaints
    gc.unfreeze()
    assert (len(errors), len(complaints)) == ERRORS.get(path.name, (0, 0)), errors + complaints
