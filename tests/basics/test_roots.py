"""References of a model that could lead to files."""

from sysmlc.sources.files import Roots


def test_a_path_too_long_for_any_file_leads_nowhere(tmp_path):
    roots = Roots((tmp_path,))
    assert roots.resolve(tmp_path / "model.uml", "(" * 400 + "#x") is None


def test_a_file_beside_the_model_is_found(tmp_path):
    (tmp_path / "other.uml").write_text("")
    roots = Roots((tmp_path,))
    assert roots.resolve(tmp_path / "model.uml", "other.uml#x") == tmp_path / "other.uml"
    assert roots.resolve(tmp_path / "model.uml", "../other.uml#x") is None
