"""Which back ends run when none is named."""

import tomllib
from pathlib import Path

from sysmlc.driver import list_backend_names, load_backends, registry, select_backends

_PROJECT = Path(__file__).parents[2] / "pyproject.toml"


def test_without_a_name_the_default_back_ends_run():
    every = load_backends(list_backend_names())
    assert select_backends([]) == [one for one in every if one.is_default]


def test_a_back_end_that_is_no_default_is_added_in_its_place():
    names = [one.name for one in select_backends(["+graph"])]
    assert names == sorted(["graph", *(one.name for one in select_backends([]))])


def test_the_project_file_names_the_back_ends_that_ship():
    project = tomllib.loads(_PROJECT.read_text(encoding="utf-8"))["project"]
    named = project["entry-points"][registry.BACKEND_GROUP]
    assert named == registry._BACKENDS
