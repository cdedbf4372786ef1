# Everything a person runs here; `make help` lists it. Needs Python >= 3.11 and GNU make, nothing else.

PYTHON ?= python3
PYTEST_FLAGS ?= -n 2
ROSBOT_FLAGS ?=

VENV := .venv
BIN := $(VENV)/bin
LOCKED := $(VENV)/locked
READY := $(VENV)/ready

.DEFAULT_GOAL := help
.PHONY: help setup rosbot test lint bench bench-planning docs golden cov lock clean

help: ## show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-14s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: $(READY) ## install the locked dependencies and gpsynth into .venv (once)

rosbot: $(READY) ## the main job: synthesize a law for the ROSbot and plan with it, into runs/rosbot (ROSBOT_FLAGS=--short)
	$(BIN)/python -m applications.rosbot demo --out runs/rosbot $(ROSBOT_FLAGS)

test: $(READY) ## all tests on two processes (PYTEST_FLAGS='-m "not slow"' for the quick ones)
	$(BIN)/python -m pytest $(PYTEST_FLAGS)

lint: $(READY) ## ruff, mypy and the import contracts
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo

bench: $(READY) ## times, each beside a reference measured in the same run
	$(BIN)/python -m tests.bench

bench-planning: $(READY) ## plans beside those of other planners, one core (pip install -e .[peers] brings them)
	$(BIN)/python -m tests.bench.plan_peers

docs: $(READY) ## the documentation, into docs/_build/html
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs docs/_build/html

golden: $(READY) ## write the golden files and the generated pages anew
	$(BIN)/python -m tests.golden.renew
	$(BIN)/python -m docs.generate

cov: $(READY) ## line and branch coverage, kernels as plain Python
	NUMBA_DISABLE_JIT=1 $(BIN)/python -m pytest -m "not slow" --cov --cov-report=term-missing $(PYTEST_FLAGS)

lock: ## resolve requirements.lock anew (needs uv)
	uv pip compile pyproject.toml --extra dev --quiet --upgrade --output-file requirements.lock \
		--universal --python-version 3.11 --fork-strategy fewest --generate-hashes \
		--no-annotate --no-emit-index-url --no-emit-find-links --custom-compile-command "make lock"

clean: ## remove .venv, runs and everything else that is made here
	rm -rf $(VENV) runs dist build docs/_build .coverage .mypy_cache .pytest_cache .ruff_cache \
		.import_linter_cache .hypothesis .benchmarks
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(LOCKED): requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
		|| { echo "gpsynth needs Python 3.11 or newer, '$(PYTHON)' is not: run make PYTHON=/path/to/python3.11" >&2; exit 1; }
	@echo "installing the locked dependencies into $(VENV)"
	@$(PYTHON) -m venv --clear $(VENV)
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --no-deps --require-hashes -r requirements.lock
	@touch $@

$(READY): $(LOCKED) pyproject.toml
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $@
