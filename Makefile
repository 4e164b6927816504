# corobench: see `make help`.
# SPDX-License-Identifier: BSD-3-Clause
CC      = gcc
BUILD   = build
OPT     = -O3
WARN    = -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Werror=implicit -Wno-psabi
# No -ffast-math: it removes operations. No contraction: f64 rounds as `counted` counts.
OPENMP  = -fopenmp
CFLAGS  = -std=gnu11 $(OPT) -g1 -fno-math-errno -ffp-contract=off $(SHARED) $(WARN) $(WERROR) $(SANFLAGS) $(OPENMP)
# The tests share one library of all objects: a hundred copies of it would take 20 GB of disk.
SHARED  = -fPIC -fno-semantic-interposition
INCLUDES = -I. -I/usr/include/suitesparse -I/usr/local/include/suitesparse
CPPFLAGS = $(INCLUDES) -D_GNU_SOURCE -DCB_COMPILER_FLAGS='"$(OPT) -fno-math-errno -ffp-contract=off"'
LDLIBS  = -lcholmod -lgsl -lgslcblas -ljansson -lquadmath -lm -lpthread -ldl
# The operation counter: every quad-precision call of the counted arithmetic
# goes through harness/verify/counter.c.
COUNT   = -Wl,--wrap=__addtf3,--wrap=__subtf3,--wrap=__multf3,--wrap=__divtf3,--wrap=sqrtq
COMMIT := $(shell git describe --always --dirty 2>/dev/null || echo unknown)

# As many jobs as processors unless -j says otherwise.
JOBS   := $(shell nproc)
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(JOBS)
endif
# In `make setup test` the build waits for setup.
FIRST  := $(filter setup clean,$(MAKECMDGOALS))

# One source, many arithmetics: each file of $(GENERIC) is compiled once per
# name, with the scalar and the lanes below. `counted` is -O0, so that what is
# counted is what is written: nothing folded, merged or moved between stages.
ARITHMETICS = f64 f32 f64x4 f64x8 f32x8 f32x16 counted
ARITH_f64     = -DCB_SCALAR=double -DCB_LANES=1 -DCB_SUFFIX=f64
ARITH_f32     = -DCB_SCALAR=float -DCB_LANES=1 -DCB_SUFFIX=f32
ARITH_counted = -DCB_SCALAR=__float128 -DCB_LANES=1 -DCB_SUFFIX=counted -DCB_COUNTED -O0
# Lanes are compiled for the instruction set that has them and run where the
# processor has it; on another architecture the compiler splits them into what
# there is. Their multiply-adds are fused.
ifeq ($(shell uname -m),x86_64)
AVX2          = -mavx2 -mfma -ffp-contract=fast -DCB_NEEDS='"avx2"' -DCB_FLAGS='"-mavx2 -mfma -ffp-contract=fast"'
AVX512        = -mavx512f -mavx512dq -mavx512vl -mavx512bw -mprefer-vector-width=512 \
                -ffp-contract=fast -DCB_NEEDS='"avx512"' \
                -DCB_FLAGS='"-mavx512f -mavx512dq -mavx512vl -mavx512bw -mprefer-vector-width=512 -ffp-contract=fast"'
endif
ARITH_f64x4   = -DCB_SCALAR=double -DCB_LANES=4 -DCB_SUFFIX=f64x4 $(AVX2)
ARITH_f32x8   = -DCB_SCALAR=float -DCB_LANES=8 -DCB_SUFFIX=f32x8 $(AVX2)
ARITH_f64x8   = -DCB_SCALAR=double -DCB_LANES=8 -DCB_SUFFIX=f64x8 $(AVX512)
ARITH_f32x16  = -DCB_SCALAR=float -DCB_LANES=16 -DCB_SUFFIX=f32x16 $(AVX512)

