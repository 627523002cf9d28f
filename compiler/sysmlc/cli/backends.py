"""``sysmlc backends``: list the back ends."""

import click


@click.command("backends", short_help="List the back ends.")
def command() -> None:
    """List the back ends, plug-ins included; * marks those that run by default."""
    from sysmlc.cli.session import fail
    from sysmlc.driver import BackendError, list_backend_names, load_backends

    try:
        backends = load_backends(list_backend_names())
    except BackendError as problem:
        fail(str(problem))
    width = max(len(backend.name) for backend in backends)
    for backend in backends:
        mark = "*" if backend.is_default else " "
        click.echo(f"{mark} {backend.name:<{width}}  {backend.summary}")
