"""``--emit sysml`` repeats inputs in SysML v2 and inserts only what passes add."""

import pytest

from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.ir.compare import compare

PLANT = """\
// What the author notes remains.
package Plant {
    private import ScalarValues::*;

    port def Track;
    item def Tray;   /* a keyword that the graph does not have */
    part def Stop { port outgoing : Track; }
    part def Belt { port incoming : Track; attribute speed default = 500 [SI::mm / SI::s]; }
    part def Line {
        part stop : Stop;
        part belt : Belt;
        interface link connect stop.outgoing to belt.incoming;
    }
    part def Empty;
}
"""
SERVICES = (
    "package Services { private import Plant::*; action def Move { in part line : Line; } }\n"
)
FLOW = """\
overlay: 1
package: Plant
items: {Pallet: {domain: physical, description: It moves.}}
connectors:
  Plant/Line/link:
    flows: [{item: Pallet, to: belt}]
blocks:
  Plant/Stop:
    values: {count: {type: Integer, default: 3}}
    operations: {raise: {parameters: [{name: force, type: Real}]}}
  Plant/Empty:
    values: {isFull: {type: Boolean}}
"""
UNCHANGED = frozenset((*PLANT.splitlines(), "", "        }"))
"""Lines of the text of the author, and lines that members end with."""
ADDED = """\
    part def Stop { port outgoing : Track;
        attribute count : ScalarValues::Integer default = 3;
        action raise {
            in attribute force : ScalarValues::Real;
        flow of Pallet from stop.outgoing to belt.incoming;
    part def Empty {
        attribute isFull : ScalarValues::Boolean;
    part def Pallet {
        @SysMLC::Kind { domain = "physical"; }
        doc /* It moves. */"""
