# From a checkout to a lab report:
#
#   make report                   the demo, recorded by the simulated laboratory
#   make report CAMPAIGN=<name>   the campaign in data/raw/<name>/
#   make crate                    a campaign with all that made it as one file, a Workflow Run RO-Crate,
#                                 reports/<campaign>.crate.zip; also with CAMPAIGN=<name>
#   make check                    faults of the recording in a minute or two, before the set-up is
#                                 dismantled; also with CAMPAIGN=<name>
#   make draft LOG="<logs>"       a first campaign file from the logs alone, data/raw/<name>/; also with
#                                 NAME=<name>, and RATE=<Hz> where no log has a clock whose unit is sure
#   make new PLAN=<plan> NAME=<name>   a plan to record by: six-position, turn-stop, rate-table,
#                                 by-hand
#   make design INSTRUMENT=<instrument> TABLE=<table>   the best plan from nothing; also with MINUTES=<of
#                                 table time>, 30, CRITERION=A, D or worst, NAME=<name>
#   make design CAMPAIGN=<name> TABLE=<table>   what to record next, so that a class is split; with
#                                 WANT=gyroscope/scale=5e-6, so that wanted sigmas are reached
#   make trace ID=<number>        from a number of the report, as diagnosis/gyroscope/bias_x, back to
#                                 the lines of the logs; also with CAMPAIGN=<name>
#   make index                    reports/index.html: all campaigns that have a result, to filter and
#                                 sort; and reports/history/<serial>.html: each IMU over its calibrations
#   make compare A=<name> B=<name>   two campaigns beside each other: parameters, effects, conditions,
#                                 settings, with the references that they share; and as a page
#   make fleet SELECT="table=<name>"   several campaigns together: by serial=, instrument= or table=, or
#                                 their names: effects too small for one, what belongs to sensor, table
#                                 or type, the population of each type; reports/fleet-<name>.html
#   make test                     the tests; the same as CI with `make style`
#   make test-slow                those that draw many campaigns, repeat others with other numbers, or run
#                                 a whole campaign each; an hour and a half on two cores
#   make bench                    errors, time and memory compared with other programs, in one run, in
#                                 docs/benchmarks.md; also with ONLY="cost noise"
#   make style                    linters, types, and which package may import which
#   make challenge                hides effects in many campaigns and reports what is detected, in
#                                 docs/challenge.md; four hours on two cores, can be resumed; with
#                                 DRAWS=100 a twelfth of them; with ONLY=diagnosis only the 688 of
#                                 the diagnosis, in docs/diagnosis.md, an hour of one core; with
#                                 ONLY="diagnosis fault spikes" those that have these words; this
#                                 and what follows with CORES=1 in one process
#   make temperature              records campaigns in a simulated temperature chamber and compares
#                                 parameters as curves of the temperature with their bound, in
#                                 docs/temperature.md; an hour of one core, can be resumed; with
#                                 DRAWS=100 a twelfth of them
#   make silence                  records 2000 clean campaigns and counts what is named in them, in
#                                 docs/silence.md; three hours on two cores, can be resumed; with
#                                 DRAWS=100 so many of them
#   make injections               puts effects and faults into the bytes of the real recordings, which are not
#                                 part of the project, and reports what is detected, in docs/injections.md; an
#                                 hour of one core, can be resumed; with DRAWS=40 so many of them
#   make laws                     hides laws of no effect of the catalogue in 240 campaigns, in docs/laws.md;
#                                 an hour on two cores, can be resumed; with DRAWS=60 so many of them
#   make walks                    random walks of gyro biases against ramps, jumps and warm-ups, in
#                                 docs/walks.md; five hours on two cores, can be resumed; with DRAWS=10 so
#                                 many of each kind
#   make noise                    estimates the noise of 3000 simulated recordings, in docs/noise.md; 15
#                                 minutes on two cores, can be resumed; with DRAWS=100 of each part
#   make histories                predicts the next calibration and seeks jumps in 3500 simulated histories, in
#                                 docs/repeatability.md; two minutes, can be resumed
#   make fleets                   simulated fleets: power, what an effect belongs to, false findings, cover
#                                 of populations, in docs/fleet.md; 15 minutes on two cores, can be
#                                 resumed; with DRAWS=100 of each part
#   make designs                  designs recorded by the simulated laboratory, in docs/design.md: sigmas
#                                 foreseen and realised, classes split; 45 minutes on two cores, can be
#                                 resumed; with DRAWS=4 so many of each part
#   make screenshots              a campaign's report as a person sees it, wide and narrow, light, dark and
#                                 printed, into reports/screenshots/; also with CAMPAIGN=<name>
#   make mutants                  puts faults into the physics, one at a time, and reports which of them the
#                                 tests detect, in docs/mutants.md; four or five a minute on two cores, after a
#                                 quarter of an hour; can be resumed; with DRAWS=100 so many of them
#   make cluster-test             campaigns through a Slurm of two nodes on this machine, one of which dies;
#                                 some minutes; it needs root, and Debian's slurm-wlm and munge; with
#                                 DRAWS=40 so many campaigns (docs/cluster.md)
#   make scale                    what campaigns cost, many and long ones, in docs/scale.md; an hour
#                                 on two cores, can be resumed; with DRAWS=5 so many small campaigns
#   make docs                     docs/tables.md, docs/theory.md and the messages to translate, from the code
#   make recordings               docs/recordings.md: the real recordings, which are not part of the
#                                 project, drafted and compared with what is known of them; 15 minutes
#   make clean                    deletes what can be computed again from the raw logs; reports stay
#   make setup                    only the environment, .venv, which every target above needs

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.ONESHELL:
.SILENT:
.PHONY: report crate check draft new design trace index compare fleet fleets test test-slow style bench challenge silence laws walks injections noise histories temperature designs mutants docs recordings screenshots cluster-test scale clean setup pango

