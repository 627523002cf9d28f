"""Overlays as text: diagnostics of faulty overlays, and the content of valid overlays."""

import json

import pytest
from jsonschema import Draft202012Validator

from sysmlc.diagnostics import Sink
from sysmlc.documents import parse_yaml
from sysmlc.overlay import list_files, read_overlay
from sysmlc.passes.overlay.finder import join_path, name_in_unit, split_path
from sysmlc.sources import Source
from sysmlc.support import resources

RIGHT = "overlay: 1\nitems:\n  MiniPallet: {domain: physical}\n"


def list_diagnostics(data):
    """Return code, line, column and message of each diagnostic; a faulty overlay gives None."""
    sink = Sink()
    text = data.encode("utf-8") if isinstance(data, str) else data
    refinement = read_overlay(Source("p.overlay.yaml", text), sink)
    assert (refinement is None) == bool(len(sink))
    diagnostics = [(diagnostic, diagnostic.subject.place) for diagnostic in sink]
    return [
        (diagnostic.rule.code, place.line, place.column, diagnostic.message)
        for diagnostic, place in diagnostics
    ]


def print_nested_aliases(levels=12, width=9):
    rows = ["a0: &a0 [x, x]"]
    for level in range(1, levels):
        names = ", ".join([f"*a{level - 1}"] * width)
        rows.append(f"a{level}: &a{level} [{names}]")
    return "\n".join(rows)


@pytest.mark.parametrize(
    ("data", "line", "column", "problem"),
    [
        ("overlay: 1\nitems: [", 2, 9, "expected the node content, but found '<stream end>'"),
        ("overlay: 1\nitems: 'x", 2, 10, "found unexpected end of stream"),
        ("overlay: 1\n\titems: x", 2, 1, "found character '\\t' that cannot start any token"),
        ("overlay: 1\nitems: \x00", 2, 8, "the character #x0000 is not allowed"),
        ('overlay: 1\nitems: "\\ud800"', 2, 8, "an escape such as \\ud800 is only half of a"),
        (b"overlay: 1\n# caf\xe9\n", 2, 6, "it is not UTF-8 here"),
        ("overlay: 1\n---\noverlay: 1\n", 2, 1, "a second document begins"),
        ("overlay: !!python/object:os.system 1\n", 1, 10, "the tag tag:yaml.org"),
        ("overlay: 1\nitems: *none\n", 2, 8, "there is no anchor 'none' before this"),
        ("overlay: 1\nitems: &a [*a]\n", 2, 12, "'a' contains itself"),
        ("overlay: 1\n? [a]\n: 1\n", 2, 3, "a key is a word, not a list or a mapping"),
        ("overlay: 1\nitems: " + "[" * 5000, 2, 27, "it is nested too deeply"),
        ("overlay: 1\nitems: " + "{a: " * 5000, 2, 84, "it is nested too deeply"),
        ("overlay: 1\nitems:\n" + "- " * 5000, 3, 39, "it is nested too deeply"),
        (print_nested_aliases(), 5, 0, "its aliases make it too large"),
        ("overlay: 1\nitems: [" + "x," * 50_001, 2, 0, "it has too many values"),
        (b"#" * ((4 << 20) + 1), 1, 1, "it is larger than 4 MB"),
    ],
    ids=lambda value: str(value)[:24],
)
def test_bad_yaml_is_reported_with_its_location(data, line, column, problem):
    ((code, found_line, found_column, message),) = list_diagnostics(data)
    assert code == "SM320"
    assert problem in message
    assert (found_line, found_column if column else 0) == (line, column)


@pytest.mark.parametrize(
    ("text", "findings"),
    [
        ("", [("SM321", 1, 1, "in the overlay at the top: lacks 'overlay'")]),
        ("x\n", [("SM321", 1, 1, "in the overlay at the top: 'x' is not of type 'object'")]),
        ("overlay: 2\n", [("SM321", 1, 10, "in the overlay at 'overlay': 1 was expected")]),
        (
            RIGHT.replace("physical", "digital"),
            [
                (
                    "SM321",
                    3,
                    24,
                    "in the overlay at 'items.MiniPallet.domain': unknown value 'digital'",
                )
            ],
        ),
        (
            RIGHT.replace("items", "itmes"),
            [("SM322", 2, 1, "in the overlay at the top: unknown key 'itmes'")],
        ),
        (
            RIGHT + "  MiniPallet: {}\n",
            [("SM323", 4, 3, "in the overlay at 'items': the key 'MiniPallet' occurs twice")],
        ),
        (
            "overlay: 1\nblocks:\n  A:\n    operations: {go: , go: }\n",
            [
                (
                    "SM323",
                    4,
                    24,
                    "in the overlay at 'blocks.A.operations': the key 'go' occurs twice",
                )
            ],
        ),
        (
            "overlay: 1\nconnectors: {l: {flows: [{item: X}]}}\n",
            [
                (
                    "SM321",
                    2,
                    26,
                    "in the overlay at 'connectors.l.flows[1]': a flow has a 'from', a 'to' or "
                    "both, or else only 'both-ways: true'",
                )
            ],
        ),
        (
            "overlay: 1\nconnectors: {l: {flows: [{item: X, to: a, both-ways: true}]}}\n",
            [
                (
                    "SM321",
                    2,
                    26,
                    "in the overlay at 'connectors.l.flows[1]': a flow has a 'from', a 'to' or "
                    "both, or else only 'both-ways: true'",
                )
            ],
        ),
        (
            "overlay: 1\nblocks: {A: }\nitems: [1]\n",
            [
                (
                    "SM321",
                    2,
                    12,
                    "in the overlay at 'blocks.A': it is empty, but should be of type object",
                ),
                ("SM321", 3, 8, "in the overlay at 'items': [1] is not of type 'object'"),
            ],
        ),
    ],
)
def test_each_violation_of_the_schema_is_reported_with_its_location(text, findings):
    assert list_diagnostics(text) == findings


