"""Values that UML does not know for an attribute are reported, once for each value and file."""

import pytest
from reading_xmi import papyrus, read

CLASS = '<packagedElement xmi:type="uml:Class" xmi:id="{0}" name="{0}" {1}/>'
NODE = (
    '<packagedElement xmi:type="uml:Activity" xmi:id="a" name="A">'
    '<node xmi:type="uml:{}" xmi:id="n" name="n" {}/></packagedElement>'
)


def test_an_unknown_value_is_reported_once_and_omitted():
    reading = read(papyrus("".join(CLASS.format(x, 'isAbstract="yes"') for x in "bc")))
    assert reading.findings == [
        "unknown-value: 'isAbstract' of 'M::b' and 1 more is 'yes', which is not one of true, false"
    ]
    assert [finding.subject.id for finding in reading.sink] == ["b"]
    assert "abstract" not in reading.graph["b"].attrs
    assert reading.totals == {"elements": 4, "mapped": 2, "approximated": 2}


@pytest.mark.parametrize(
    ("model", "known"),
    [
        (CLASS.format("k", 'visibility="hidden"'), "public, private, protected, package"),
        (CLASS.format("k", 'isLeaf="maybe"'), "true, false"),
        (CLASS.format("k", 'xmi:uuid="1" isActive=""'), "true, false"),
        (NODE.format("CentralBufferNode", 'ordering="fifo"'), "unordered, ordered, LIFO, FIFO"),
        (NODE.format("ExpansionRegion", 'mode="serial"'), "parallel, iterative, stream"),
        (
            '<packageImport xmi:id="i" importedPackage="m" visibility="all"/>',
            "public, private, protected, package",
        ),
        (
            '<ownedRule xmi:id="r"><visibility>all</visibility></ownedRule>',
            "public, private, protected, package",
        ),
    ],
)
def test_enumerated_attributes(model, known):
    (message,) = read(papyrus(model)).findings
    assert message.endswith(f"which is not one of {known}")


@pytest.mark.parametrize(("written", "leaf"), [("1", True), ("0", None), ("true", True)])
def test_truth_values_have_two_spellings_in_every_attribute(written, leaf):
    reading = read(papyrus(CLASS.format("k", f'isLeaf="{written}" isActive="{written}"')))
    assert reading.findings == []
    assert reading.graph["k"].attrs.get("leaf") is leaf
    assert reading.graph["k"].attrs.get("active") is leaf


@pytest.mark.parametrize(("written", "unique"), [("1", None), ("0", False), ("false", False)])
def test_flags_that_are_true_by_default(written, unique):
    owned = f'<ownedAttribute xmi:id="p" isUnique="{written}"/>'
    model = f'<packagedElement xmi:type="uml:Class" xmi:id="k">{owned}</packagedElement>'
    reading = read(papyrus(model))
    assert reading.findings == []
    assert reading.graph["p"].attrs.get("unique") is unique


def test_values_beyond_fifty_are_counted():
    models = (CLASS.format(f"c{n}", f'visibility="v{n}"') for n in range(60))
    findings = list(read(papyrus("".join(models))).sink)
    assert len(findings) == 50
    assert findings[-1].notes == ("10 more such values are in the file",)
