"""The SMV file of a behaviour has the behaviour as a model and its requirements as LTLSPEC.

Where NuSMV or nuXmv is installed, it decides the requirements. Everywhere a reader of expressions
that was written for these tests, with the precedence of the manual of NuSMV (2.7, section 2.2),
compares the steps with the contract.
"""

import random
import re
import shutil
import subprocess

import pytest
from test_promela_models import CLAIMS, EXPECTED, PRESS

from contract_oracle import list_models, require
from sysmlc.backends.contract_formats import SMV, add_behaviour
from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model
from sysmlc.logic import formats
from sysmlc.logic.components.derivation import ComponentBehaviour
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.domains import values
from sysmlc.logic.evaluate import is_true
from sysmlc.support.output import Output

CHECKER = shutil.which("NuSMV") or shutil.which("nuXmv")

LEVELS = [["->"], ["<->"], ["|"], ["&"], ["=", "!=", "<", "<=", ">", ">="], ["+", "-"], ["*"]]
"""Operators from weak to strong; ! is stronger than all."""
MEANINGS = {
    "->": lambda a, b: not a or b,
    "<->": lambda a, b: a == b,
    "|": lambda a, b: a or b,
    "&": lambda a, b: a and b,
    "=": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
}


def evaluate(text, now, then):
    """Return the value of an SMV expression in a step and the next one."""
    tokens = re.findall(r"\w+|<->|->|!=|<=|>=|[-+*=<>!&|()]", text)
    value = read_level(tokens, 0, now, then)
    assert not tokens
    return value


def read_level(tokens, level, now, then):
    if level == len(LEVELS):
        return read_operand(tokens, now, then)
    value = read_level(tokens, level + 1, now, then)
    while tokens and tokens[0] in LEVELS[level]:
        operator = tokens.pop(0)
        # Implication is right-associative.
        right = read_level(tokens, level + (operator != "->"), now, then)
        value = MEANINGS[operator](value, right)
    return value


def read_operand(tokens, now, then):
    token = tokens.pop(0)
    if token == "!":
        return not read_operand(tokens, now, then)
    if token in ("next", "("):
        if token == "next":
            assert tokens.pop(0) == "("
        value = read_level(tokens, 0, then if token == "next" else now, then)
        assert tokens.pop(0) == ")"
        return value
    if token.isdigit():
        return int(token)
    return {"TRUE": True, "FALSE": False, **now}.get(token, token)


def write_press(tmp_path):
    """Return the graph of the press, and its SMV files by path."""
    return write_smv(PRESS, tmp_path)


def write_smv(text, tmp_path):
    """Return the graph of a model, and its SMV files by path."""
    path = tmp_path / "model.sysml"
    path.write_text(text, encoding="utf-8")
    graph, output = compile_model(Request((path,))).graph, Output()
    SMV.emit(graph, output, Sink(), None)
    return graph, {artefact.path: artefact.text for artefact in output.artefacts()}


def list_conditions(text, *sections):
    return re.findall(rf"^(?:{'|'.join(sections)}) (.*);$", text, re.MULTILINE)


def test_the_model_has_the_steps_of_the_contract(tmp_path):
    graph, files = write_press(tmp_path)
    text = files["contracts/Shop.Press.requirements.smv"]
    (behaviour,) = graph.derived(ComponentBehaviour)
    contract = behaviour.contract
    facts = {
        class_: [item.formula for item in contract.guarantees if item.class_ is class_]
        for class_ in (Class.INIT, Class.SAFETY)
    }
    conditions = {
        Class.INIT: list_conditions(text, "INIT"),
        Class.SAFETY: list_conditions(text, "TRANS", "INVAR"),
    }
    draw = random.Random(3)
    outcomes = set()
    for _ in range(300):
        now, then = (
            {v.name: draw.choice(values(v.domain)) for v in contract.variables} for _ in range(2)
        )
        for class_, formulas in facts.items():
            assert len(formulas) == len(conditions[class_])
            for formula, condition in zip(formulas, conditions[class_], strict=True):
                is_step = is_true(formula, now, then)
                assert evaluate(condition, now, then) == is_step, condition
                outcomes.add((condition, is_step))
    assert len(outcomes) > 1.5 * sum(map(len, facts.values()))  # most are true and false