GATE = """\
Package plant "Gates"
  Class gate "Gate" role="block"
    Property gate.x "x" role="value" aggregation="composite"
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / ".git").mkdir()
    return tmp_path


def write_file(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text.encode())
    return path


def compile_folder(folder, emit="sysml"):
    paths = [path for path in sorted(folder.iterdir()) if path.name != ".git"]
    return compile_model(Request(tuple(paths), backends=tuple(select_backends((emit,)))))


def write_outputs(compilation, folder):
    """Write the texts of a compilation to a folder, and return them by path."""
    texts = {
        artefact.path.removeprefix("sysml/"): artefact.text for artefact in compilation.artefacts
    }
    for path, text in texts.items():
        write_file(folder / "out", path, text)
    return texts


def list_errors(compilation):
    return [str(d.message) for d in compilation.diagnostics if d.is_error]


# -- files without additions -------------------------------------------------------------------


def test_files_are_repeated_byte_for_byte(folder):
    sources = {
        "plant.sysml": PLANT,
        "behaviour/services.sysml": SERVICES,
        "library/kernel.kerml": "package Kernel { classifier Thing; }\n",
        "windows.sysml": "\ufeffpackage Windows {\r\n\tpart def 'Prüfer';\r\n}",
        "empty.sysml": "",
    }
    for name, text in sources.items():
        write_file(folder, f"models/{name}", text)
    compilation = compile_folder(folder)
    assert write_outputs(compilation, folder) == sources
    again = compile_folder(folder / "out")
    assert list(compare(compilation.graph, again.graph)) == []


def test_a_file_with_errors_is_repeated_and_has_the_same_errors(folder):
    text = PLANT.replace("part stop : Stop;", "part stop : Stopp;\n        part part;")
    write_file(folder, "plant.sysml", text)
    compilation = compile_folder(folder)
    assert write_outputs(compilation, folder) == {"plant.sysml": text}
    assert list_errors(compile_folder(folder / "out")) == list_errors(compilation) != []


def test_no_loss_is_reported_about_a_text_that_is_repeated(folder):
    write_file(folder, "plant.sysml", "package P { part def Items { part Items; } part Items; }")
    compilation = compile_folder(folder)
    assert [d.rule.code for d in compilation.diagnostics if d.rule.code.startswith("SM73")] == []


# -- members that an overlay adds --------------------------------------------------------------


def test_members_of_an_overlay_are_inserted_at_the_end_of_their_owners(folder):
    write_file(folder, "plant.sysml", PLANT)
    write_file(folder, "plant.overlay.yaml", FLOW)
    compilation = compile_folder(folder)
    text = write_outputs(compilation, folder)["plant.sysml"]
    assert "\n".join(line for line in text.splitlines() if line not in UNCHANGED) == ADDED
    assert list_errors(compilation) == list_errors(compile_folder(folder / "out")) == []


def test_lines_that_an_overlay_does_not_concern_are_unchanged(folder):
    write_file(folder, "plant.sysml", PLANT)
    write_file(folder, "plant.overlay.yaml", FLOW)
    text = write_outputs(compile_folder(folder), folder)["plant.sysml"]
    removed = [line.strip() for line in PLANT.splitlines() if line not in text.splitlines()]
    assert removed == ["part def Stop { port outgoing : Track; }", "part def Empty;"]


def test_insertions_stand_before_the_result_of_a_constraint(folder):
    text = "package P {\n    constraint def Small {\n        in x; // mm\n        x < 3\n    }\n}\n"
    write_file(folder, "p.sysml", text)
    overlay = "overlay: 1\nblocks: {P/Small: {values: {y: {type: Boolean}}}}\n"
    write_file(folder, "p.overlay.yaml", overlay)
    assert write_outputs(compile_folder(folder), folder)["p.sysml"] == text.replace(
        "x < 3", "attribute y : ScalarValues::Boolean;\n        x < 3"
    )


def test_metadata_of_a_text_is_not_defined_again(folder):
    """The text has metadata without a definition; the printed text has nothing to do with it."""
    text = "package P { part def Gate { @Unknown { speed = 2; } } }"
    write_file(folder, "p.sysml", text)
    write_file(folder, "gate.ir", GATE)
    texts = write_outputs(compile_folder(folder), folder)
    assert texts["p.sysml"] == text
    assert "Unknown" not in texts["gate.sysml"]


def test_behaviour_that_an_overlay_moves_to_a_printed_block_is_printed_there(folder):
    text = "package P { action def Hold { @Unknown { speed = 2; } action wait; } }"
    write_file(folder, "p.sysml", text)
    write_file(folder, "gate.ir", GATE)
    overlay = 'overlay: 1\nblocks: {Gates/Gate: {behavior: "p.sysml#P::Hold"}}\n'
    write_file(folder, "gate.overlay.yaml", overlay)
    texts = write_outputs(compile_folder(folder), folder)
    assert texts["p.sysml"] == text
    assert "perform action Hold {" in texts["gate.sysml"]
    assert "@Stereotypes::Unknown" in texts["gate.sysml"]


def test_insertions_have_the_line_ends_of_the_file(folder):
    text = "package Plant {\r\n\t// Prüfer\r\n\tpart def Empty { }\r\n}\r\n"
    write_file(folder, "plant.sysml", text)
    write_file(
        folder,
        "plant.overlay.yaml",
        "overlay: 1\nblocks: {Plant/Empty: {values: {isFull: {type: Boolean}}}}\n",
    )
    assert write_outputs(compile_folder(folder), folder)["plant.sysml"] == (
        "package Plant {\r\n\t// Prüfer\r\n\tpart def Empty {\r\n"
        "\t    attribute isFull : ScalarValues::Boolean;\r\n\t}\r\n}\r\n"
    )


# -- units with several notations --------------------------------------------------------------


def test_elements_of_other_notations_are_printed_beside_the_texts(folder):
    write_file(folder, "plant.sysml", PLANT)
    write_file(folder, "gate.ir", GATE)
    texts = write_outputs(compile_folder(folder), folder)
    assert texts["plant.sysml"] == PLANT
    assert "part def Gate" in texts["gate.sysml"]
    assert "Belt" not in texts["gate.sysml"]


def test_a_printed_text_has_the_whole_name_of_its_input_if_the_short_one_is_taken(folder):
    write_file(folder, "plant.sysml", PLANT)
    write_file(folder, "Plant.ir", GATE)
    assert list(write_outputs(compile_folder(folder), folder)) == ["Plant.ir.sysml", "plant.sysml"]


def test_names_of_the_authors_are_not_changed_for_printed_elements(folder):
    """Both roots have the same name: the printed one gives way."""
    write_file(folder, "plant.sysml", "package Gates { part def Gate; }")
    write_file(folder, "gate.ir", GATE)
    texts = write_outputs(compile_folder(folder), folder)
    assert texts["plant.sysml"] == "package Gates { part def Gate; }"
    assert texts["gate.sysml"].startswith("package Gates_2 {")


def test_interchange_files_of_a_unit_with_several_notations(folder):
    write_file(folder, "plant.sysml", PLANT)
    write_file(folder, "kernel.kerml", "package Kernel { classifier Thing; }")
    write_file(folder, "gate.ir", GATE)
    compilation = compile_folder(folder, "sysmlx")
    assert list_errors(compilation) == []
    assert sorted(artefact.path for artefact in compilation.artefacts) == [
        "sysmlx/gate.sysmlx",
        "sysmlx/kernel.kermlx",
        "sysmlx/plant.sysmlx",
    ]


# -- facts of overlays about declarations of authors -------------------------------------------

REFINED = """\
overlay: 1
items: {Plant/Tray: {domain: physical, specializes: [Plant/Empty]}}
ports: {Plant/Belt/incoming: {direction: in, type: Plant/Track}}
blocks: {Plant/Stop: {specializes: [Plant/Empty]}}
"""


def test_facts_of_an_overlay_that_would_change_a_declaration_are_reported(folder):
    write_file(folder, "plant.sysml", PLANT)
    write_file(folder, "plant.overlay.yaml", REFINED)
    compilation = compile_folder(folder)
    assert write_outputs(compilation, folder) == {"plant.sysml": PLANT}
    reported = [d for d in compilation.diagnostics if d.rule.code == "SM738"]
    assert [str(d.message) for d in reported] == [
        f"the SysML v2 text of 'Plant::{name}' omits {fact}, which the overlay states"
        for name, fact in (
            ("Tray", "the domain 'physical'"),
            ("Tray", "the general 'Empty'"),
            ("Belt::incoming", "the direction 'in'"),
            ("Belt::incoming", "the type 'Track'"),
            ("Stop", "the general 'Empty'"),
        )
    ]
    assert {d.subject.place.file for d in reported} == {"plant.overlay.yaml"}


def test_facts_that_the_printed_text_states_are_not_reported(folder):
    write_file(folder, "gate.ir", GATE)
    write_file(
        folder,
        "gate.overlay.yaml",
        "overlay: 1\nitems: {Tool: null}\nblocks: {Gates/Gate: {specializes: [Items/Tool]}}\n",
    )
    compilation = compile_folder(folder)
    assert "part def Gate :> Items_2::Tool" in write_outputs(compilation, folder)["gate.sysml"]
    assert "SM738" not in [d.rule.code for d in compilation.diagnostics]
