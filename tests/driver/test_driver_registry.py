"""Which back ends run when none is named."""

from sysmlc.driver import backend_names, load_backends, select_backends


def test_without_a_name_the_default_back_ends_run():
    every = load_backends(backend_names())
    assert select_backends([]) == [one for one in every if one.is_default]


def test_a_back_end_that_is_no_default_is_added_in_its_place():
    names = [one.name for one in select_backends(["+graph"])]
    assert names == sorted(["graph", *(one.name for one in select_backends([]))])
