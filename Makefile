# molviz: one line of help per target; `make` alone shows them.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
MOLVIZ := $(BIN)/molviz
SAMPLES := $(wildcard samples/*.pdb samples/*.pdb.gz samples/*.cif samples/*.cif.gz samples/*.xyz samples/*.extxyz samples/*.xyzr)
STEMS := $(basename $(notdir $(SAMPLES:.gz=)))
PICTURES := $(foreach stem,$(STEMS),pictures/$(stem).svg pictures/$(stem).ps)
DRAW_OPTIONS ?=
FUZZ ?=
SOAK ?=
PATCHES ?=
BENCH_FILES ?=
# for black lines and text, which a dark page would swallow
PAPER := --background white

.DEFAULT_GOAL := help
.PHONY: help demo test check page pictures gallery bench tables figures fuzz soak patches numpies clean

help: ## show this help
	@sed -n 's/^\([a-z]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 12

$(VENV)/installed: pyproject.toml ## (environment with molviz installed)
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --editable .
	$(BIN)/python -m compileall -q molviz
	touch $@

$(VENV)/developed: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --editable '.[dev]'
	touch $@

$(VENV)/benched: $(VENV)/developed
	$(BIN)/python -m pip install --quiet --editable '.[bench]'
	touch $@

demo: $(VENV)/installed ## make the environment, install, draw the samples into out/
	$(MOLVIZ) draw $(SAMPLES) -o out/ --to svg
	$(MOLVIZ) draw $(SAMPLES) -o out/ --to ps
	@echo "Pictures are in out/; open out/caffeine.svg."

test: $(VENV)/developed ## run all tests
	$(BIN)/python -m pytest -n auto

check: $(VENV)/developed ## linter and type checker
	$(BIN)/ruff check .
	$(BIN)/mypy

page: node_modules/.package-lock.json ## types and rules of the browser page's modules (needs npm)
	npm run --silent check

node_modules/.package-lock.json: package.json
	npm install --silent --no-audit --no-fund --no-package-lock

pictures: $(PICTURES) ## draw every sample to SVG and PS, only what changed (make -j2 pictures)

define picture_rules
pictures/$(basename $(notdir $(1:.gz=))).svg pictures/$(basename $(notdir $(1:.gz=))).ps: $(1) $(VENV)/installed
	$(MOLVIZ) draw $(1) -o $$@ $(DRAW_OPTIONS)
endef
$(foreach sample,$(SAMPLES),$(eval $(call picture_rules,$(sample))))

gallery: $(VENV)/developed ## redraw the README's pictures into docs/
	$(MOLVIZ) draw samples/1tii.pdb.gz --rotate y,-60 --width 14cm -o docs/goodsell.svg
	$(MOLVIZ) draw samples/caffeine.xyz --width 8cm -o docs/cel.svg
	$(MOLVIZ) draw samples/nacl.extxyz --style shaded --perspective 40 --rotate y,30 --rotate x,20 --width 8cm \
		-o docs/shaded.svg
	$(MOLVIZ) draw samples/1lcd.cif.gz --palette clay --width 8cm -o docs/clay.svg
	$(MOLVIZ) draw samples/1hpv.pdb.gz --label 'resn 478=amprenavir' --title 'HIV-1 protease' --scale-bar --legend \
		--width 10cm $(PAPER) -o docs/labels.svg
	$(MOLVIZ) draw samples/caffeine.xyz --rep ball-and-stick --width 8cm -o docs/bonds.svg
	$(MOLVIZ) draw samples/caffeine.xyz --rep sticks --style shaded --width 8cm -o docs/sticks.svg
	$(MOLVIZ) draw samples/1hpv.pdb.gz --select 'byres (within 4 of ligand)' --rep sticks --rep ligand=ball-and-stick \
		--style cel --color-by element --color 'ligand and elem C=orange' --width 10cm $(PAPER) -o docs/pocket.svg
	$(MOLVIZ) draw samples/1a8o.pdb --style flat --color-by exposure --legend --width 10cm $(PAPER) -o docs/flat.svg
	$(MOLVIZ) draw samples/1a8o.pdb --style print --width 8cm $(PAPER) -o docs/print.svg
	$(MOLVIZ) draw samples/c60.xyz --style hatch --perspective 15 --width 8cm $(PAPER) -o docs/hatch.svg
	$(MOLVIZ) draw samples/1a1f.pdb --style line --width 8cm $(PAPER) -o docs/line.svg
	$(MOLVIZ) hidden-lines --random 1000 --shrink --radius 0.135 $(PAPER) -o docs/gas.svg
	$(BIN)/python benchmarks/view_screenshot.py samples/1tii.pdb.gz -o docs/view.png

bench: $(VENV)/benched ## measure run times, sizes and peers in one table, benchmarks/RESULTS.md (nothing is asserted)
	mkdir -p out
	$(BIN)/python benchmarks/bench.py $(BENCH_FILES) > out/RESULTS.md && mv out/RESULTS.md benchmarks/RESULTS.md
	$(BIN)/python benchmarks/franklin_bench.py peers statistics
	$(BIN)/python benchmarks/measure_bench.py
	$(BIN)/python benchmarks/surface_bench.py
	$(BIN)/python benchmarks/query_bench.py
	$(BIN)/python benchmarks/view_bench.py

tables: $(VENV)/installed ## Franklin's Tables 1 to 3 beside ours
	$(BIN)/python benchmarks/franklin_tables.py

figures: $(VENV)/installed ## Franklin's Figs 1 to 5, before and after hidden line removal, into out/figures
	$(BIN)/python benchmarks/franklin_figures.py

fuzz: $(VENV)/developed ## inputs that nobody would write (FUZZ="--seed 1 --count 2000000"); the seed is printed
	$(BIN)/python -m tests.fuzz $(FUZZ)

soak: $(VENV)/developed ## scenes against a z-buffer, closed forms and all invariants (SOAK="--seed 1 --count 5000")
	$(BIN)/python -m tests.soak $(SOAK)
	$(BIN)/python -m tests.stick_soak

patches: $(VENV)/developed ## 100,000 points of every kind of patch of smooth surfaces (PATCHES="--seed 1")
	$(BIN)/python -m tests.patches $(PATCHES)

numpies: $(VENV)/developed ## compare the bytes that two versions of numpy give
	@for version in 1.26.4 2.0.2; do \
		test -d $(VENV)-$$version || { $(PYTHON) -m venv $(VENV)-$$version && \
			$(VENV)-$$version/bin/python -m pip install --quiet "numpy==$$version" --editable .; }; \
		$(VENV)-$$version/bin/python -m tests.same_bytes > $(VENV)-$$version/digests || exit 1; \
	done
	$(BIN)/python -m tests.same_bytes | diff - $(VENV)-1.26.4/digests
	diff $(VENV)-1.26.4/digests $(VENV)-2.0.2/digests && echo "The same bytes."

clean: ## remove pictures and caches
	rm -rf out pictures .pytest_cache .mypy_cache .ruff_cache .hypothesis
