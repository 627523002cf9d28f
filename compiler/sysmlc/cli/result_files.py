"""Files that a command writes to the folder that ``-o`` names, besides its report."""

from collections.abc import Iterable
from pathlib import Path


def write_files(files: Iterable[tuple[str, str]], folder: Path) -> None:
    """Write files, each a path in *folder* and a text. Ends with exit code 2 when one fails.

    A symbolic link in *folder* is never followed: whoever made it could choose what is replaced.
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