comma     := ,
GENERIC   := $(wildcard kernels/models/*.c kernels/storage/*.c kernels/solver/*.c)
ONCE      := $(wildcard kernels/*.c reference/*.c) $(wildcard harness/*/*.c) $(filter-out harness/corobench.c,$(wildcard harness/*.c))
# The slowest first, so that no processor waits for them in the end.
OBJECTS   := $(foreach a,$(ARITHMETICS),$(GENERIC:%.c=$(BUILD)/$(a)/%.o)) $(ONCE:%.c=$(BUILD)/%.o)
TESTS     := $(patsubst tests/%.c,$(BUILD)/tests/%,$(wildcard tests/test_*.c))
# Fuzzed are the readers of files, one target each, with what they need and no more: the
# registry, for the names of laws, lists no arithmetic there.
FUZZERS   := $(patsubst tests/%.c,$(BUILD)/tests/%,$(wildcard tests/fuzz/fuzz_*.c))
FUZZED    := $(wildcard harness/error.c harness/nearest.c harness/files/*.c) \
             $(addprefix harness/scene/,json.c lines.c parts.c scene.c points.c body.c) \
             $(addprefix harness/measure/,environment.c results.c results_slices.c results_json.c \
               results_speed.c results_tables.c statistics.c) \
             harness/bench/bench_scene.c kernels/material.c kernels/registry.c
# How a test makes allocations fail where the sanitizer has taken the place of malloc already.
SHORTAGE  := $(if $(findstring address,$(SANFLAGS)),-lsuitesparseconfig \
               $(patsubst %,-Wl$(comma)--wrap=%,malloc calloc realloc reallocarray aligned_alloc free))
# Libraries that `corobench frames --check` is tried on, some of them broken on purpose.
LIBRARIES := $(patsubst tests/frames/%.c,$(BUILD)/tests/frames/%.so,$(wildcard tests/frames/*.c))
# Scenes that the program carries with it.
$(BUILD)/harness/verify/claims_scenes.o: scenes/rabbit-crush.json scenes/liver-yank.json
# The files that state the commit, compiled anew when it changes.
DATED     := $(patsubst %.c,$(BUILD)/%.o,$(shell grep -lsw CB_COMMIT harness/*/*.c))

all: $(BUILD)/corobench ## build the program, build/corobench (the default)

programs: all $(TESTS) $(LIBRARIES) ## build the program and the tests, run nothing

setup: ## install the missing Debian packages (as root or through sudo)
	@CC='$(CC)' INCLUDES='$(INCLUDES)' sh harness/setup.sh $(ALSO)

test: programs ## build and run all tests; the last line is the total
	@tests/run $(TESTS)

# Builds of their own, for what looks for faults. In long functions addresses are checked by
# calls, and null pointers by the address sanitizer alone: that builds in a third of the time.
SANITIZED = --no-print-directory BUILD=build-sanitize OPT=-O1 \
              SANFLAGS='-fsanitize=address,undefined -fno-sanitize=null,pointer-overflow \
              -fno-sanitize-recover=all --param asan-instrumentation-with-call-threshold=100'
RACING    = --no-print-directory BUILD=build-races OPT=-O1 SANFLAGS='-fsanitize=thread'
FUZZING   = --no-print-directory BUILD=build-fuzz OPT=-O1 CC=clang OPENMP= \
              SANFLAGS='-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all'

sanitize: | $(FIRST) ## the same tests under the address and undefined behaviour sanitizers
	@TEST_SECONDS=1200 $(MAKE) $(SANITIZED) test

RACERS = build-races/tests/test_threads build-races/tests/test_machine
# Races are looked for where threads share most: the slow sanitizer gets no more.
races: | $(FIRST) ## threads on a larger mesh under the thread sanitizer
	@$(MAKE) $(RACING) $(RACERS)
	@TSAN_OPTIONS=halt_on_error=1 build-races/tests/test_threads '*_larger_*'
	@TSAN_OPTIONS=halt_on_error=1 build-races/tests/test_machine test_crew

FUZZ_SECONDS = 8
fuzz: | $(FIRST) ## feed every reader with broken files (clang), FUZZ_SECONDS=8 a reader
	@$(MAKE) $(FUZZING) fuzzers
	@tests/fuzz/run $(FUZZ_SECONDS) $(FUZZERS:$(BUILD)/%=build-fuzz/%)

fuzzers: $(FUZZERS)

robustness: programs ## all that may go wrong, tried for some minutes (builds apart): one table
	@$(MAKE) $(SANITIZED) build-sanitize/tests/test_mutations build-sanitize/tests/test_shortage
	@$(MAKE) $(RACING) $(RACERS)
	@$(MAKE) $(FUZZING) fuzzers
	@tests/robustness $(FUZZ_SECONDS) $(BUILD) build-sanitize build-races \
	  $(FUZZERS:$(BUILD)/%=build-fuzz/%)

verify: all ## check laws, operation counts and the paper's claims; fails when an expectation does
	@$(BUILD)/corobench verify --output results/latest
	@plots/draw.sh results/latest

bench: all ## measure the figures and draw them (QUICK=1: in under a minute)
	@$(BUILD)/corobench bench $(if $(QUICK),--quick) --output results/latest
	@plots/draw.sh results/latest

truth: all ## hold the models against closed forms and conservation; fails when one is missed
	@$(BUILD)/corobench truth --output results/latest
	@plots/draw.sh results/latest

extremes: all ## what breaks, and where, for each model; fails while something does
	@$(BUILD)/corobench extremes --output results/latest; status=$$?; \
	  [ $$status -gt 1 ] || plots/draw.sh results/latest || status=2; exit $$status

SCENE = scenes/block.json
trade: all ## error against time of every setting on a scene (SCENE=FILE), drawn
	@$(BUILD)/corobench trade $(SCENE) --output results/latest
	@plots/draw.sh results/latest

