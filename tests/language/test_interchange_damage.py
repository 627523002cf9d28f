"""Damaged interchange files, archives and texts have diagnostics and raise no exceptions."""

import json
import random
import re

import pytest
from interchange_files import write_file, write_member, write_relationship
from test_interchange_projects import ABOUT, write_archive, write_meta

from sysmlc.diagnostics import Sink
from sysmlc.language.formatter import format_text
from sysmlc.language.interchange import link, open_archive, read
from sysmlc.language.interchange.writer import write
from sysmlc.language.text import parse
from sysmlc.sources import Source, SourceError

CHAIN = '<ownedRelatedElement xsi:type="sysml:Feature" xmi:id="c">' + (
    write_relationship("FeatureChaining", 'chainingFeature="f"') * 2 + "</ownedRelatedElement>"
)
MODEL = write_file(
    write_member(
        "Package",
        'xmi:id="p" declaredName="P"',
        write_relationship("NamespaceImport", 'importedNamespace="p"')
        + write_member("PartDefinition", 'xmi:id="d" declaredName="D"')
        + write_member(
            "PartUsage",
            'xmi:id="f" declaredName="f" isComposite="true"',
            write_relationship("FeatureTyping", 'typedFeature="f" type="d"')
            + write_relationship("Subsetting", 'subsettingFeature="f" subsettedFeature="c"', CHAIN)
            + write_member("LiteralInteger", 'value="3"', membership="FeatureValue"),
            "FeatureMembership",
        )
        + write_relationship("Membership", 'memberName="A" memberElement="d"'),
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


def damage(text, seed):
    """Return the text with some parts removed, repeated or replaced by a character."""
    dice = random.Random(seed)
    for _ in range(dice.randint(1, 4)):
        start = dice.randrange(len(text))
        end = min(len(text), start + dice.choice((1, 3, 12, 60)))
        text = (
            text[:start] + dice.choice(("", text[start:end] * 2, "<", "}", "é", '"')) + text[end:]
        )
    return text


def exchange_kinds_and_ids(seed):
    """Return the model with random metaclasses and ids: well-formed, but mostly invalid."""
    dice = random.Random(seed)
    text = re.sub(
        r"sysml:\w+",
        lambda kind: dice.choice([kind[0]] * 3 + [f"sysml:{dice.choice(KINDS)}"]),
        MODEL,
    )
    return re.sub(r'="([pdfc])"', lambda _: f'="{dice.choice("pdfcx")}"', text)


@pytest.mark.parametrize("damage_model", [lambda seed: damage(MODEL, seed), exchange_kinds_and_ids])
def test_damaged_interchange_files_raise_no_exception(damage_model):
    for seed in range(150):
        sink = Sink()
        try:
            document = read(Source("m.sysmlx", damage_model(seed).encode()), sink)
        except SourceError:
            continue
        link([document], sink)
        write(document, [document], sink)


def damage_bytes(data, dice):
    """Return bytes of which up to six have another value."""
    damaged = bytearray(data)
    for _ in range(dice.randint(1, 6)):
        damaged[dice.randrange(len(data))] = dice.randrange(256)
    return bytes(damaged)


def test_damaged_archives_are_refused():
    archive = write_archive().data
    for seed in range(50):
        dice, sink = random.Random(seed), Sink()
        data = damage_bytes(archive, dice)[: dice.randint(20, len(archive))]
        assert open_archive(Source("a.kpar", data), sink) is None
        assert [found.rule.code for found in sink] != []


def test_damaged_descriptions_in_archives_raise_no_exception():
    """The archive itself is valid, so that its descriptions are read."""
    project, meta = (json.dumps(value).encode() for value in (ABOUT, write_meta()))
    reported = 0
    for seed in range(100):
        dice, sink = random.Random(seed), Sink()
        if seed % 2:
            contents = {"project": damage_bytes(project, dice)}
        else:
            contents = {"meta": damage_bytes(meta, dice)}
        assert open_archive(write_archive(**contents), sink) is not None
        reported += bool(list(sink))
    assert reported > 80


def test_damaged_texts_are_formatted_canonically_or_rejected():
    valid = 0
    for seed in range(200):
        text, sink = damage(TEXT, seed), Sink()
        parse(text, "m.sysml", "sysml", sink)
        if not sink.has_errors():
            formatted = format_text(text, "sysml")
            assert format_text(formatted, "sysml") == formatted
            valid += 1
    assert valid > 5


def test_a_reference_to_the_root_namespace_has_a_name():
    text = write_file(
        write_member(
            "PartDefinition",
            'xmi:id="d" declaredName="D"',
            write_relationship("Subclassification", 'subclassifier="d" superclassifier="root"'),
        )
    )
    document = read(Source("m.sysmlx", text.encode()), Sink())
    link([document], Sink())
    (relation,) = document.root.members[0].relations
    assert relation.reference.chain == (("#",),)