# Taken literally and passed to the shell through the environment, so that neither make nor the
# shell executes their content.
CAMPAIGN ?= demo
ID ?=
ONLY ?=
DRAWS ?= 1200
LOG ?=
NAME ?=
RATE ?=
PLAN ?=
INSTRUMENT ?=
TABLE ?=
MINUTES ?= 30
CRITERION ?= A
WANT ?=
A ?=
B ?=
SELECT ?=
override CAMPAIGN := $(value CAMPAIGN)
override ID := $(value ID)
override ONLY := $(value ONLY)
override DRAWS := $(value DRAWS)
override LOG := $(value LOG)
override NAME := $(value NAME)
override RATE := $(value RATE)
override PLAN := $(value PLAN)
override INSTRUMENT := $(value INSTRUMENT)
override TABLE := $(value TABLE)
override MINUTES := $(value MINUTES)
override CRITERION := $(value CRITERION)
override WANT := $(value WANT)
override A := $(value A)
override B := $(value B)
override SELECT := $(value SELECT)
export CAMPAIGN ID ONLY DRAWS LOG NAME RATE PLAN INSTRUMENT TABLE MINUTES CRITERION WANT A B SELECT

PYTHON ?= python3
BIN := .venv/bin
PANGO := libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0
COMMAND := $(BIN)/python -m turntable_calibration

# What a person calls is the command turntable-calibration. Behind a recipe that fails GNU make says
# "Error 1": so it is done by try-…, whose failure is ignored, in silence, and remembered by $(try);
# $(ended) then stops make with status 2 and one line, the place of the full log where there is one.
CALLED := report crate check draft new design trace index compare fleet
ENDED := $(shell mktemp --dry-run --suffix=.make)
$(CALLED:%=try-%): export ENDED := $(ENDED)
try = -trap '(( $$? == 0 )) || [[ -s $$ENDED ]] || echo "see the message above" > $$ENDED' EXIT
ended = $(if $(file < $(ENDED)),$(error $(shell cat $(ENDED); rm $(ENDED))))

.PHONY: $(CALLED:%=try-%)
$(CALLED): %: try-%
	$(ended)

try-report: setup
	$(try)
	$(COMMAND) report -- "$$CAMPAIGN"

try-crate: setup
	$(try)
	$(COMMAND) crate -- "$$CAMPAIGN"

try-check: .venv/complete
	$(try)
	$(COMMAND) check -- "$$CAMPAIGN"

