# corobench: see `make help`.
# SPDX-License-Identifier: BSD-3-Clause
CC      = gcc
BUILD   = build
OPT     = -O3
WARN    = -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Werror=implicit -Wno-psabi
# No -ffast-math: it removes operations. No contraction: f64 rounds as `counted` counts.
CFLAGS  = -std=gnu11 $(OPT) -g -fno-math-errno -ffp-contract=off $(WARN) $(SANFLAGS)
CPPFLAGS = -I. -I/usr/include/suitesparse -D_GNU_SOURCE -DCB_COMPILER_FLAGS='"$(OPT) -fno-math-errno -ffp-contract=off"' -DCB_COMMIT='"$(COMMIT)"'
LDLIBS  = -lcholmod -lgsl -lgslcblas -ljansson -lquadmath -lm -lpthread
# The operation counter: every quad-precision call of the counted arithmetic
# goes through harness/counter.c.
COUNT   = -Wl,--wrap=__addtf3,--wrap=__subtf3,--wrap=__multf3,--wrap=__divtf3,--wrap=sqrtq
COMMIT := $(shell git describe --always --dirty 2>/dev/null || echo unknown)

# One source, many arithmetics: each file of $(GENERIC) is compiled once per
# name, with the scalar and the lanes below. `counted` is -O0, so that what is
# counted is what is written: nothing folded, merged or moved between stages.
ARITHMETICS = f64 counted
ARITH_f64     = -DCB_SCALAR=double -DCB_LANES=1 -DCB_SUFFIX=f64
ARITH_counted = -DCB_SCALAR=__float128 -DCB_LANES=1 -DCB_SUFFIX=counted -DCB_COUNTED -O0
ARITH_f64x4   = -DCB_SCALAR=double -DCB_LANES=4 -DCB_SUFFIX=f64x4
ARITH_f32x8   = -DCB_SCALAR=float -DCB_LANES=8 -DCB_SUFFIX=f32x8

GENERIC   := $(wildcard kernels/models/*.c kernels/storage/*.c kernels/solver/*.c)
ONCE      := $(wildcard kernels/*.c reference/*.c) $(filter-out harness/corobench.c,$(wildcard harness/*.c))
OBJECTS   := $(ONCE:%.c=$(BUILD)/%.o) $(foreach a,$(ARITHMETICS),$(GENERIC:%.c=$(BUILD)/$(a)/%.o))
LANES     := $(foreach a,f64x4 f32x8,$(GENERIC:%.c=$(BUILD)/$(a)/%.o))
TESTS     := $(patsubst tests/%.c,$(BUILD)/tests/%,$(wildcard tests/test_*.c))

all: $(BUILD)/corobench

$(BUILD)/corobench: $(BUILD)/harness/corobench.o $(OBJECTS)
	$(CC) $(CFLAGS) $(COUNT) -o $@ $^ $(LDLIBS)

$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

define arithmetic_rule
$(BUILD)/$(1)/%.o: %.c
	@mkdir -p $$(@D)
	$$(CC) $$(CPPFLAGS) $$(CFLAGS) $$(ARITH_$(1)) -MMD -MP -c -o $$@ $$<
endef
$(foreach a,f64 counted f64x4 f32x8,$(eval $(call arithmetic_rule,$(a))))

$(BUILD)/tests/test_%: $(BUILD)/tests/test_%.o $(OBJECTS)
	$(CC) $(CFLAGS) $(COUNT) -o $@ $^ $(LDLIBS) -lcmocka
# The lanes are shown to compile and to agree; making them fast comes later.
$(BUILD)/tests/test_lanes: $(LANES)

RESULTS = $(firstword $(wildcard results/latest results/reference) results/latest)
bench: $(BUILD)/corobench ## measure the figures and draw them (QUICK=1: in under a minute)
	$(BUILD)/corobench bench $(if $(QUICK),--quick) --output results/latest
	@plots/draw.sh results/latest

plots: ## draw the figures again from stored results (RESULTS=DIR)
	@plots/draw.sh $(RESULTS)
.PHONY: bench plots

clean:
	rm -rf $(BUILD)

.PHONY: all clean
.SECONDARY:
-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
