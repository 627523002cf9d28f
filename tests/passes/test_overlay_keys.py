"""The pass ``overlay``: elements that keys and names of an overlay refer to, and unknown names."""

import pytest
from overlay_samples import GATE, apply_overlays, find_element
from pass_runs import list_codes, list_diagnostics

PLANT_OF_AML = """\
Package h "Hall"
  Class own "Press / 1" role="block"
  Instance 9c1f3a52-5d8e-4a3b-9f00-2b7d9a3c1e11 "Press / 1" interface_ids=[["own.p", "REPEATED"]]
    -> instance-of own
  Class other "Feeder" role="block"
    Port own.p "p"
""".replace("REPEATED", "7b0c9d64-0000-4a3b-9f00-2b7d9a3c1e11")


@pytest.mark.parametrize(
    "key",
    [
        "own",
        "Hall/[Press / 1]",
        "'[Hall]/[Press / 1]'",
        "9c1f3a52-5d8e-4a3b-9f00-2b7d9a3c1e11",
        "'{9C1F3A52-5D8E-4A3B-9F00-2B7D9A3C1E11}'",
        "Hall::Press / 1",
    ],
)
def test_a_block_may_be_named_by_id_path_or_qualified_name_of_itself_or_its_instance(key):
    graph, sink = apply_overlays(
        f"overlay: 1\nblocks:\n  {key}: {{operations: {{stamp: }}}}\n", model=PLANT_OF_AML
    )
    assert list_codes(sink) == []
    assert graph.owner(find_element(graph, "stamp")) is graph["own"]


def test_the_id_of_an_interface_of_an_instance_names_the_port_of_the_class():
    key = "'{7B0C9D64-0000-4A3B-9F00-2B7D9A3C1E11}'"
    graph, sink = apply_overlays(
        f"overlay: 1\nports:\n  {key}: {{direction: in}}\n", model=PLANT_OF_AML
    )
    assert list_codes(sink) == []
    assert graph["own.p"].attrs["direction"] == "in"


def test_for_a_key_with_an_unknown_id_the_path_is_used_and_reported():
    text = "overlay: 1\nports:\n  old-id: {path: Plant/Switch/p_swIn, direction: in}\n"
    _, sink = apply_overlays(text)
    assert list_diagnostics(sink) == [
        "SM325 info: no element has the id 'old-id' any more; 'Plant/Switch/p_swIn' is used instead"
    ]
    assert next(iter(sink)).help == "if that is the intended element, write 'w-in' as the key"


def test_the_id_takes_precedence_over_a_path_that_names_another_element():
    text = "overlay: 1\nports:\n  s-in: {path: Plant/Stopper/p_sOut, direction: in}\n"
    graph, sink = apply_overlays(text)
    assert list_diagnostics(sink) == [
        "SM340 warning: the id 's-in' now belongs to 'Plant/Stopper/p_sIn', not to "
        "'Plant/Stopper/p_sOut'"
    ]
    assert "direction" not in graph["s-out"].attrs


@pytest.mark.parametrize("path", ["Plant/Stopper/p_sIn", "Plant/Stopper/gone"])
def test_a_path_beside_an_id_may_name_the_same_element_or_none(path):
    _, sink = apply_overlays(f"overlay: 1\nports:\n  s-in: {{path: {path}, direction: in}}\n")
    assert list_codes(sink) == []


def test_an_entry_for_an_unknown_name_is_reported_with_location_and_nearest_name():
    text = "overlay: 1\nports:\n  Plant/Switch/p_swln: {direction: in}\n"
    _, sink = apply_overlays(text)
    (diagnostic,) = sink
    assert diagnostic.message == "the model has no port 'Plant/Switch/p_swln'"
    assert diagnostic.help == "did you mean 'Plant/Switch/p_swIn'?"
    assert (diagnostic.subject.place.line, diagnostic.subject.place.column) == (3, 3)


def test_a_behaviour_in_a_file_outside_the_unit_is_reported_with_the_file():
    (diagnostic,) = apply_overlays(GATE + "    behavior: gone.uml#Gate::Handle\n")[1]
    assert diagnostic.rule.code == "SM324"
    assert diagnostic.help == "the file 'gone.uml' is not part of the compile unit"


def test_for_an_unknown_id_no_names_are_suggested():
    id = "1ac5c9b2-45f8-4a4c-8d6a-6d2f5f3b8a01"
    (diagnostic,) = apply_overlays(f"overlay: 1\nports:\n  {id}: {{direction: in}}\n")[1]
    assert diagnostic.rule.code == "SM324"
    assert diagnostic.help == "'sysmlc show MODEL' prints all ids"


def test_for_an_unknown_name_distant_names_are_not_listed():
    ports = "".join(f'    Port s{n} "p{n}"\n' for n in range(20))
    model = f'Package plant "Plant"\n  Class gate "Gate" role="block"\n{ports}'
    (diagnostic,) = apply_overlays("overlay: 1\nports:\n  Xyz: {direction: in}\n", model=model)[1]
    assert diagnostic.rule.code == "SM324"
    assert diagnostic.help == "'sysmlc show MODEL' prints all names"


def test_the_nearest_name_is_suggested_for_the_first_twenty_unknown_names():
    entries = "".join(f"  Plant/Switch/p_swl{n}: {{direction: in}}\n" for n in range(30))
    _, sink = apply_overlays("overlay: 1\nports:\n" + entries)
    assert list_codes(sink) == ["SM324"] * 30
    helps = [diagnostic.help for diagnostic in sink]
    assert helps.count("did you mean 'Plant/Switch/p_swIn'?") == 20