# A name with a blank is quoted: LOG="'my log.csv' other.csv"; a pattern is expanded: LOG="june/*.csv".
try-draft: .venv/complete
	$(try)
	mapfile -t words < <(xargs --no-run-if-empty printf '%s\n' <<< "$$LOG")
	logs=()
	for word in "$${words[@]}"; do
		mapfile -t found < <(compgen -G "$$word" | sort || true)
		if [[ -e $$word || $${#found[@]} == 0 ]]; then found=("$$word"); fi
		logs+=("$${found[@]}")
	done
	options=()
	if [[ $$RATE ]]; then options+=("--rate=$$RATE"); fi
	$(COMMAND) draft "$${options[@]}" "--name=$$NAME" -- "$${logs[@]}"

try-new: .venv/complete
	$(try)
	$(COMMAND) new -- "$$PLAN" "$$NAME"

try-design: .venv/complete
	$(try)
	if [[ $$INSTRUMENT ]]; then
		of=("--instrument=$$INSTRUMENT" "--minutes=$$MINUTES" "--criterion=$$CRITERION")
	else
		of=("--campaign=$$CAMPAIGN" "--want=$$WANT")
	fi
	$(COMMAND) design "$${of[@]}" "--table=$$TABLE" "--name=$$NAME"

try-trace: .venv/complete
	$(try)
	$(COMMAND) trace -- "$$CAMPAIGN" "$$ID"

try-index: .venv/complete
	$(try)
	$(COMMAND) index

try-compare: .venv/complete
	$(try)
	$(COMMAND) compare -- "$$A" "$$B"

try-fleet: .venv/complete
	$(try)
	$(COMMAND) fleet "--name=$$NAME" -- "$$SELECT"

test: setup
	$(BIN)/python -m pytest

test-slow: setup
	$(BIN)/python -m pytest -m slow

style: setup
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy stages inertial commands overviews laboratory turntable_calibration
	MYPYPATH=tests:tests/bounds:tests/hidden:tests/temperature $(BIN)/mypy benchmarks/*.py benchmarks/own/*.py
	$(BIN)/snakefmt --check -l 100 Snakefile
	$(BIN)/lint-imports
	# Each rule runs in the environment of requirements.lock, so none names one of its own.
	lint=$$($(BIN)/snakemake --lint 2>&1 | grep -A3 "^    \*" | grep -v "conda environment" || true)
	if grep "^    \*" <<< "$$lint"; then echo "$$lint"; exit 1; fi

bench: .venv/complete benchmarks/.venv/complete
	read -ra parts <<< "$$ONLY"
	PYTHONPATH=tests:tests/bounds:tests/hidden:tests/temperature OPENBLAS_NUM_THREADS=1 \
		$(BIN)/python -m benchmarks "$${parts[@]}"

challenge: .venv/complete
	export OPENBLAS_NUM_THREADS=1
	read -ra words <<< "$$ONLY"
	if [[ $${words:-} != diagnosis ]]; then
		PYTHONPATH=tests $(BIN)/python -m hidden "$$DRAWS" data/derived/challenge
	fi
	PYTHONPATH=tests:tests/hidden:tests/diagnosis $(BIN)/python -m diagnosis \
		data/derived/challenge "$${words[@]:1}"

temperature: .venv/complete
	PYTHONPATH=tests:tests/hidden:tests/diagnosis:tests/bounds:tests/temperature OPENBLAS_NUM_THREADS=1 \
		$(BIN)/python -m temperature "$$((DRAWS / 5))" data/derived/temperature

silence: .venv/complete
	PYTHONPATH=tests:tests/hidden OPENBLAS_NUM_THREADS=1 $(BIN)/python -m silence $(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS",2000) data/derived/silence

injections: .venv/complete
	PYTHONPATH=tests:tests/hidden OPENBLAS_NUM_THREADS=1 $(BIN)/python -m injections $(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS",400) data/derived/injections

laws: .venv/complete
	PYTHONPATH=tests:tests/hidden:tests/laws OPENBLAS_NUM_THREADS=1 $(BIN)/python -m laws $(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS",240) data/derived/laws

walks: .venv/complete
	PYTHONPATH=tests:tests/hidden:tests/walks OPENBLAS_NUM_THREADS=1 $(BIN)/python -m walks $(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS",200) data/derived/walks

noise: .venv/complete
	PYTHONPATH=tests OPENBLAS_NUM_THREADS=1 $(BIN)/python -m noise data/derived/noise $(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS")

histories: .venv/complete
	PYTHONPATH=tests OPENBLAS_NUM_THREADS=1 $(BIN)/python -m histories data/derived/histories $(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS")

fleets: .venv/complete
	PYTHONPATH=tests:tests/hidden OPENBLAS_NUM_THREADS=1 $(BIN)/python -m fleet data/derived/fleets $(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS")

designs: .venv/complete
	PYTHONPATH=tests:tests/hidden:tests/bounds OPENBLAS_NUM_THREADS=1 $(BIN)/python -m design data/derived/design $(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS")

scale: .venv/complete
	PYTHONPATH=tests CORES=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m scale data/derived/scale $(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS")

mutants: .venv/complete
	PYTHONPATH=tests:tests/mutants OPENBLAS_NUM_THREADS=1 $(BIN)/python -m mutants "$$DRAWS" data/derived/mutants

# Files generated from the code; tests fail where they are not current.
docs: .venv/complete
	$(BIN)/python -m commands.tables
	$(BIN)/python -m commands.theory
	messages=$$(mktemp --suffix=.pot)
	trap 'rm "$$messages"' EXIT
	$(BIN)/pybabel -q extract --keywords _ --keywords plural:1,2 --keywords counted:2 --no-wrap --omit-header \
		--sort-by-file --no-location --output "$$messages" inertial stages commands overviews
	for language in zh; do # what is new there has an empty translation
		$(BIN)/pybabel -q update --no-fuzzy-matching --ignore-obsolete --no-wrap --ignore-pot-creation-date \
			--input-file "$$messages" --locale $$language --output-file inertial/text/$$language.po
	done

# Slurm and munge are Debian's, installed where that is permitted.
cluster-test: .venv/complete
	if ! PATH=$$PATH:/usr/sbin command -v slurmctld munged > /dev/null; then
		if [[ $$(id -u) == 0 ]]; then may=(env); else may=(sudo -n); fi
		"$${may[@]}" DEBIAN_FRONTEND=noninteractive apt-get -qq install --no-install-recommends \
			slurm-wlm munge > /dev/null || true
	fi
	CLUSTER_CAMPAIGNS=$(if $(filter DRAWS=%,$(MAKEOVERRIDES)),"$$DRAWS",2) $(BIN)/python -m pytest --numprocesses=0 -m slow tests/cluster

recordings: .venv/complete
	PYTHONPATH=tests OPENBLAS_NUM_THREADS=1 $(BIN)/python -m recordings

screenshots: report
	$(BIN)/python -m commands.screenshots "--campaign=$$CAMPAIGN"

clean:
	rm -rf data/derived .snakemake

setup: .venv/complete pango

# Written last, so that an incomplete environment is created again.
.venv/complete: requirements.lock
	if ! $(PYTHON) -c "import sys; sys.exit(sys.version_info < (3, 11))"; then
		echo "make: $(PYTHON) must be Python 3.11 or newer; name another: make setup PYTHON=python3.12"
		exit 2
	fi >&2
	if ! $(PYTHON) -c "import ensurepip, venv" 2> /dev/null; then
		echo "make: $(PYTHON) lacks venv; on Debian: apt-get install python3-venv"
		exit 2
	fi >&2
	if [[ -L .venv ]]; then # what it points to may serve another checkout
		echo "make: .venv is a link to an environment that is older than requirements.lock; remove the link"
		exit 2
	fi >&2
	echo "Making .venv from requirements.lock, once; it takes a minute or two."
	$(PYTHON) -m venv --clear .venv
	$(BIN)/python -m pip install --quiet --require-hashes -r requirements.lock
	# The readers of logs are compiled now, so that the first log need not wait for it.
	$(BIN)/python -c "import numpy; from inertial.formats.novatel.imu_messages import find_items; find_items(numpy.zeros(0, numpy.uint8), 0, last=True)"
	touch $@

# The programs compared with have requirements of their own, hence an environment of their own.
benchmarks/.venv/complete: benchmarks/requirements.lock .venv/complete
	echo "Making benchmarks/.venv from benchmarks/requirements.lock, once."
	$(PYTHON) -m venv --clear benchmarks/.venv
	benchmarks/.venv/bin/python -m pip install --quiet --require-hashes -r benchmarks/requirements.lock
	touch $@

# WeasyPrint needs Pango for the PDF, which pip cannot install. Where this target may not either, only
# the PDF is missing; without HarfBuzz's subsets it is made, but slower. The result is remembered in
# .venv/pango, because the test takes a second.
pango: .venv/complete
	if [[ -e .venv/pango ]]; then exit; fi
	if $(BIN)/python -c "from weasyprint.text import ffi; exit(ffi.harfbuzz_subset is None)" 2> /dev/null
	then touch .venv/pango; exit; fi
	if [[ $$(id -u) == 0 ]]; then may=(env); else may=(sudo -n); fi
	apt=("$${may[@]}" DEBIAN_FRONTEND=noninteractive apt-get -qq)
	{ "$${apt[@]}" update && "$${apt[@]}" install --no-install-recommends $(PANGO); } &> /dev/null || true
	if $(BIN)/python -c "import weasyprint" 2> /dev/null; then touch .venv/pango; else
		echo "Pango is missing, so reports are made as HTML and not as PDF. On Debian:"
		echo "    sudo apt-get install $(PANGO)"
	fi
