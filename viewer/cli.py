"""The command line. Its commands and their JSON are a contract; each is a file of the folder `commands`."""

from __future__ import annotations

import os

import click

from reperform.viewer.command_folder import CommandFolder

# Items run side by side; a BLAS that splits one product over all cores as well would only get in their way.
# Nothing that links a BLAS is imported above.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")


@click.group(
    cls=CommandFolder,
    package="reperform.viewer.commands",
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.option("--traceback", is_flag=True, help="Show where errors come from.")
@click.version_option(package_name="reperform")
def main(traceback: bool) -> None:
    """From multi-camera footage of an actor to a character that can be directed."""
    if traceback:
        os.environ["REPERFORM_TRACEBACK"] = "1"


if __name__ == "__main__":
    main()
