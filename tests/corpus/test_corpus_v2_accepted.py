"""The OpenMBEE toolkit accepts the SysML v2 text of all XMI and AutomationML models.

``test_corpus_v2_same_graph`` reads the texts with sysmlc, and fails if they have errors.
"""

import pytest
from reading_corpus import XMI_FOLDERS, XMI_SUFFIXES, list_models

from backends.sysml.sysml_texts import write
from backends.sysml.toolkit import load
from examples.compiling import compile_example

pytestmark = [pytest.mark.corpus, pytest.mark.long]

MODELS = [
    *list_models(*(f"xmi/{folder}" for folder in XMI_FOLDERS), suffixes=XMI_SUFFIXES),
    *list_models("aml/baygate", "aml/dev", suffixes=(".aml", ".amlx")),
]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.name)
def test_the_toolkit_accepts_the_text(path):
    files, _ = write(compile_example(path, "ir").graph)
    assert load(files).complaints == []
