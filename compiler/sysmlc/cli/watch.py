"""``sysmlc watch``: compile models after each save."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from sysmlc.cli import options
from sysmlc.cli.limits import LIMITS

_POLL_MILLISECONDS = 1000
"""Milliseconds after which files are checked even if the system has reported no change."""
_QUIET_MILLISECONDS = 20
"""Milliseconds without a further change after which changes are reported."""


@click.command(
    "watch",
    short_help="Compile again after every save.",
    epilog="""\b
Examples:
  sysmlc watch plant.uml -o out/           # ends with Ctrl-C
  sysmlc watch plant.uml --format json     # a line of JSON for each unit of a build""",
)
@options.models()
@options.output_folder
@click.option(
    "--settle",
    type=click.IntRange(0, 60_000),
    default=50,
    show_default=True,
    metavar="MS",
    help="Time without a change before files are compiled; new findings wait 1.5 s, or five "
    "times as long.",
)
@click.option(
    "--keep-going",
    is_flag=True,
    help="While the model has errors, write the outputs that the errors do not concern.",
)
@options.emitting
@options.templates
@options.reporting
@options.reading
def command(
    models: tuple[Path, ...],
    output: Path | None,
    settle: int,
    keep_going: bool,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Compile MODEL... now and after every save.

    The command waits until files are saved completely. While the model has errors, the output
    folder does not change, except with --keep-going. The limits of time and memory apply to each
    compilation; after a limit the command waits for the next save.
    """
    from sysmlc.cli import session
    from sysmlc.cli.watching import Watch

    watched = Watch(models, output, session.Settings(**setting_values), settle / 1000, keep_going)
    saves = _iter_saves(watched.list_folders())
    # The limits hold for each build, not for the time between saves (decision 41).
    LIMITS.stop_timer()
    watched.start()
    for saved in saves:
        watched.build_if_changed(saved)


def _iter_saves(folders: Sequence[Path]) -> Iterator[list[Path]]:
    """Yield the files of each group of changes.

    The list is empty after a time without changes, because some file systems report none.
    """
    from watchfiles import watch

    from sysmlc.driver.inputs import list_suffixes
    from sysmlc.driver.registry import load_foreign_frontends

    # A build reports the plug-ins that are ignored.
    suffixes = list_suffixes(load_foreign_frontends(note=lambda _: None))
    changes = watch(
        *folders,
        watch_filter=lambda _, path: _is_input(Path(path), suffixes),
        raise_interrupt=False,
        step=_QUIET_MILLISECONDS,
        rust_timeout=_POLL_MILLISECONDS,
        yield_on_timeout=True,
    )
    return (sorted(Path(path).absolute() for _, path in change) for change in changes)


def _is_input(file: Path, suffixes: frozenset[str]) -> bool:
    """Whether a saved file may be an input; written outputs must not start another build."""
    from sysmlc.config import FILE_NAME
    from sysmlc.overlay import SUFFIX

    is_model = file.suffix.lower() in suffixes or file.name.endswith(SUFFIX)
    return is_model or file.name in (FILE_NAME, "pyproject.toml")
