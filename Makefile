# The front door: `make` installs what is missing, configures and builds; `make help` lists the rest.
# The work itself is done by CMake, CTest and the scripts of tools/.
#
# Variables: BUILD (build folder), JOBS (parallel jobs), BUILD_TYPE (of a new build folder),
# DEMO (where `make demo` writes), PACKAGES=no (install nothing), SOLVER=no (without the
# Navier-Stokes solver and deal.II, 1.7 GB), CMAKE_FLAGS (more -D...).

BUILD ?= build
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
BUILD_TYPE ?= Release
DEMO ?= manoscope-demo
PACKAGES ?= yes
SOLVER ?= yes
PRACTICE ?= ../shared/data/practice
# Of `make side-walls`.
EXPERIMENT ?= $(PRACTICE)/S1
CMAKE_FLAGS ?=
# Of `make fuzz` and `make fuzz-coverage`.
FUZZ_FILES ?= 100000
SECONDS_PER_READER ?= 30
# Of `make coverage` and `make goals`: their table, walls of each of six samples, experiments with
# each wall.
COVERAGE ?= $(BUILD)/coverage.csv
WALLS ?= 14
SEEDS ?= 5
# Of `make verdicts`: the same, of five samples.
VERDICTS ?= $(BUILD)/verdicts.csv
VERDICT_WALLS ?= 8
VERDICT_SEEDS ?= 5
# Of `make tidy-changed` and `make asan-changed`: how far back a source counts as changed.
TIDY_COMMITS ?= 6
ASAN_COMMITS ?= 15
# `make asan` leaves out tests that took longer than this in `make test`: ten times as long under the
# sanitizers, which see the same code on smaller grids and in these.
ASAN_SECONDS ?= 0.5
ASAN_KEEPS = Measure.IsTheSameOnOne|LeavesSilentStations|Plan.LeavesOut|ReadExperiment.Answers
ASAN_KEEPS := $(ASAN_KEEPS)|Hdf5Worker.Damaged|FrameTexture.TellsShifts|FollowPressure.OfABuckled

# CMake takes these as the defaults of a new build folder and leaves one that exists as it is.
export CMAKE_GENERATOR ?= Ninja
export CMAKE_BUILD_TYPE ?= $(BUILD_TYPE)
export CMAKE_CXX_COMPILER_LAUNCHER ?= $(shell command -v ccache)
export JOBS
# A build of the same sources in another folder finds the same objects.
export CCACHE_BASEDIR ?= $(CURDIR)
export CCACHE_NOHASHDIR ?= 1

install = $(if $(filter yes,$(PACKAGES)),tools/install_packages.sh,@: not installing)
# Node, npm and a browser may well be there from elsewhere, which Debian's would quarrel with.
has = $(shell command -v $(1))
install_web = $(if $(and $(call has,node),$(call has,npm),$(or $(CHROMIUM),$(call has,chromium))),:,$(install) web)
solver = $(if $(filter yes,$(SOLVER)),navier-stokes)
configure = cmake -S . -B $(BUILD) --log-level=WARNING \
  -DMANOSCOPE_NAVIER_STOKES=$(if $(solver),ON,OFF) $(CMAKE_FLAGS)
# The program alone needs no test framework: a new folder starts without the tests.
without_tests = $(if $(wildcard $(BUILD)/build.ninja),,-DMANOSCOPE_TESTS=OFF)

.NOTPARALLEL:
.PHONY: all demo test side-walls bench bench-flow docs accuracy coverage verdicts goals planning flow-models \
        simulation simulation-check web web-check check format format-check layers \
        scripts tidy tidy-changed asan asan-changed asan-all fuzz fuzz-coverage clean \
        install-packages help

all: ## build the program, build/manoscope, and its Navier-Stokes solver (the default)
	@$(install) build libraries figures $(solver)
	@$(configure) $(without_tests)
	@cmake --build $(BUILD) --target programs -j $(JOBS)

demo: all ## a virtual experiment with known truth: made, measured, judged
	$(BUILD)/manoscope demo -o $(DEMO)

test: ## build everything and run every test
	@$(install) build libraries figures tests $(solver)
	@$(configure) -DMANOSCOPE_TESTS=ON
	@cmake --build $(BUILD) -j $(JOBS)
	@ctest --test-dir $(BUILD) --output-on-failure -j $(JOBS)

bench: ## time the program against the same work in numpy
	@$(install) build libraries figures bench
	@$(configure) $(without_tests) -DMANOSCOPE_BENCH=ON
	@cmake --build $(BUILD) --target bench -j $(JOBS)

