"""Where the package asks which concrete part it has, outside that part's home: `python -m tests.dispatch`."""
