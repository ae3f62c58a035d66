"""The first step of the `trundle` command: it hears Ctrl-C while Python still imports the package."""

import os


def main() -> None:
    """Import the command and run it; leave with 130 if Ctrl-C comes before it listens by itself, or after."""
    try:
        from trundle.cli import main as command

        command()
    except KeyboardInterrupt:
        os.write(2, b"trundle: interrupted\n")
        os._exit(130)