bench-flow: ## time the Navier-Stokes solver against FreeFem++ and dolfinx; installs them and deal.II
	@$(install) build libraries navier-stokes bench-flow
	@$(configure) $(without_tests)
	@cmake --build $(BUILD) -j $(JOBS) --target manoscope-navier-stokes
	@mkdir -p $(BUILD)/bench
	@/usr/bin/python3 bench/compare_flow.py --program $(BUILD)/manoscope-navier-stokes \
	  --json $(BUILD)/bench/flow.json

docs: all ## check links and commands of the documentation
	@tools/check_docs.py --program $(BUILD)/manoscope

accuracy: all ## make, measure and judge every scenario at full size, write the tables of docs/
	@$(install) tests
	/usr/bin/python3 tools/accuracy_table.py $(BUILD)/manoscope docs $(wildcard $(PRACTICE)/S*)

coverage: ## do the error bars hold? hundreds of virtual experiments; goes on where it was stopped
	@$(install) build libraries figures tests
	@$(configure) -DMANOSCOPE_TESTS=ON
	@cmake --build $(BUILD) --target coverage_campaign -j $(JOBS)
	$(BUILD)/coverage_campaign -o $(COVERAGE) --walls $(WALLS) --seeds $(SEEDS)
	@tools/coverage_table.py $(COVERAGE) --page docs/error-budget.md

verdicts: ## are the flow verdicts right? 200 virtual experiments, an hour; goes on where it was stopped
	@$(install) build libraries figures tests
	@$(configure) -DMANOSCOPE_TESTS=ON
	@cmake --build $(BUILD) --target verdict_campaign -j $(JOBS)
	$(BUILD)/verdict_campaign -o $(VERDICTS) --walls $(VERDICT_WALLS) --seeds $(VERDICT_SEEDS)
	@tools/verdict_table.py $(VERDICTS) --page docs/validation.md

goals: ## what a measurement reaches against what it was to reach: a table of docs/error-budget.md
	@$(install) build libraries figures tests bench
	@$(configure) -DMANOSCOPE_TESTS=ON -DMANOSCOPE_BENCH=ON
	@cmake --build $(BUILD) -j $(JOBS) --target coverage_campaign coverage_test membrane_dic_test \
	  numerics_test bench_reading
	$(BUILD)/coverage_campaign -o $(COVERAGE) --walls $(WALLS) --seeds $(SEEDS)
	@mkdir -p $(BUILD)/goals
	@$(BUILD)/tests/coverage_test --gtest_filter='*PixelLimit*' --gtest_also_run_disabled_tests \
	  --gtest_output=json:$(BUILD)/goals/pixels
	@$(BUILD)/tests/membrane_dic_test --gtest_output=json:$(BUILD)/goals/membranes
	@$(BUILD)/tests/numerics_test --gtest_filter='*NistStrd*:*GumH*:*Jcgm101*' \
	  --gtest_output=json:$(BUILD)/goals/numerics
	@/usr/bin/python3 bench/compare.py --programs $(BUILD)/bench --manoscope $(BUILD)/manoscope \
	  --reading-only --json $(BUILD)/goals/bench
	@/usr/bin/python3 tools/goals_table.py $(COVERAGE) $(BUILD)/goals/bench $(BUILD)/goals/pixels \
	  $(BUILD)/goals/membranes $(BUILD)/goals/numerics --page docs/error-budget.md

planning: ## try plans on virtual experiments, an hour of them, write the table of docs/planning.md
	@$(install) build libraries tests
	@$(configure) -DMANOSCOPE_TESTS=ON
	@cmake --build $(BUILD) -j $(JOBS) --target manoscope coverage_campaign
	/usr/bin/python3 tools/plan_table.py $(BUILD) docs

flow-models: ## errors of the flow models in S1 to S5: figure and table of docs/flow-models.md, minutes
	@$(install) build libraries figures tests
	@$(configure) -DMANOSCOPE_TESTS=ON
	@cmake --build $(BUILD) -j $(JOBS) --target model_errors
	$(BUILD)/model_errors $(BUILD)/model_errors.csv
	/usr/bin/python3 tools/model_error_figure.py $(BUILD)/model_errors.csv docs

simulation: all ## the Navier-Stokes solver, build/manoscope-navier-stokes, where it was left out

simulation-check: ## its flows against independent solutions, in three dimensions on fine meshes: minutes
	@$(install) build libraries tests navier-stokes
	@$(configure) -DMANOSCOPE_TESTS=ON
	@cmake --build $(BUILD) -j $(JOBS) --target navier_stokes_test
	$(BUILD)/tests/navier_stokes_test --gtest_also_run_disabled_tests

side-walls: all ## what side walls do to a simulation: figure and table of docs/side-walls.md, minutes
	/usr/bin/python3 tools/side_walls.py $(BUILD)/manoscope $(EXPERIMENT) docs

