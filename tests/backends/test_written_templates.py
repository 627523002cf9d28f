"""Our templates are functions of Python: up to date, and with the same texts as jinja2 makes."""

import random
import subprocess
import sys
from pathlib import Path

import pytest

from dialects.random_models import random_model
from sysmlc import resources
from sysmlc.backends import templates, translate
from sysmlc.backends.contracts import BACKEND as CONTRACTS
from sysmlc.backends.plantuml import BACKEND as PLANTUML
from sysmlc.driver import Request, compile_model

MODELS = sorted(Path(__file__).parent.glob("plantuml/models/*.ir"))
EXAMPLES = Path(__file__).parents[2] / "examples"


def outputs(path, folder):
    made = compile_model(Request((path,), backends=(PLANTUML, CONTRACTS), templates=folder))
    return {one.path: one.text for one in made.written()}


@pytest.mark.parametrize("folder", translate.FOLDERS)
def test_the_functions_are_those_of_the_templates(folder):
    assert translate.target(folder).read_text(encoding="utf-8") == translate.module_of(folder)


@pytest.mark.parametrize("path", [*MODELS, EXAMPLES / "lego-recipe"], ids=lambda one: one.stem)
def test_functions_and_templates_give_the_same_texts(path):
    ours = outputs(path, None)
    assert ours
    assert ours == outputs(path, resources.path("templates"))


def test_functions_and_templates_give_the_same_texts_of_random_models(tmp_path):
    for seed in range(3):
        path = tmp_path / f"m{seed}.uml"
        path.write_bytes(random_model(random.Random(seed)))
        assert outputs(path, None) == outputs(path, resources.path("templates"))


def test_every_template_has_a_function():
    for folder in translate.FOLDERS:
        found = {one.name for one in resources.path("templates", folder).glob("[!_]*.j2")}
        assert found == templates._functions(folder).keys()


def test_a_compilation_with_our_templates_does_not_import_jinja2():
    path = EXAMPLES / "lego-recipe"
    code = (
        "import sys; from pathlib import Path; from sysmlc.driver import Request, compile_model; "
        "from sysmlc.driver.registry import select_backends; "
        "found = tuple(select_backends([])); "
        f"made = compile_model(Request((Path({str(path)!r}),), backends=found)); "
        "assert made.written(); print('jinja2' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


SYNTAX = """\
{% for one in items %}
- {{ one.name }}{% if one.a or not one.b %} "{" {{ one.name }}\\n{% endif %}

{% else %}
nothing
{% endfor %}
"""


def test_a_template_that_cannot_be_translated_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(translate, "path", lambda *_: tmp_path)
    monkeypatch.setitem(translate.FOLDERS, "x", ("items",))
    (tmp_path / "a.j2").write_text(SYNTAX)
    known = {}
    exec(translate.module_of("x"), known)
    made = known["TEXTS"]["a.j2"](())
    assert made == "nothing\n"
    one = type("One", (), {"name": "n", "a": 0, "b": 0})
    assert known["TEXTS"]["a.j2"]([one]) == '- n "{" n\\n\n'
    (tmp_path / "a.j2").write_text("{{ items | upper }}")
    with pytest.raises(NotImplementedError, match="Filter in line 1"):
        translate.module_of("x")
