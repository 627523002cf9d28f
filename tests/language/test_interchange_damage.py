"""Damaged interchange files, archives and texts: findings, never a traceback."""

import random
import re

import pytest
from test_interchange_projects import archive
from v2_trees import interchange, owning, relating

from sysmlc.diagnostics import Sink
from sysmlc.language.formatter import format_text
from sysmlc.language.interchange import link, open_archive, read, write
from sysmlc.language.text import parse
from sysmlc.sources import Source, SourceError

CHAIN = '<ownedRelatedElement xsi:type="sysml:Feature" xmi:id="c">' + (
    relating("FeatureChaining", 'chainingFeature="f"') * 2 + "</ownedRelatedElement>"
)
MODEL = interchange(
    owning(
        "Package",
        'xmi:id="p" declaredName="P"',
        relating("NamespaceImport", 'importedNamespace="p"')
        + owning("PartDefinition", 'xmi:id="d" declaredName="D"')
        + owning(
            "PartUsage",
            'xmi:id="f" declaredName="f" isComposite="true"',
            relating("FeatureTyping", 'typedFeature="f" type="d"')
            + relating("Subsetting", 'subsettingFeature="f" subsettedFeature="c"', CHAIN)
            + owning("LiteralInteger", 'value="3"', membership="FeatureValue"),
            "FeatureMembership",
        )
        + relating("Membership", 'memberName="A" memberElement="d"'),
    )
)
KINDS = ["PartUsage", "Membership", "Subsetting", "FeatureValue", "Package", "NamespaceImport"]
TEXT = """\
package P { // note
    part def A { attribute x : Real[0..*] = f(1, 2)->select {in y; y > 1 and not z}.w [kg]; }
    /* comment
     * of two lines */
    state s { transition first a accept b do action { assign x := 1; } then c; }
}
"""


def damaged(text, seed):
    """The text with some words, tags and characters taken out, doubled or exchanged."""
    dice = random.Random(seed)
    for _ in range(dice.randint(1, 4)):
        start = dice.randrange(len(text))
        end = min(len(text), start + dice.choice((1, 3, 12, 60)))
        text = (
            text[:start] + dice.choice(("", text[start:end] * 2, "<", "}", "é", '"')) + text[end:]
        )
    return text


def rearranged(seed):
    """The model with metaclasses and ids exchanged: well-formed, but not what was meant."""
    dice = random.Random(seed)
    text = re.sub(
        r"sysml:\w+", lambda m: dice.choice([m[0]] * 3 + [f"sysml:{dice.choice(KINDS)}"]), MODEL
    )
    return re.sub(r'="([pdfc])"', lambda _: f'="{dice.choice("pdfcx")}"', text)


@pytest.mark.parametrize("make", [lambda seed: damaged(MODEL, seed), rearranged])
def test_damaged_interchange_files(make):
    for seed in range(150):
        sink = Sink()
        try:
            document = read(Source("m.sysmlx", make(seed).encode()), sink)
        except SourceError:
            continue
        link([document], sink)
        write(document, [document], sink)


def test_damaged_archives():
    whole = archive().data
    for seed in range(100):
        dice, data = random.Random(seed), bytearray(whole)
        for _ in range(dice.randint(1, 6)):
            data[dice.randrange(len(data))] = dice.randrange(256)
        open_archive(Source("a.kpar", bytes(data[: dice.randint(20, len(data))])), Sink())


def test_damaged_texts_are_laid_out_or_left_alone():
    done = 0
    for seed in range(200):
        text, sink = damaged(TEXT, seed), Sink()
        parse(text, "m.sysml", "sysml", sink)
        if not sink.has_errors():
            made = format_text(text, "sysml")
            assert format_text(made, "sysml") == made
            done += 1
    assert done > 5


def test_a_reference_to_the_top_of_the_file_has_a_name():
    text = interchange(
        owning(
            "PartDefinition",
            'xmi:id="d" declaredName="D"',
            relating("Subclassification", 'subclassifier="d" superclassifier="root"'),
        )
    )
    document = read(Source("m.sysmlx", text.encode()), Sink())
    link([document], Sink())
    (relation,) = document.root.members[0].relations
    assert relation.reference.chain == (("#",),)