web: ## build scripts and styles of report.html and the local app, web/dist, from web/
	@$(install_web)
	@tools/web.sh build

web-check: all ## types and tests of web/, web/dist as built, report.html and the app in a browser
	@$(install_web)
	@tools/web.sh check $(BUILD)/manoscope

check: format-check layers scripts tidy ## format, layers, scripts and clang-tidy

format: ## format every C++ file
	@$(install) checks
	@tools/format.sh

format-check:
	@$(install) checks
	@tools/format.sh --check

layers: ## check that includes point down layers.txt
	@$(install) build
	@tools/check_layers.py

scripts: ## check the scripts of tools/
	@$(install) checks
	@shellcheck tools/*.sh fuzz/*.sh .ci/run
	@for test in tools/*_test.py; do python3 "$$test" -q || exit 1; done

tidy: ## run clang-tidy on the sources
	@$(install) build libraries checks
	@$(configure) $(without_tests)
	@cmake --build $(BUILD) --target tidy

tidy-changed: ## clang-tidy on the sources that the last TIDY_COMMITS commits changed
	@$(install) build libraries checks
	@$(configure) $(without_tests)
	@cmake --build $(BUILD) -j $(JOBS) --target manoscope
	@if git rev-parse -q --verify HEAD~$(TIDY_COMMITS) >/dev/null; then \
	  changed=$$(git diff --name-only --diff-filter=d HEAD~$(TIDY_COMMITS) -- 'src/*.cpp' \
	    ':!*_test.cpp'); \
	  if [ -n "$$changed" ]; then tools/tidy.sh $(BUILD) $$changed; fi; \
	else tools/tidy.sh $(BUILD); fi

asan: ## the tests once more, under the address and undefined-behaviour sanitizers; not the longest
	@$(install) build libraries figures tests
	@cmake --preset asan --log-level=WARNING $(CMAKE_FLAGS)
	@cmake --build --preset asan -j $(JOBS)
	@ctest --preset asan -j $(JOBS) \
	  -E "$$(tools/long_tests.py $(BUILD) $(ASAN_SECONDS) '$(ASAN_KEEPS)')"

asan-changed: ## the same for the modules alone that the last ASAN_COMMITS commits changed
	@$(install) build libraries figures tests
	@cmake --preset asan --log-level=WARNING $(CMAKE_FLAGS)
	@modules=$$(tools/changed_modules.py $(ASAN_COMMITS)); \
	if [ -z "$$modules" ]; then echo "no module changed"; exit 0; fi; \
	cmake --build --preset asan -j $(JOBS) --target $$(printf '%s_test ' $$modules) && \
	long=$$(tools/long_tests.py $(BUILD) $(ASAN_SECONDS) '$(ASAN_KEEPS)') && \
	for module in $$modules; do echo "-- $$module"; \
	  ctest --test-dir build-asan/src/manoscope/$$module --output-on-failure --no-tests=error \
	    -j $(JOBS) -E "$$long" || exit 1; done

asan-all: ## every test under the sanitizers: an hour
	@$(MAKE) --no-print-directory asan ASAN_SECONDS=1e9

fuzz: ## 100,000 damaged map files against every reader, under the sanitizers
	@$(install) build libraries tests
	@cmake --preset asan --log-level=WARNING $(CMAKE_FLAGS)
	@cmake --build --preset asan -j $(JOBS) --target mutate_maps
	@build-asan/tests/mutate_maps --files $(FUZZ_FILES) --jobs $(JOBS)

fuzz-coverage: ## every reader under libFuzzer for SECONDS_PER_READER; needs clang
	@$(install) build libraries tests fuzz
	@cmake --preset asan --log-level=WARNING $(CMAKE_FLAGS)
	@cmake --build --preset asan -j $(JOBS) --target mutate_maps
	@cmake --preset fuzz --log-level=WARNING $(CMAKE_FLAGS)
	@cmake --build --preset fuzz -j $(JOBS)
	@fuzz/run_fuzzer.sh build-fuzz/fuzz/fuzz_reader build-asan/tests/mutate_maps $(SECONDS_PER_READER)

clean: ## remove the build folders and the demo's output
	@for folder in $(BUILD) build-asan build-dev build-fuzz build-release; do \
	  if [ -f "$$folder/CMakeCache.txt" ]; then rm -rf "$$folder"; fi; done
	@rm -rf manoscope-demo

install-packages: ## install every package of packages/debian.txt that is missing
	@tools/install_packages.sh

help: ## this list
	@sed -n 's/^\([a-z-]*\):.* ## \(.*\)/\1\t\2/p' Makefile | expand -t 20
