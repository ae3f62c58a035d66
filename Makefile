# Everything from a bare machine: Python 3.11 or newer and make are all it needs.
.POSIX:
.DELETE_ON_ERROR:
.PHONY: help demo test check fuzz mutation dispatch tables bench check-web lint lint-python format clean always

# make PYTHON=/some/python3.12 demo  chooses the interpreter; otherwise the first of these that is new enough.
PYTHON =
PYTHONS = $(PYTHON) python3 python3.13 python3.12 python3.11 python3.14 python

BIN = .venv/bin
# What is compiled once is kept for the many processes that the tests start, whatever your shell says of bytecode.
PLAIN = PYTHONDONTWRITEBYTECODE= NO_COLOR=1 PY_COLORS=0 MPLBACKEND=Agg
# The build environment is pinned too: older pips read the first name for it, newer ones the second.
PINNED = PIP_CONSTRAINT=constraints.txt PIP_BUILD_CONSTRAINT=constraints.txt PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INPUT=1
# Two workers; `loadscope` keeps the blocks of one document on one worker, in their order.
PYTEST = $(PLAIN) $(BIN)/python -m pytest -n 2 --dist loadscope --color=no

help:
	@echo 'make demo    install into .venv (from PyPI and the npm registry), then run the shipped tilted turntable into demo/'
	@echo 'make test    install into .venv, then run every check: tests, documents, lint, types, layers, the web part'
	@echo 'make check   lint, types, and the tests nearest to what changed since the last commit: a minute; SINCE=main'
	@echo 'make fuzz    run 60 random scenarios of each class, and say which end badly: seven minutes; COUNT=2000 for more'
	@echo 'make mutation  plant faults in the package and print which figure of the card tells'
	@echo 'make dispatch  count where the package asks which concrete surface, shape, body, motion, load or form it has'
	@echo 'make tables  write the tables of parts in docs/ anew, from what the parts say of themselves'
	@echo 'make bench   install the peers too, then print the ratios of one benchmark run'
	@echo 'make lint    only ruff, mypy, the order of the layers, and types and lint of the web part'
	@echo 'make format  let ruff and biome write their format into the sources'
	@echo 'make clean   remove .venv, demo/ and every cache'

demo: .venv/installed
	$(PLAIN) $(BIN)/trundle run tilted-turntable -o demo
	@echo
	@echo 'The command is $(BIN)/trundle; after ". $(BIN)/activate" it is trundle. For instance:'
	@echo '  $(BIN)/trundle list                 the scenarios that ship with trundle'
	@echo '  $(BIN)/trundle lab                  spin the table yourself, in a browser'

# The web part first: it fetches what the browser tests put into a page to judge it. Lint and types are judged beside it.
test: .venv/installed-test
	@for program in chromium ffmpeg; do if [ -f .ci/$$program ]; then sh .ci/$$program; fi; done
	@$(MAKE) --no-print-directory -j 2 lint-python check-web
	$(PYTEST)

# What to run while working. SINCE is the commit that the files are compared with.
SINCE = HEAD
check: lint-python
	$(PLAIN) $(BIN)/python -m tests.nearest --since $(SINCE)

# Scenarios that nobody thought of; those that end badly are left in fuzz/, with the table. SEED is the first of the seeds.
COUNT = 60
SEED = 0
fuzz: .venv/installed-test
	$(PLAIN) $(BIN)/python -m tests.fuzz --count $(COUNT) --seed $(SEED) --folder fuzz

check-web: .venv/installed-test
	$(PLAIN) $(BIN)/python web/build.py test
	$(PLAIN) $(BIN)/python web/build.py lint

lint: lint-python
	$(PLAIN) $(BIN)/python web/build.py lint

lint-python: .venv/installed-test
	$(PLAIN) $(BIN)/ruff check .
	$(PLAIN) $(BIN)/ruff format --check .
	$(PLAIN) $(BIN)/mypy --no-color-output
	$(PLAIN) $(BIN)/lint-imports --no-logo --no-cache

