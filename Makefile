# Needs Python 3.11 to 3.13, git and make. PYTHON=python3.12 chooses another interpreter.
PYTHON ?= python3
MODEL ?= examples/lego-recipe/lego-recipe.uml
# Without bytecode, every process that a test starts would compile the whole package again.
unexport PYTHONDONTWRITEBYTECODE
PIP = -m pip --disable-pip-version-check --quiet install

.PHONY: help demo test types quick-tests test-long mutants check format bench clean

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "make %-9s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

demo: .demo/.ready ## compile an example and show what came out (MODEL=... for another)
	@.demo/bin/sysmlc $(MODEL) -o .demo/out
	@echo
	@echo "$(MODEL) became, in .demo/out:"
	@cd .demo/out && for kind in contracts recipes diagrams; do \
	  [ -d $$kind ] || continue; \
	  echo "  $$kind/ $$(ls $$kind | wc -l)"; ls $$kind | head -n 4 | sed 's/^/    /'; \
	done; ls -d *.json | sed 's/^/  /'
	@echo
	@echo "Your own model:  .demo/bin/sysmlc model.uml -o out/    More: .demo/bin/sysmlc --help"

test: .venv/.ready ## style, types and all tests but the long ones
	@.ci/system-packages
	.venv/bin/ruff check
	.venv/bin/ruff format --check
	@$(MAKE) --no-print-directory --jobs 2 types quick-tests

types: .venv/.ready
	.venv/bin/mypy

quick-tests: .venv/.ready
	.venv/bin/pytest -n 2 -m "not long"

test-long: .venv/.ready ## the long tests: random models, crashes, whole corpus
	@.ci/system-packages
	SYSMLC_LONG=1 .venv/bin/pytest -n 2 -m "long or hypothesis"

mutants: .venv/.ready ## 40 random faults in the code (some 20 minutes); which of them do the tests notice?
	.venv/bin/python tests/mutants.py $(MUTANTS)

check: .venv/.ready ## the quick half of 'make test': style, types, tests that are not slow
	.venv/bin/ruff check
	.venv/bin/ruff format --check
	.venv/bin/mypy
	.venv/bin/pytest -n 2 -m "not slow and not long"

format: .venv/.ready ## put the code into its form
	.venv/bin/ruff check --fix
	.venv/bin/ruff format

bench: .venv/.ready ## the measurements of benchmarks/
	@failed=0; for name in startup xmi aml cache; do \
	  echo "== $$name"; .venv/bin/python benchmarks/$$name.py || failed=1; \
	done; exit $$failed

clean: ## remove the environments and what the tools keep
	rm -rf .venv .demo .mypy_cache .ruff_cache .pytest_cache .hypothesis

# The stamps are touched last: an interrupted installation starts again.
.venv/.ready: pyproject.toml
	@.ci/environment .venv "$(PYTHON)"
	@.venv/bin/python $(PIP) --editable '.[test]'
	@touch $@

.demo/.ready: pyproject.toml
	@.ci/environment .demo "$(PYTHON)"
	@.demo/bin/python $(PIP) --editable .
	@touch $@
