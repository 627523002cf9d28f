"""``sysmlc backends``: list the back ends."""

import click


@click.command("backends", short_help="List the back ends.")
def command() -> None:
    """List the back ends, plug-ins included; * marks those that run by default."""
    from sysmlc.driver import load_all_backends

    backends = load_all_backends()
    width = max(len(backend.name) for backend in backends)
    for backend in backends:
        mark = "*" if backend.is_default else " "
        click.echo(f"{mark} {backend.name:<{width}}  {backend.summary}")
