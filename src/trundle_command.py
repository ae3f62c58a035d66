"""The first and the last step of `trundle`: it hears Ctrl-C while Python imports the package, and none after."""

import os


def main() -> None:
    """Import the command and run it; leave with 130 where Ctrl-C comes before it listens by itself, or just after."""
    try:
        from trundle.cli import main as command
        from trundle.cli.signals import deaf

        try:
            command()
        finally:
            deaf()  # while threads are waited for, and Python takes itself apart
    except KeyboardInterrupt:
        os.write(2, b"trundle: interrupted\n")
        os._exit(130)