def test_each_requirement_is_a_specification(tmp_path):
    _, files = write_press(tmp_path)
    text = files["contracts/Shop.Press.requirements.smv"]
    names = re.findall(r"^LTLSPEC NAME (\w+) := ", text, re.MULTILINE)
    assert names == ["Rules", *(f"Rules_{number}" for number in range(2, 7))]
    assert "LTLSPEC NAME Rules_3 := (G (closed -> F !closed));" in text
    assert "JUSTICE !work_run_press | work_done_press;" in text
    assert "TRANS" not in "".join(list_conditions(text, "LTLSPEC"))


def test_the_file_is_read_again(tmp_path):
    graph, files = write_press(tmp_path)
    requirements = next(
        contract for contract in graph.derived(Contract) if contract.component.endswith("ments")
    )
    whole = add_behaviour(requirements, *graph.derived(ComponentBehaviour))
    sink = Sink()
    path = "contracts/Shop.Press.requirements.smv"
    (again,) = formats.read(files[path], path, sink)
    assert list(sink) == []
    lowered = formats.lower(whole, "smv")
    assert [item.formula for item in again.assumptions] == [i.formula for i in lowered.assumptions]
    assert {item.formula for item in again.guarantees} == {i.formula for i in lowered.guarantees}


def test_specifications_with_different_assumptions_are_reported():
    sink = Sink()
    text = (
        "MODULE main\nVAR a : boolean; -- input\nLTLSPEC (G a) -> (G a);\nLTLSPEC (F a) -> (G a);"
    )
    assert formats.read(text, "x.smv", sink) == ()
    assert "it has other assumptions than the formula before" in next(iter(sink)).message


def verify(text, tmp_path):
    """Return for each LTLSPEC of a model whether it holds according to NuSMV."""
    path = tmp_path / "model.smv"
    path.write_text(text, encoding="utf-8")
    result = subprocess.run([CHECKER, path], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    assert "ERROR" not in result.stderr
    answers = re.findall(r"^-- specification .* is (true|false)$", result.stdout, re.MULTILINE)
    names = re.findall(r"^LTLSPEC NAME (\w+) :=", text, re.MULTILINE)
    return {name: answer == "true" for name, answer in zip(names, answers, strict=True)}


@pytest.mark.nusmv
def test_nusmv_decides_each_requirement(tmp_path):
    _, files = write_press(tmp_path)
    assert verify(files["contracts/Shop.Press.requirements.smv"], tmp_path) == EXPECTED


@pytest.mark.nusmv
def test_nusmv_finds_a_fault_in_the_model(tmp_path):
    """The faulty press opens while it closes."""
    _, files = write_press(tmp_path)
    model = files["contracts/Shop.Press.requirements.smv"]
    faulty = re.sub(r"next\(closed\)", "!next(closed)", model)
    answers = verify(faulty, tmp_path)
    assert not all(answers[name] for name in CLAIMS[:4])


def test_constants_are_written_as_nusmv_reads_them(tmp_path):
    """NuSMV takes ``false`` for the name of a variable."""
    text = PRESS.replace("G F state=Busy", "F G false")
    _, files = write_smv(text, tmp_path)
    model = files["contracts/Shop.Press.requirements.smv"]
    assert "LTLSPEC NAME Rules_6 := (F G FALSE);" in model
    assert re.findall(r"\b(?:true|false)\b", model) == []


@pytest.mark.nusmv
@pytest.mark.long
@pytest.mark.corpus
@pytest.mark.parametrize("model", list_models(), ids=lambda model: model.path.stem)
def test_nusmv_agrees_with_the_oracle(model, tmp_path):
    _, files = write_smv(require(model), tmp_path)
    component = model.component.replace("::", ".")
    paths = (f"contracts/{component}{end}.smv" for end in (".requirements", ""))
    answers = verify(next(files[path] for path in paths if path in files), tmp_path)
    expected = {f"R_{fact.name}": fact.holds for fact in model.properties}
    assert {name: answers[name] for name in expected} == expected


@pytest.mark.nusmv
@pytest.mark.long
@pytest.mark.corpus
@pytest.mark.parametrize("model", list_models(), ids=lambda model: model.path.stem)
def test_nusmv_proves_the_contract_of_each_behaviour(model, tmp_path):
    """Each behaviour ends, or repeats, as it guarantees; one model has a requirement it breaks."""
    _, files = write_smv(model.text, tmp_path)
    assert files
    broken = [path for path, text in files.items() if not all(verify(text, tmp_path).values())]
    is_author = model.path.stem == "chain_requirement"
    assert broken == ["contracts/ChainRequirement.Plant.smv"] * is_author
