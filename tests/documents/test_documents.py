"""One reader for overlays, scenarios, configurations and contracts: locations and advice."""

import pytest

from sysmlc.config import ConfigError, read_config
from sysmlc.diagnostics import Sink
from sysmlc.documents import DocumentError, find_in_string, parse_json, parse_toml, parse_yaml
from sysmlc.logic import formats
from sysmlc.overlay import read_overlay
from sysmlc.simulation.scenario import read_scenarios
from sysmlc.sources import Source


def list_faults(name, text, tmp_path):
    """Return ``line:column: message; advice`` of each fault of a document, by its name."""
    sink = Sink()
    if name == "sysmlc.toml":
        (tmp_path / name).write_text(text)
        with pytest.raises(ConfigError) as raised:
            read_config(tmp_path / name)
        return [str(raised.value).removeprefix(f"{tmp_path / name}:")]
    if name.endswith(".json"):
        assert formats.read(text, name, sink) == ()
    elif name == "p.overlay.yaml":
        assert read_overlay(Source(name, text.encode()), sink) is None
    else:
        assert read_scenarios(Source(name, text.encode()), sink) == []
    return [
        f"{diagnostic.subject.place.line}:{diagnostic.subject.place.column}: "
        f"{diagnostic.message}; {diagnostic.help}"
        for diagnostic in sink
    ]


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("sysmlc.toml", "strict = true\nemit = [\n", "3:1: Invalid value"),
        ("p.overlay.yaml", "overlay: 1\nitems: [\n", "3:1: the overlay cannot be read: "),
        ("s.yaml", "component: A\nsteps: [}\n", "2:9: the scenario is not YAML: "),
        (
            "c.gr1.json",
            '{"variables":\n {]}',
            "2:3: the JSON text is not understood: it is not JSON",
        ),
        ("c.chase.json", '{"inputs":\n {,}}', "2:3: the chase JSON text is not understood: it is "),
    ],
)
def test_a_fault_of_syntax_has_line_and_column(name, text, fault, tmp_path):
    (message,) = list_faults(name, text, tmp_path)
    assert message.startswith(fault)


@pytest.mark.parametrize(
    ("name", "text", "fault", "advice"),
    [
        (
            "sysmlc.toml",
            '[[model]]\nname = "a"\nfiles = ["a"]\n\n[[model]]\nname = "b"\nfile = ["b"]\n',
            "7:1: at 'model[2]': unknown key 'file'",
            "did you mean 'files'?",
        ),
        (
            "p.overlay.yaml",
            "overlay: 1\nports:\n  A/p: {direktion: in}\n",
            "3:9: in the overlay at 'ports.A/p': unknown key 'direktion'",
            "did you mean 'direction'?",
        ),
        (
            "s.yaml",
            "component: A\nsteps:\n- inputs: {}\n- expects: {}\n",
            "4:3: in the scenario at 'steps[2]': unknown key 'expects'",
            "did you mean 'expect'?",
        ),
        (
            "c.gr1.json",
            '{"variables": {},\n "guarantees": {"saftey": []}}',
            "2:17: at 'guarantees': unknown key 'saftey'",
            "did you mean 'safety'?",
        ),
        (
            # Other members are comments; this one would be lost.
            "c.gr1.json",
            '{"variables": {},\n "guarantee": {"safety": []}, "author": "me"}',
            "2:2: at the top: unknown key 'guarantee'",
            "did you mean 'guarantees'?",
        ),
        (
            "c.chase.json",
            '{"inputs": {},\n "output": {}}',
            "2:2: at the top: unknown key 'output'",
            "did you mean 'outputs'?",
        ),
    ],
)
def test_for_a_misspelt_key_the_nearest_key_is_suggested(name, text, fault, advice, tmp_path):
    (message,) = list_faults(name, text, tmp_path)
    assert message.startswith(fault)
    assert advice in message


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("sysmlc.toml", "strict = 1\n", "1:10: at 'strict': 1 is not of type 'boolean'"),
        (
            "sysmlc.toml",
            'diagrams = "drawn"\n',
            "1:12: at 'diagrams': unknown value 'drawn'; known: ",
        ),
        (
            "s.yaml",
            "component: A\nsteps: []\n",
            "2:8: in the scenario at 'steps': [] should be non-",
        ),
        ("s.yaml", "steps: [{}]\n", "1:1: in the scenario at the top: lacks 'component'"),
        (
            "s.yaml",
            "component: A\ncomponent: B\nsteps: [{}]\n",
            "2:1: in the scenario at the top: the ",
        ),
        (
            "s.yaml",
            "scenarios:\n- name: A\n  steps: [{}]\n",
            "2:3: in the scenario at 'scenarios[1]': ",
        ),
        (
            "c.gr1.json",
            '{"variables": {"go": {"owner": "me", "type": "bool"}}}',
            "1:32: at 'variables.go.owner': unknown value 'me'; known: env, sys",
        ),
        (
            "c.gr1.json",
            '{"variables": {"go": {"owner": "env", "type": "int"}}}',
            "1:47: at 'variables.go.type': 'int': a type is \"bool\", [least, greatest] or a list",
        ),
        (
            "c.gr1.json",
            '{"variables": {},\n "variables": {}}',
            "2:2: at the top: the key 'variables'",
        ),
    ],
)
def test_a_wrong_value_is_reported_at_its_place(name, text, fault, tmp_path):
    (message,) = list_faults(name, text, tmp_path)
    assert message.startswith(fault)