format: .venv/installed-test
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .
	$(BIN)/python web/build.py format

mutation: .venv/installed-test
	$(PLAIN) $(BIN)/python -m tests.mutation

# --each prints every one of the places, too.
dispatch: .venv/installed-test
	$(PLAIN) $(BIN)/python -m tests.dispatch

# From what the parts say of themselves; a test says when they are not as the parts are.
tables: .venv/installed-test
	$(PLAIN) $(BIN)/python -m tests.documents.tables

bench: .venv/installed-bench
	$(PLAIN) $(BIN)/python benchmarks/run.py

# The stamps: an installation is repeated only when what it installs has changed.
.venv/installed: pyproject.toml constraints.txt hatch_build.py .venv/web
	@$(PREPARE)
	@$(INSTALL) -e '.[lab]'
	@$(COMPILE)
	@$(STAMP) $@

.venv/installed-test: pyproject.toml constraints.txt hatch_build.py .venv/web
	@$(PREPARE)
	@$(INSTALL) -e '.[test]'
	@$(COMPILE)
	@$(STAMP) .venv/installed $@

.venv/installed-bench: pyproject.toml constraints.txt hatch_build.py .venv/web
	@$(PREPARE)
	@$(INSTALL) -e '.[test,bench]'
	@$(COMPILE)
	@$(STAMP) .venv/installed .venv/installed-test $@

STAMP = if [ ! -f .venv/web ]; then touch .venv/web; fi; touch

# Newer than an installation as soon as anything that the viewer and the lab page are built from is newer, or they are gone.
.venv/web: always
	@if [ ! -f $@ ] || [ ! -f src/trundle/views/viewer/static/built-from ] || [ -n "$$(find $(WEB) -newer $@ -print)" ]; then \
	  mkdir -p .venv && touch $@; \
	fi
always:
WEB = web/src web/lab.html web/package.json web/package-lock.json web/.npmrc web/tsconfig.json web/vite.config.ts web/build.py

INSTALL = echo 'Installing trundle and its pinned dependencies into .venv (a minute or two the first time).' && \
	echo 'They come from PyPI and, for the page of the lab, from the npm registry ...' && \
	$(PIP) --no-compile

PIP = $(PINNED) $(BIN)/python -m pip install --quiet --progress-bar off -c constraints.txt

# Compiled here and not by pip, which uses one processor and compiles others' tests too. Some of what others bring is meant
# for another Python. Without all this, where Python may not write beside the sources, each start would compile.
COMPILE = \
	$(BIN)/python -m compileall -qq -j 0 -x '[/]tests?[/]' .venv/lib || true; \
	$(BIN)/python -m compileall -q src

# Keep a .venv that works; otherwise make one with the first Python that is new enough. The pip that comes with it may
# take twice as long to read the constraints as the one that they name.
PREPARE = \
	if $(BIN)/python -m pip --version >/dev/null 2>&1; then exit 0; fi; \
	found=; \
	for name in $(PYTHONS); do \
	  if "$$name" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; then found=$$name; break; fi; \
	done; \
	if [ -z "$$found" ]; then \
	  echo 'trundle needs Python 3.11 or newer, and none of these is one: $(PYTHONS).' >&2; \
	  echo 'Install Python 3.11 or newer, or name yours: make PYTHON=/path/to/python3.12 demo' >&2; \
	  exit 1; \
	fi; \
	echo "Creating .venv with $$("$$found" --version)"; \
	rm -rf .venv; \
	if ! "$$found" -m venv .venv; then \
	  rm -rf .venv; \
	  echo "$$found could not create a virtual environment: install its venv module (Debian and Ubuntu: python3-venv)." >&2; \
	  exit 1; \
	fi; \
	$(PIP) pip

clean:
	rm -rf .venv demo fuzz out dist build web/node_modules src/trundle/views/viewer/static
	rm -rf .pytest_cache .hypothesis .mypy_cache .ruff_cache .import_linter_cache .benchmarks
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
