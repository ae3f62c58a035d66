"""`python -m trundle` is the `trundle` command."""

from .cli import main

main()