def test_for_an_unknown_key_the_nearest_key_is_suggested():
    sink = Sink()
    read_overlay(Source("p.overlay.yaml", RIGHT.replace("domain", "domian").encode()), sink)
    assert [diagnostic.help for diagnostic in sink] == ["did you mean 'domain'?"]


def test_locations_have_columns_in_characters_and_offsets_in_bytes():
    top = parse_yaml('\ufeffoverlay: 1\n"é": {x: ü, y: 1}\n'.encode())
    inner = top.entries["é"].entries["y"]
    assert inner.spot == (2, 16, 3 + 11 + 5 + 1 + 1 + 10, 26)
    assert top.keys["é"][:2] == (2, 1)


def test_plain_words_and_quoted_digits_are_strings():
    top = parse_yaml(
        b"a: no\nb: 0x1F\nc: '12'\nd: 12\ne: 1.5\nf: true\ng: ~\nh: 2024-01-01\n1: x\n"
    )
    assert {key: value.scalar for key, value in top.entries.items()} == {
        "a": "no",
        "b": "0x1F",
        "c": "12",
        "d": 12,
        "e": 1.5,
        "f": True,
        "g": None,
        "h": "2024-01-01",
        "1": "x",
    }


def test_an_alias_repeats_the_content_of_its_anchor():
    text = RIGHT + "connectors:\n  a: &one\n    flows: [{item: MiniPallet, to: x}]\n  b: *one\n"
    refinement = read_overlay(Source("p.overlay.yaml", text.encode()), Sink())
    assert [connector.key.text for connector in refinement.connectors] == ["a", "b"]
    assert refinement.connectors[0].flows == refinement.connectors[1].flows


def test_entries_are_sorted_by_their_keys():
    rows = ["  B: {domain: physical}\n", "  A: {domain: information}\n"]
    refinements = [
        read_overlay(
            Source("p.overlay.yaml", ("overlay: 1\nitems:\n" + "".join(order)).encode()), Sink()
        )
        for order in (rows, rows[::-1])
    ]
    names = [
        [(item.key.text, item.domain) for item in refinement.items] for refinement in refinements
    ]
    assert names[0] == names[1] == [("A", "information"), ("B", "physical")]


def test_the_files_that_an_overlay_names_are_listed():
    text = (
        "overlay: 1\nblocks:\n  A:\n    behavior: 'models/gate.uml#Gate::Handle'\n"
        "    values: {v: {type: 'types.uml#T::V'}}\n"
        "    operations: {go: {method: 'models/gate.uml#Gate::Go'}}\n"
    )
    refinement = read_overlay(Source("p.overlay.yaml", text.encode()), Sink())
    assert list_files(refinement) == ["models/gate.uml", "types.uml"]


def test_the_schema_is_valid_and_describes_each_property():
    schema = json.loads(resources.read_text("metamodels", "sysmlc-overlay.schema.json"))
    Draft202012Validator.check_schema(schema)
    assert all(
        "description" in entry for entry in schema["properties"].values() if "$ref" not in entry
    )


@pytest.mark.parametrize(
    ("path", "names"),
    [
        ("Lib/Gate", ("Lib", "Gate")),
        ("[Lib]/[A/B]", ("Lib", "A/B")),
        ("Lib/[http://x/[1]]", ("Lib", "http://x/[1]")),
        ("a", ("a",)),
    ],
)
def test_paths_are_split_like_those_of_caex(path, names):
    assert split_path(path) == names
    assert split_path(join_path(names)) == names


def test_files_are_named_relative_to_the_overlay():
    assert name_in_unit("a/p.overlay.yaml", "../b/gate.uml") == "b/gate.uml"
    assert name_in_unit("p.overlay.yaml", "./gate.uml") == "gate.uml"