recovery: all ## which models come back from inverted and collapsed shapes, drawn
	@$(BUILD)/corobench recovery --output results/latest
	@plots/draw.sh results/latest

films: all ## the scenes of figures 5 and 6: how every model ends, a strip and an animation
	@for scene in rabbit-crush liver-yank; do \
	  $(BUILD)/corobench run scenes/$$scene.json --variant polar-exact/ebe/f64 --variant '*/ebe/f64' \
	    --output results/latest/films || exit; \
	done
	@plots/draw.sh results/latest/films

RESULTS = $(firstword $(wildcard results/latest results/reference) results/latest)
plots: | $(FIRST) ## draw the figures again from stored results, without measuring (RESULTS=DIR)
	@plots/draw.sh $(RESULTS)

help: ## this list
	@sed -nE 's/^([a-z]+):[^#]*## (.*)/\1|\2/p' $(firstword $(MAKEFILE_LIST)) | \
	  while IFS='|' read -r target text; do printf '  make %-10s %s\n' "$$target" "$$text"; done

clean: ## remove everything built
	rm -rf build build-*

$(BUILD)/corobench: $(OBJECTS) $(BUILD)/harness/corobench.o
	@echo 'LINK $@'
	@$(CC) $(CFLAGS) $(COUNT) -o $@ $^ $(LDLIBS)

$(BUILD)/%.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	@echo 'CC   $<'
	@$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

$(DATED): $(BUILD)/commit
$(DATED): private CPPFLAGS += -DCB_COMMIT='"$(COMMIT)"'

define arithmetic_rule
$(BUILD)/$(1)/%.o: %.c $(BUILD)/flags
	@mkdir -p $$(@D)
	@echo 'CC   $$< for $(1)'
	@$$(CC) $$(CPPFLAGS) $$(CFLAGS) $$(ARITH_$(1)) -MMD -MP -c -o $$@ $$<
endef
$(foreach a,$(ARITHMETICS),$(eval $(call arithmetic_rule,$(a))))

$(BUILD)/tests/libcorobench.so: $(OBJECTS)
	@echo 'LINK $@'
	@mkdir -p $(@D)
	@$(CC) $(CFLAGS) $(COUNT) -shared -Wl,-Bsymbolic -o $@ $^ $(LDLIBS)

$(BUILD)/tests/test_%: $(BUILD)/tests/test_%.o $(BUILD)/tests/libcorobench.so
	@echo 'LINK $@'
	@$(CC) $(CFLAGS) $(COUNT) -Wl,-rpath,'$$ORIGIN' -o $@ $^ $(LDLIBS) -lcmocka

# Of its own, as here the objects' allocations are the test's.
$(BUILD)/tests/test_shortage: $(BUILD)/tests/test_shortage.o $(OBJECTS) | $(LIBRARIES)
	@echo 'LINK $@'
	@$(CC) $(CFLAGS) $(COUNT) $(SHORTAGE) -o $@ $^ $(LDLIBS) -lcmocka

$(BUILD)/tests/fuzz/%: $(BUILD)/tests/fuzz/%.o $(FUZZED:%.c=$(BUILD)/%.o)
	@echo 'LINK $@'
	@$(CC) $(CFLAGS) -fsanitize=fuzzer -Wl,--wrap=cb_environment_read $(ARITHMETICS:%=-Wl,--defsym=cb_arithmetic_%=0) -o $@ $^ $(LDLIBS)

# As somebody else builds his: no sanitizer of ours.
$(BUILD)/tests/frames/%.so: tests/frames/%.c tests/frames/jacobi.h $(BUILD)/flags
	@mkdir -p $(@D)
	@echo 'LINK $@'
	@$(CC) -std=gnu11 -O2 $(WARN) $(WERROR) -I. -shared -fPIC -o $@ $< -lm

# Goals that run something run one after the other, in the order given.
BEFORE :=
$(foreach goal,$(filter test sanitize races fuzz robustness verify bench truth extremes trade films recovery plots,$(MAKECMDGOALS)), \
  $(eval $(goal): | $(BEFORE))$(eval BEFORE := $(goal)))

# What is built under other flags, or states another commit, is out of date.
define stamp
@mkdir -p $(@D)
@echo "$$STAMP" | cmp -s - $@ || echo "$$STAMP" >$@
endef
$(BUILD)/flags: export STAMP = $(CC) $(CPPFLAGS) $(CFLAGS) $(foreach a,$(ARITHMETICS),$(ARITH_$(a)))
$(BUILD)/commit: export STAMP = $(COMMIT)
$(BUILD)/flags $(BUILD)/commit: always | $(FIRST)
	$(stamp)

.PHONY: all programs setup test sanitize races fuzz fuzzers robustness verify bench truth extremes trade films recovery plots help clean always
.SECONDARY:
-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
