"""Files and roots: what is opened, what a reference may reach."""

import zipfile

import pytest

from sysmlc.sources import Fault, Limits, Roots, SourceError, load


def test_a_plain_file_is_one_source(tmp_path):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<a/>")
    (source,) = load(path, "models/plant.uml")
    assert (source.name, source.data) == ("models/plant.uml", b"<a/>")


def test_an_archive_is_recognised_by_its_content(tmp_path):
    path = tmp_path / "plant.uml"
    with zipfile.ZipFile(path, "w") as opened:
        opened.writestr("com.nomagic.magicdraw.uml_model.model", "<a/>")
        opened.writestr("BINARY-1", "drawing")
    (source,) = load(path, "plant.uml")
    assert source.name == "plant.uml!com.nomagic.magicdraw.uml_model.model"


def test_an_archive_without_a_model_is_an_error(tmp_path):
    path = tmp_path / "plant.mdzip"
    with zipfile.ZipFile(path, "w") as opened:
        opened.writestr("readme", "nothing")
    with pytest.raises(SourceError, match="holds no model"):
        load(path, "plant.mdzip")


def test_a_missing_file_and_a_too_large_file_are_not_the_models_fault(tmp_path):
    with pytest.raises(SourceError) as missing:
        load(tmp_path / "no.uml", "no.uml")
    assert (missing.value.fault, missing.value.exit_code) == (Fault.MISSING, 2)
    (tmp_path / "big.uml").write_bytes(b"x" * 11)
    with pytest.raises(SourceError) as large:
        load(tmp_path / "big.uml", "big.uml", limits=Limits(file_size=10))
    assert (large.value.fault, large.value.exit_code) == (Fault.LIMIT, 2)


def test_references_stay_inside_the_roots(tmp_path):
    inside = tmp_path / "unit"
    (inside / "sub").mkdir(parents=True)
    for path in (inside / "a b.uml", inside / "sub" / "c.uml", tmp_path / "secret.uml"):
        path.write_text("<a/>")
    (inside / "link.uml").symlink_to(tmp_path / "secret.uml")
    roots = Roots((inside,))
    base = inside / "sub" / "c.uml"
    assert roots.resolve(base, "../a%20b.uml#id") == inside / "a b.uml"
    assert roots.resolve(base, "../../secret.uml") is None
    assert roots.resolve(base, "../link.uml") is None
    assert roots.resolve(base, str(tmp_path / "secret.uml")) is None
    assert roots.resolve(base, "http://localhost/a.uml") is None
    assert roots.resolve(base, "file:///etc/passwd") is None
    assert roots.resolve(base, "#local") is None
