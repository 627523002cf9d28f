"""The configuration is read from the project root, never from a folder above it."""

import pytest

from sysmlc import config
from sysmlc.config import ConfigError, find_config_file, find_project_root


@pytest.fixture
def models(tmp_path):
    """A folder two levels below *tmp_path*, with a model."""
    folder = tmp_path / "project" / "models"
    folder.mkdir(parents=True)
    (folder / "plant.ir").write_text('Package pkg "Plant"\n')
    return folder


def test_without_marker_the_folder_of_the_model_is_the_root(models):
    assert find_project_root(models / "plant.ir") == models
    assert find_project_root(models) == models


def test_configuration_and_repository_mark_the_root(models):
    project = models.parent
    (project / ".git").write_text("gitdir: elsewhere\n")  # like in a worktree
    assert find_project_root(models / "plant.ir") == project
    (models / "sysmlc.toml").touch()
    assert find_project_root(models / "plant.ir") == models


def test_configuration_above_the_root_is_ignored(models):
    project = models.parent
    (project.parent / "sysmlc.toml").write_text('output = "elsewhere"\n')
    (project.parent / "pyproject.toml").write_text('[tool.sysmlc]\noutput = "elsewhere"\n')
    (project / ".git").mkdir()
    assert find_config_file(models / "plant.ir") is None
    (project / "pyproject.toml").write_text('[tool.sysmlc]\noutput = "gen"\n')
    assert find_config_file(models / "plant.ir") == project / "pyproject.toml"


def test_without_marker_no_parent_is_searched(models, monkeypatch):
    (models.parent / "pyproject.toml").write_text('[tool.sysmlc]\noutput = "elsewhere"\n')
    monkeypatch.chdir(models.parent)
    assert find_config_file(models / "plant.ir") is None


@pytest.mark.parametrize("name", ["sysmlc.toml", "pyproject.toml"])
def test_a_configuration_that_is_a_link_out_of_the_root_is_refused(models, name):
    (models.parent / "secret.toml").write_text("token = 1\n")
    (models / name).symlink_to("../secret.toml")
    with pytest.raises(ConfigError, match=r"is a link that leads out of the project root"):
        find_config_file(models)


def test_a_configuration_that_is_a_link_inside_the_root_is_read(models):
    (models / "ci.toml").write_text('output = "gen"\n')
    (models / "sysmlc.toml").symlink_to("ci.toml")
    assert config.read_config(find_config_file(models)).output == "gen"
