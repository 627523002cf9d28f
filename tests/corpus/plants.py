"""The AutomationML of the corpus as compile units, and their graphs after structural passes."""

from reading_corpus import BAYGATE_FILES, lower

from sysmlc.frontends.caex import FRONTEND
from sysmlc.sources import load

PASSES = ("resolve", "kept", "inherit", "classify", "ports")


def refine(sources, frontend=FRONTEND):
    """Return the refined graph of sources."""
    return lower(sources, PASSES, frontend)[0]


def list_units(corpus):
    """Map each unit to its files: every entry of ``dev``, and the four forms of BayGate."""
    return list_baygate(corpus) | {
        path.name: [path] for path in sorted((corpus / "aml/dev").iterdir())
    }


def list_baygate(corpus):
    """Map the four forms of BayGate to their files; the form with libraries has three."""
    folder = corpus / "aml" / "baygate"
    files = {name: [folder / name] for name in BAYGATE_FILES}
    files["BayGate_extlibs.aml"] += sorted((folder / "libs").iterdir())
    return files


def load_unit(corpus, paths):
    """Load files under names relative to BayGate's folder, other files under their own names."""
    folder = corpus / "aml" / "baygate"
    names = [
        str(path.relative_to(folder)) if path.is_relative_to(folder) else path.name
        for path in paths
    ]
    return [source for path, name in zip(paths, names, strict=True) for source in load(path, name)]
