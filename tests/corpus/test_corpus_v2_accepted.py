"""The OpenMBEE toolkit accepts the SysML v2 text of all XMI and AutomationML models.

``test_corpus_v2_same_graph`` reads the texts with sysmlc, and fails if they have errors.
"""

import pytest
from reading_corpus import XMI_FOLDERS, XMI_SUFFIXES, list_models, lower

from backends.sysml.sysml_texts import PASSES, write
from backends.sysml.toolkit import load
from examples.compiling import compile_example
from sysmlc.frontends.huds import FRONTEND as HUDS
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.sources import Source
from sysmlc.sources import load as load_file

pytestmark = [pytest.mark.corpus, pytest.mark.long]

MODELS = [
    *list_models(*(f"xmi/{folder}" for folder in XMI_FOLDERS), suffixes=XMI_SUFFIXES),
    *list_models("aml/baygate", "aml/dev", suffixes=(".aml", ".amlx")),
]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.name)
def test_the_toolkit_accepts_the_text(path):
    files, _ = write(compile_example(path, "ir").graph)
    assert load(files).complaints == []


def test_the_text_of_the_telescope_has_no_errors(corpus):
    """The export of MTIP has 55,860 elements; the toolkit needs 1.6 GB for its text of 16 MB."""
    sources = load_file(corpus / "xmi" / "huds" / "TMT_mtip.zip", "TMT_mtip.zip")
    files, _ = write(lower(sources, PASSES, HUDS)[0])
    _, sink = lower([Source(*file) for file in encode(files)], PASSES, FRONTEND)
    assert [str(error) for error in sink if error.is_error] == []


def encode(files):
    """Return the names and the bytes of texts."""
    return [(name, text.encode()) for name, text in files.items()]
