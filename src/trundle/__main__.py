"""`python -m trundle` is the `trundle` command."""

from trundle_command import main

main()
