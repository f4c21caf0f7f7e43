"""Commands are found by their files, and errors meant for users become messages with their status."""

import click
import pytest
from click.testing import CliRunner

from reperform.graphs.errors import DefinitionError
from reperform.viewer.cli import main


def _walk(group, path=()):
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None and command.name == name
        yield (*path, name), command
        if isinstance(command, click.Group):
            yield from _walk(command, (*path, name))


def test_every_file_is_a_command_with_help():
    found = {" ".join(path): command for path, command in _walk(main)}
    assert {"run", "plan", "why", "show", "view", "export", "nodes", "schema", "store gc"} <= set(found)
    for path, command in found.items():
        assert command.help, f"{path} says nothing of itself"
        answer = CliRunner().invoke(main, [*path.split(), "--help"])
        assert answer.exit_code == 0 and f"Usage: main {path}" in answer.output


def test_a_word_that_is_no_command_is_refused():
    answer = CliRunner().invoke(main, ["walk"])
    assert answer.exit_code == 2 and "No such command 'walk'" in answer.output


@pytest.mark.parametrize(("error", "status"), [(DefinitionError("no step"), 2), (ValueError("no step"), 1)])
def test_errors_become_messages(monkeypatch, error, status):
    def fails(*_):
        raise error

    monkeypatch.delenv("REPERFORM_TRACEBACK", raising=False)
    monkeypatch.setattr("reperform.nodes.catalogue.read_catalogue", fails)
    answer = CliRunner().invoke(main, ["schema"])
    assert answer.exit_code == status
    assert answer.output == "error: no step\n"


def test_a_traceback_is_shown_on_request(monkeypatch):
    monkeypatch.setenv("REPERFORM_TRACEBACK", "1")
    monkeypatch.setattr("reperform.nodes.catalogue.read_catalogue", lambda: 1 / 0)
    assert isinstance(CliRunner().invoke(main, ["schema"]).exception, ZeroDivisionError)
