"""The written files do not depend on the order of hashes, which differs between processes."""

import os
import subprocess
import sys

import pytest

from examples.compiling import EXAMPLES


@pytest.mark.parametrize("backend", ["aml", "uml"])
def test_a_file_is_the_same_for_every_hash_seed(backend, tmp_path):
    command = [sys.executable, "-m", "sysmlc", "build", str(EXAMPLES[0]), "--emit", backend]
    for seed in ("0", "7"):
        environment = os.environ | {"PYTHONHASHSEED": seed}
        arguments = [*command, "--no-cache", "-o", str(tmp_path / seed)]
        subprocess.run(arguments, env=environment, capture_output=True, check=False)
    contents = [next((tmp_path / seed).rglob(f"*.{backend}")).read_bytes() for seed in ("0", "7")]
    assert contents[0] == contents[1]
