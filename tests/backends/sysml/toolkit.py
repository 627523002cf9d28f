"""The OpenMBEE toolkit (distribution ``sysml``) as the oracle for SysML v2 text.

It loads a text with the standard library, raises an exception for a syntax error, and answers
``UnresolvedReference`` for each unknown name.
"""

import gc
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field

import pytest

sysml = pytest.importorskip("sysml", reason="the distribution 'sysml' has no wheel here")

REFERENCES = {
    "FeatureTyping": "type",
    "Redefinition": "redefinedFeature",
    "Subsetting": "subsettedFeature",
    "ReferenceSubsetting": "referencedFeature",
    "Subclassification": "superclassifier",
    "Membership": "memberElement",
    "FeatureChaining": "chainingFeature",
    "ConjugatedPortTyping": "conjugatedPortDefinition",
    "NamespaceImport": "importedNamespace",
    "MembershipImport": "importedMembership",
    "Dependency": "supplier",
    "Annotation": "annotatedElement",
}
"""The feature with the target of each kind of relationship."""
TYPINGS = ("FeatureTyping", "Subclassification", "ConjugatedPortTyping")


@dataclass
class Loaded:
    """A model as the toolkit reads it."""

    complaints: list = field(default_factory=list)
    elements: dict = field(default_factory=dict)
    """Metaclasses by qualified name, a tuple of names."""
    types: dict = field(default_factory=dict)
    """Names of the types and generals in the declaration, by qualified name."""


def load(files):
    """Load texts by name together with the standard library. Raises for a syntax error."""
    loaded = Loaded()
    _read(loaded, files)
    # Models of the toolkit are reference cycles; what survives is not traversed again.
    gc.collect()
    gc.freeze()
    return loaded


def _read(loaded, files):
    model = sysml.Model.from_toolkit(sources=files, library_dir=sysml.standard_library())
    for element in model.all():
        _check(loaded, element)
        name = element.qualifiedName if hasattr(type(element), "qualifiedName") else None
        if name:
            path = split_name(name)
            loaded.elements.setdefault(path, Counter())[element.metaclass_name] += 1
            loaded.types.setdefault(path, set()).update(_iter_types(element))


def _check(loaded, element):
    feature = REFERENCES.get(element.metaclass_name)
    if feature is None:
        return
    try:
        target = getattr(element, feature)
    except sysml.UnresolvedReference as problem:
        loaded.complaints.append(str(problem))
    except sysml.NotImplementedInToolkit:
        return
    else:
        if target in (None, []):
            loaded.complaints.append(f"{element!r} refers to nothing")


def _iter_types(element):
    """Yield the names of the types or generals in the declaration of an element."""
    for relation in element.ownedRelationship:
        if relation.metaclass_name not in TYPINGS:
            continue
        with suppress(sysml.UnresolvedReference):
            target = getattr(relation, REFERENCES[relation.metaclass_name])
            yield split_name(target.qualifiedName)[-1].removeprefix("~")


def split_name(name):
    """Return the segments of a qualified name, without quotes and escapes."""
    segments, start = [], 0
    while start < len(name):
        if name[start] != "'":
            end = name.find("::", start)
            end = len(name) if end < 0 else end
            segments.append(name[start:end])
        else:
            end, text = start + 1, ""
            while name[end] != "'":
                step = 2 if name[end] == "\\" else 1
                text += _unescape(name[end : end + step])
                end += step
            segments.append(text)
            end += 1
        start = end + 2
    return tuple(segments)


def _unescape(text):
    return {"\\n": "\n", "\\t": "\t", "\\r": "\r", "\\b": "\b", "\\f": "\f"}.get(text, text[-1])
