"""A configuration that was right is not checked again; one that is wrong is, every time."""

import pytest

from sysmlc import cache, config


@pytest.fixture
def checked(monkeypatch, tmp_path):
    """The texts of configurations that were held against the schema."""
    monkeypatch.setenv(cache.VARIABLE, str(tmp_path / "cache"))
    texts, real = [], config._validate

    def validate(file, text, *others):
        texts.append(text)
        real(file, text, *others)

    monkeypatch.setattr(config, "_validate", validate)
    return texts


def test_what_was_right_is_not_checked_again(checked, tmp_path):
    file = tmp_path / "sysmlc.toml"
    file.write_text('output = "made"\n')
    assert [config.load(file).output for _ in range(2)] == ["made", "made"]
    file.write_text('output = "other"\n')
    assert config.load(file).output == "other"
    assert checked == ['output = "made"\n', 'output = "other"\n']


def test_what_was_right_is_not_parsed_again(checked, tmp_path, monkeypatch):
    file = tmp_path / "sysmlc.toml"
    file.write_text("[passes.contracts]\nrange = [0, 3]\nshare = 0.5\n")
    first = config.load(file)
    monkeypatch.setattr(config, "_parsed", None)
    assert config.load(file) == first


def test_what_no_json_says_is_parsed_every_time(checked, tmp_path):
    file = tmp_path / "sysmlc.toml"
    file.write_text("[passes.plugin]\nsince = 2024-05-01\n")
    assert config.load(file) == config.load(file)
    assert len(checked) == 2


def test_what_is_wrong_is_told_every_time(checked, tmp_path):
    file = tmp_path / "sysmlc.toml"
    file.write_text("outputs = 'x'\n")
    for _ in range(2):
        with pytest.raises(config.ConfigError, match="unknown key 'outputs'"):
            config.load(file)
    assert len(checked) == 2


def test_a_table_of_a_project_file_is_not_that_of_a_file_of_its_own(checked, tmp_path):
    for name in ("sysmlc.toml", "pyproject.toml"):
        (tmp_path / name).write_text("[tool.sysmlc]\n")
    assert config.load(tmp_path / "pyproject.toml").output == "out"
    with pytest.raises(config.ConfigError, match="unknown key 'tool'"):
        config.load(tmp_path / "sysmlc.toml")
