"""The files that a command with ``-o`` writes besides its report."""

from collections.abc import Iterable
from pathlib import Path


def write_files(files: Iterable[tuple[str, str]], folder: Path) -> None:
    """Write files, each a path in *folder* and a text. Exits with code 2 if one cannot be
    written.
    """
    from sysmlc.cli.session import fail
    from sysmlc.support.atomic_files import write_if_changed
    from sysmlc.support.output import OutputPathError, find_obstacle

    try:
        for path, text in files:
            obstacle = find_obstacle(folder, path)
            if obstacle is not None:
                fail(f"cannot write to '{folder}': '{obstacle}' is a link or in the way; remove it")
            write_if_changed(folder / path, text)
    except OutputPathError as problem:
        fail(str(problem))
    except OSError as problem:
        fail(f"cannot write to '{folder}': {problem.strerror or problem}")
