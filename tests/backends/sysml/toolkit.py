"""The OpenMBEE toolkit (distribution ``sysml``) as the judge of our SysML v2 text.

It loads a text with the standard library, raises for a syntax error, and answers
``UnresolvedReference`` for each name that it does not find.
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
"""What each kind of relationship refers to."""
TYPINGS = ("FeatureTyping", "Subclassification", "ConjugatedPortTyping")


@dataclass
class Loaded:
    """A model as the toolkit understands it."""

    complaints: list = field(default_factory=list)
    elements: dict = field(default_factory=dict)
    """Metaclasses by qualified name, a tuple of names."""
    types: dict = field(default_factory=dict)
    """Names of the types and generals that the text gives, by qualified name."""


def load(files):
    """Load texts by name together with the standard library. Raises for a syntax error."""
    loaded = Loaded()
    _read(loaded, files)
    # The toolkit's models are circles, which nobody else's frozen graphs may keep alive.
    gc.unfreeze()
    gc.collect()
    return loaded


def _read(loaded, files):
    model = sysml.Model.from_toolkit(sources=files, library_dir=sysml.standard_library())
    for element in model.all():
        _check(loaded, element)
        name = element.qualifiedName if hasattr(type(element), "qualifiedName") else None
        if name:
            path = parts(name)
            loaded.elements.setdefault(path, Counter())[element.metaclass_name] += 1
            loaded.types.setdefault(path, set()).update(_types(element))


def _check(loaded, element):
    feature = REFERENCES.get(element.metaclass_name)
    if feature is None:
        return
    try:
        found = getattr(element, feature)
    except sysml.UnresolvedReference as problem:
        loaded.complaints.append(str(problem))
    except sysml.NotImplementedInToolkit:
        return
    else:
        if found in (None, []):
            loaded.complaints.append(f"{element!r} refers to nothing")


def _types(element):
    """Names of the types, or the generals, that stand in the declaration of an element."""
    for relation in element.ownedRelationship:
        if relation.metaclass_name not in TYPINGS:
            continue
        with suppress(sysml.UnresolvedReference):
            found = getattr(relation, REFERENCES[relation.metaclass_name])
            yield parts(found.qualifiedName)[-1].removeprefix("~")


def parts(name):
    """The names that a qualified name consists of, without quotes and escapes."""
    found, at = [], 0
    while at < len(name):
        if name[at] != "'":
            end = name.find("::", at)
            end = len(name) if end < 0 else end
            found.append(name[at:end])
        else:
            end, text = at + 1, ""
            while name[end] != "'":
                step = 2 if name[end] == "\\" else 1
                text += _unescaped(name[end : end + step])
                end += step
            found.append(text)
            end += 1
        at = end + 2
    return tuple(found)


def _unescaped(text):
    return {"\\n": "\n", "\\t": "\t", "\\r": "\r", "\\b": "\b", "\\f": "\f"}.get(text, text[-1])