TOML = """\
output = "x" # ]
"a.b" . c = 1

[[model]]
name = "m"
files = [ # [
  "q",
]
[[model]]
name = \"\"\"
files = 1
\"\"\"
[model.sub]
z.w = {u = 1}
"""


@pytest.mark.parametrize(
    ("path", "key", "value"),
    [
        (["output"], (1, 1), (1, 10)),
        (["a.b", "c"], (2, 9), (2, 13)),
        (["model", 0, "files"], (6, 1), (6, 9)),
        (["model", 0, "files", 0], (6, 9), (6, 9)),
        (["model", 1], (9, 3), (9, 3)),
        (["model", 1, "name"], (10, 1), (10, 8)),
        (["model", 1, "sub", "z", "w"], (14, 3), (14, 7)),
        (["model", 1, "sub", "z", "w", "u"], (14, 7), (14, 7)),
        (["model", 1, "missing"], (9, 3), (9, 3)),
    ],
)
def test_keys_and_values_of_toml_have_positions(path, key, value):
    document = parse_toml(TOML)
    assert (document.find_key(path)[:2], document.find(path).spot[:2]) == (key, value)


def test_the_entries_of_an_anchor_can_be_merged_into_a_mapping():
    document = parse_yaml(b"a: &a {x: 1, y: 2}\nb: {<<: *a, y: 3}\n")
    assert document.as_json()["b"] == {"x": 1, "y": 3}


@pytest.mark.parametrize(
    ("merged", "entries"),
    [
        ("[*a, *b]", {"x": 1, "y": 2, "z": 5}),
        ("[*b, *a]", {"x": 1, "y": 4, "z": 5}),
        ("[{y: 6}, *a]", {"x": 1, "y": 6}),
        ("[]", {}),
        ("[*a, 7]", {"<<": [{"x": 1, "y": 2}, 7]}),
    ],
)
def test_of_several_merged_mappings_the_first_entry_of_a_key_counts(merged, entries):
    text = f"a: &a {{x: 1, y: 2}}\nb: &b {{y: 4, z: 5}}\nc: {{<<: {merged}, w: 0}}\n"
    assert parse_yaml(text.encode()).as_json()["c"] == {"w": 0, **entries}


def test_json_is_read_with_the_positions_of_keys_values_and_characters():
    document = parse_json('{"a": [1, -2.5e3,\n "x\\"\\u00e9z", null], "a": true}')
    assert document.as_json() == {"a": [1, -2500.0, 'x"éz', None]}
    assert document.repeated[0][1][:2] == (2, 23)
    text = document.list_items("a")[2]
    assert text.spot[:2] == (2, 2)
    assert [find_in_string(text, index) for index in range(4)] == [0, 1, 3, 9]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "Expecting value"),
        ("[1] 2", "Extra data"),
        ("1" * 5000, "Exceeds the limit"),
        ('["\\udc00"]', "only half of a character"),
        ("[" * 150 + "]" * 150, "nested too deeply"),
    ],
)
def test_hostile_json_is_refused(text, problem):
    with pytest.raises(DocumentError, match=problem):
        parse_json(text)
