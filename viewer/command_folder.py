"""A folder of command files as a group of commands: what is asked for is imported, the rest only for its help."""

from __future__ import annotations

import os
from importlib import import_module
from pkgutil import iter_modules
from typing import Any

import click


class CommandFolder(click.Group):
    """The commands of a package: the file `NAME.py` holds one as `command`, a folder `NAME` is a group of its own.

    Turns errors meant for users into messages: status 1 where a step failed, 2 where the definition or the call
    is wrong.
    """

    def __init__(self, *arguments: Any, package: str, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._package = package

    def list_commands(self, context: click.Context) -> list[str]:
        """The names of all commands."""
        return sorted(found.name for found in iter_modules(import_module(self._package).__path__))

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """The command of a name, if there is one."""
        if name not in self.list_commands(context):
            return None
        module = import_module(f"{self._package}.{name}")
        if hasattr(module, "__path__"):
            return CommandFolder(name, package=module.__name__, help=module.__doc__)
        command: click.Command = module.command
        command.name = name
        return command

    def invoke(self, context: click.Context) -> Any:
        """Run the command that was called."""
        try:
            return super().invoke(context)
        except (click.exceptions.Exit, click.Abort, click.ClickException, BrokenPipeError):
            raise
        except Exception as error:  # the last place that can turn an error into a message
            if context.params.get("traceback") or os.environ.get("REPERFORM_TRACEBACK"):
                raise
            click.echo(f"error: {_told(error)}", err=True)
            context.exit(_status(error))


def _told(error: Exception) -> str:
    from reperform.graphs.errors import DefinitionError, RunError
    from reperform.storage.errors import DamagedResult, StoreError

    if isinstance(error, StoreError):
        return str(error.strerror or error)
    if isinstance(error, DefinitionError | RunError | DamagedResult | ValueError | OSError | ImportError):
        return str(error)
    return f"{type(error).__name__}: {error} (--traceback shows where)"


def _status(error: Exception) -> int:
    from reperform.graphs.errors import DefinitionError

    return 2 if isinstance(error, DefinitionError) else 1
