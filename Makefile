# SPDX-License-Identifier: GPL-3.0-or-later
# breccia: `make help` lists the targets. Sources are found by pattern; a folder with a model.c is a
# contact model. CFG=release|bare|free|debug|san picks the configuration; release builds into build/.

CFG   ?= release
BUILD := build$(if $(filter release,$(CFG)),,/$(CFG))
JOBS  ?= $(shell nproc 2>/dev/null || echo 2)

empty :=
space := $(empty) $(empty)
.DEFAULT_GOAL := all
.SUFFIXES:
.DELETE_ON_ERROR:
.SECONDARY:
MAKEFLAGS += --no-builtin-rules
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(JOBS)
endif

# --- sources ---------------------------------------------------------------------------------------
MODELS       := $(filter-out common calib tests cases docs results,$(patsubst %/model.c,%,$(sort $(wildcard */model.c))))
LIB_SOURCES  := $(sort $(wildcard common/*/*.c common/*/*.cpp calib/*.c $(addsuffix /*.c,$(MODELS))))
# tests: what each file defines as brc_rig_<name>
RIGS         := $(sort $(patsubst brc_rig_%,%,$(shell grep -hoE "^const struct brc_rig_type brc_rig_[a-z_]+" common/rigs/*.c | grep -oE "brc_rig_[a-z_]+$$")))
# the slow ones first, so that the cores stay busy to the end
TEST_FOLDERS := $(addprefix tests/,golden determinism converge model cli unit)
TEST_SOURCES := $(foreach d,$(TEST_FOLDERS),$(sort $(wildcard $d/test_*.c)))
TEST_SCRIPTS := $(foreach d,$(TEST_FOLDERS),$(sort $(wildcard $d/test_*.sh)))
# whatever tests share, the null model included; linked in as far as a test asks for it
AID_SOURCES  := $(sort $(filter-out $(TEST_SOURCES),$(wildcard tests/*.c tests/null/*.c $(addsuffix /*.c,$(TEST_FOLDERS)))))
BENCH_SOURCES := $(sort $(wildcard tests/bench/*.c))
MAIN_SOURCES := $(wildcard common/main.c)

objects = $(addprefix $(BUILD)/obj/,$(addsuffix .o,$1))
# C++ first, since it takes longest
LIB_OBJECTS   := $(call objects,$(filter %.cpp,$(LIB_SOURCES)) $(filter %.c,$(LIB_SOURCES)))
AID_OBJECTS   := $(call objects,$(AID_SOURCES))
SAN_SOURCES   := $(if $(filter san,$(CFG)),$(wildcard tests/san/*.c))$(if $(filter fuzz,$(CFG)),tests/san/hdf5.c)
FUZZ_SOURCES  := $(if $(filter fuzz,$(CFG)),$(wildcard tests/fuzz/*.c))
SAN_OBJECTS   := $(call objects,$(SAN_SOURCES))
TEST_PROGRAMS := $(patsubst %.c,$(BUILD)/%,$(TEST_SOURCES))
HARD_SOURCES  := $(sort $(wildcard tests/hard/*.c))
HARD_PROGRAMS := $(patsubst %.c,$(BUILD)/%,$(HARD_SOURCES))
BENCH_PROGRAMS := $(patsubst %.c,$(BUILD)/%,$(BENCH_SOURCES))
FUZZ_PROGRAMS := $(patsubst %.c,$(BUILD)/%,$(FUZZ_SOURCES))
PROGRAM       := $(if $(MAIN_SOURCES),$(BUILD)/breccia)

# --- flags -----------------------------------------------------------------------------------------
# build/deps.mk is made by .ci/deps, which first installs what is missing; make reads it again then.
ifneq ($(filter-out clean help deps uninstall,$(or $(MAKECMDGOALS),all)),)
include build/deps.mk
endif
build/deps.mk: .ci/deps
	@.ci/deps build $@

CC       := gcc
CXX      := g++
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wvla -Wpointer-arith -Wcast-qual -Wundef -Wformat=2 \
            -Wwrite-strings -Wduplicated-cond -Wlogical-op -Wnull-dereference -Werror
# before C23, pedantry forbids passing double (*)[3] as const double (*)[3]; C23 allows it
# functions that take vectors are all inlined: the convention for passing them does not matter
WARNINGS_C := -Wno-psabi -Wno-c11-c2x-compat -Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition
WARNINGS_CXX := -Wmissing-declarations
FLAGS_release := -O2 -g
# all options off as it is compiled: what they cost when they are off as it runs is the difference
FLAGS_bare    := -O2 -g -DBRC_BARE
FLAGS_debug   := -O0 -g -DBRC_DEBUG
FLAGS_san     := -O1 -g -DBRC_DEBUG -fno-omit-frame-pointer -fsanitize=address,undefined \
                 -fno-sanitize-recover=all
# libFuzzer is clang's; the C++ of the tessellation stays with g++ and is not instrumented
FLAGS_fuzz    := -O1 -g -DBRC_DEBUG -fno-omit-frame-pointer
FUZZ_FLAGS    := -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
# forces and energies of vgcm added up in whatever order is fastest: what their fixed order costs
FLAGS_free    := -O2 -g -DBRC_FREE_SUMS
ifeq ($(FLAGS_$(CFG)),)
$(error CFG=$(CFG) is unknown; known are release, bare, free, debug, san and fuzz)
endif
ifeq ($(CFG),fuzz)
CC       := clang
WARNINGS := -Wall -Wextra -Werror -Wno-psabi -Wno-unknown-pragmas
WARNINGS_C := $(FUZZ_FLAGS)
endif
COMMON_FLAGS = $(FLAGS_$(CFG)) -fPIC -fno-semantic-interposition -ffp-contract=off -fno-math-errno \
               -D_POSIX_C_SOURCE=200809L -I. -I$(BUILD) $(DEPS_CFLAGS) $(WARNINGS)
CFLAGS_ALL   = -std=c17 $(COMMON_FLAGS) $(WARNINGS_C) $(CFLAGS)
CXXFLAGS_ALL = -std=c++17 $(COMMON_FLAGS) $(WARNINGS_CXX) -frounding-math \
               $(FLAGS_CXX_$(CFG)) $(CXXFLAGS)
# undefined behaviour is looked for in our C only: in the templates of CGAL it takes minutes to compile
FLAGS_CXX_san := -g1 -fno-sanitize=undefined
LINK_FLAGS   = $(FLAGS_$(CFG)) $(LINK_FLAGS_$(CFG)) $(LDFLAGS)
LINK_FLAGS_san := -Wl,--wrap=MPI_Init,--wrap=MPI_Finalize

# --- building --------------------------------------------------------------------------------------
.PHONY: all debug san library tests
all: library $(PROGRAM) ## build/breccia, build/libbreccia.a and build/libbreccia.so
debug san: ## the same with assertions, or with the address and undefined-behaviour sanitizers
	@+$(MAKE) --no-print-directory CFG=$@ all
library: $(BUILD)/libbreccia.a $(if $(filter san,$(CFG)),,$(BUILD)/libbreccia.so)
tests: $(TEST_PROGRAMS)

# files whose content is a fact; written only when the fact changes
define write_fact
@mkdir -p $(@D); printf '%s\n' $1 >$@.new; if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi
endef
.PHONY: FORCE
FORCE:
$(BUILD)/registry_list.h: FORCE
	$(call write_fact,'/* made by make from the folders with a model.c */' $(patsubst %,'BRC_MODEL(brc_model_%)',$(MODELS)))
$(BUILD)/rig_list.h: FORCE
	$(call write_fact,'/* made by make from the tests in common/rigs */' '#define BRC_RIG_NAMES "$(subst $(space),|,$(RIGS))"' \
		'#define BRC_RIGS $(patsubst %,BRC_RIG(brc_rig_%),$(RIGS))')
$(BUILD)/flags: FORCE
	$(call write_fact,'$(CC) $(CXX) $(CFLAGS_ALL) $(CXXFLAGS_ALL) $(LINK_FLAGS)')
$(BUILD)/sources: FORCE
	$(call write_fact,$(SONAME) $(LIB_SOURCES) $(AID_SOURCES))

$(BUILD)/obj/%.c.o: %.c $(BUILD)/flags | $(BUILD)/registry_list.h $(BUILD)/rig_list.h
	@mkdir -p $(@D)
	@echo "cc   $<"
	@$(CC) $(CFLAGS_ALL) -MMD -MP -c $< -o $@
$(BUILD)/obj/%.cpp.o: %.cpp $(BUILD)/flags
	@mkdir -p $(@D)
	@echo "c++  $<"
	@$(CXX) $(CXXFLAGS_ALL) -MMD -MP -c $< -o $@
$(BUILD)/obj/common/engine/registry.c.o: $(BUILD)/registry_list.h
$(BUILD)/obj/common/rigs/rigs.c.o: $(BUILD)/rig_list.h
# loops that are compiled for each instruction set
%_base.c.o %_avx2.c.o %_avx512.c.o: FLAGS_release := -O3 -g
%_base.c.o %_avx2.c.o %_avx512.c.o: FLAGS_bare := -O3 -g -DBRC_BARE
%_base.c.o %_avx2.c.o %_avx512.c.o: FLAGS_free := -O3 -g -DBRC_FREE_SUMS

$(BUILD)/libbreccia.a: $(LIB_OBJECTS) $(BUILD)/sources
	@echo "ar   $@"
	@rm -f $@; ar rcs $@ $(LIB_OBJECTS)
$(BUILD)/libbreccia.so: $(LIB_OBJECTS) $(BUILD)/sources
	@echo "link $@"
	@$(CXX) $(LINK_FLAGS) -shared -Wl,-soname,$(SONAME) $(LIB_OBJECTS) $(DEPS_LIBS) -o $@
$(BUILD)/libaid.a: $(AID_OBJECTS) $(BUILD)/sources
	@rm -f $@; ar rcs $@ $(AID_OBJECTS)
$(BUILD)/breccia: $(BUILD)/obj/common/main.c.o $(SAN_OBJECTS) $(BUILD)/libbreccia.a
	@echo "link $@"
	@$(CXX) $(LINK_FLAGS) $^ $(DEPS_LIBS) -o $@
$(TEST_PROGRAMS) $(BENCH_PROGRAMS) $(HARD_PROGRAMS): $(BUILD)/%: $(BUILD)/obj/%.c.o $(SAN_OBJECTS) $(BUILD)/libaid.a $(BUILD)/libbreccia.a
	@mkdir -p $(@D)
	@echo "link $@"
	@$(CXX) $(LINK_FLAGS) $^ $(DEPS_LIBS) $(DEPS_TEST_LIBS) -o $@

$(FUZZ_PROGRAMS): $(BUILD)/%: $(BUILD)/obj/%.c.o $(SAN_OBJECTS) $(BUILD)/libaid.a $(BUILD)/libbreccia.a
	@mkdir -p $(@D)
	@echo "link $@"
	@clang++ $(LINK_FLAGS) -fsanitize=fuzzer,address,undefined $^ $(DEPS_LIBS) -o $@

ALL_SOURCES := $(LIB_SOURCES) $(MAIN_SOURCES) $(AID_SOURCES) $(SAN_SOURCES) $(TEST_SOURCES) $(BENCH_SOURCES) $(FUZZ_SOURCES)
-include $(patsubst %.o,%.d,$(call objects,$(ALL_SOURCES)))

# --- installing ------------------------------------------------------------------------------------
.PHONY: install uninstall
VERSION := $(shell sed -n 's/^.define BRC_VERSION "\(.*\)"/\1/p' common/base/brc.h)
# before 1.0 each minor version may change the interface
SONAME  := libbreccia.so.$(word 1,$(subst ., ,$(VERSION))).$(word 2,$(subst ., ,$(VERSION)))
PREFIX  ?= /usr/local
BINDIR  ?= $(PREFIX)/bin
LIBDIR  ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
DATADIR ?= $(PREFIX)/share
DOCDIR  ?= $(DATADIR)/doc/breccia
# of the tessellation and the packing alone
PUBLIC_HEADERS := $(filter-out common/specimen/tess_cgal.h common/specimen/packing_cache.h common/base/lanes.h common/parallel/sums_kernels.inc.h common/engine/platen_surface.h common/engine/integrate_kernels.inc.h,$(wildcard common/*/*.h calib/*.h))
DOCUMENTS := README.md LICENSE $(wildcard docs/*.md) docs/example_library.c
COMPLETION := $(DATADIR)/bash-completion/completions/breccia
$(BUILD)/breccia.1: docs/make-man $(BUILD)/breccia
	@$^ >$@
$(BUILD)/completion: docs/make-completion $(BUILD)/breccia
	@$^ >$@
$(BUILD)/breccia.pc: $(BUILD)/flags common/base/brc.h Makefile FORCE
	@printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$(LIBDIR)' 'includedir=$(INCLUDEDIR)' '' 'Name: breccia' \
		'Description: fracture of bonded-grain rock, contact models side by side' 'Version: $(VERSION)' \
		'Cflags: -I$${includedir}' 'Libs: -L$${libdir} -lbreccia' \
		'Libs.private: $(DEPS_LIBS) -lstdc++' >$@
install: all $(BUILD)/breccia.1 $(BUILD)/completion $(BUILD)/breccia.pc ## into PREFIX (/usr/local), below DESTDIR
	@install -d $(addprefix $(DESTDIR),$(BINDIR) $(LIBDIR)/pkgconfig $(INCLUDEDIR)/breccia $(DATADIR)/man/man1 \
		$(dir $(COMPLETION)) $(DOCDIR) $(DOCDIR)/cases)
	@install $(BUILD)/breccia $(DESTDIR)$(BINDIR)/breccia
	@install -m 644 $(BUILD)/libbreccia.a $(DESTDIR)$(LIBDIR)/libbreccia.a
	@install $(BUILD)/libbreccia.so $(DESTDIR)$(LIBDIR)/libbreccia.so.$(VERSION)
	@ln -sf libbreccia.so.$(VERSION) $(DESTDIR)$(LIBDIR)/$(SONAME)
	@ln -sf $(SONAME) $(DESTDIR)$(LIBDIR)/libbreccia.so
	@install -m 644 $(BUILD)/breccia.pc $(DESTDIR)$(LIBDIR)/pkgconfig/breccia.pc
	@for header in $(PUBLIC_HEADERS); do \
		sed 's,^#include "\(common/[a-z]*\|calib\)/,#include ",' $$header >$(DESTDIR)$(INCLUDEDIR)/breccia/$${header##*/}; \
	done; chmod 644 $(DESTDIR)$(INCLUDEDIR)/breccia/*.h
	@install -m 644 $(BUILD)/breccia.1 $(DESTDIR)$(DATADIR)/man/man1/breccia.1
	@install -m 644 $(BUILD)/completion $(DESTDIR)$(COMPLETION)
	@install -m 644 $(DOCUMENTS) $(DESTDIR)$(DOCDIR)
	@install -m 644 $(wildcard cases/*.yaml) $(DESTDIR)$(DOCDIR)/cases
	@echo "installed breccia $(VERSION) in $(DESTDIR)$(PREFIX)$(if $(DESTDIR),,; run ldconfig if the linker does not find libbreccia)"
uninstall: ## removes what install has put there
	@rm -f $(DESTDIR)$(BINDIR)/breccia $(DESTDIR)$(LIBDIR)/libbreccia.a $(DESTDIR)$(LIBDIR)/libbreccia.so* \
		$(DESTDIR)$(LIBDIR)/pkgconfig/breccia.pc $(DESTDIR)$(DATADIR)/man/man1/breccia.1 $(DESTDIR)$(COMPLETION)
	@rm -rf $(DESTDIR)$(INCLUDEDIR)/breccia $(DESTDIR)$(DOCDIR)
	@echo "removed breccia from $(DESTDIR)$(PREFIX)"

# --- checking --------------------------------------------------------------------------------------
.PHONY: check check-san check-mutants check-paraview fuzz fuzz-programs lint demo bench converge gallery hard paper-gt12 paper-vgcm deps clean help
RUN_ENV := CFG=$(CFG) BUILD=$(BUILD) BRECCIA=$(BUILD)/breccia JOBS=$(JOBS)
check: all $(TEST_PROGRAMS) ## all tests; the last line is `N passed, N failed`
	@$(RUN_ENV) tests/run $(TEST_PROGRAMS) $(TEST_SCRIPTS)
check-san: ## all tests under the address and undefined-behaviour sanitizers
	@+$(MAKE) --no-print-directory CFG=san check
FUZZ_TIME ?= 600
build/fuzz/tools: .ci/deps
	@mkdir -p $(@D); .ci/deps fuzz $@
fuzz: build/fuzz/tools ## look for bytes that break the readers of files, FUZZ_TIME seconds each (600)
	@+$(MAKE) --no-print-directory CFG=fuzz fuzz-programs
	@FUZZ_TIME=$(FUZZ_TIME) JOBS=$(JOBS) tests/fuzz/run
fuzz-programs: $(FUZZ_PROGRAMS)
check-mutants: all $(TEST_PROGRAMS) ## plant faults in the laws; the tests must find each
	@if [ -x tests/mutants/run ]; then $(RUN_ENV) tests/mutants/run; else echo "no tests/mutants/run"; fi

build/paraview/installed: .ci/deps
	@mkdir -p $(@D); .ci/deps paraview $@
check-paraview: all build/paraview/installed ## opens the frames with VTK's and ParaView's own readers (installs both)
	@$(RUN_ENV) tests/paraview/run build/paraview

demo: all ## both models side by side: compression, tension, Brazilian test
	@for case in $(sort $(wildcard cases/demo_*.yaml)); do $(BUILD)/breccia compare $$case --force && echo || exit 1; done
	@echo "pictures:"; for picture in results/demo_*/*.png; do echo "  $$picture"; done
hard: all $(HARD_PROGRAMS) ## hard cases of numerical stability, into docs/stability.md
	@tests/hard/run $(HARD_PROGRAMS)
gallery: all ## a picture of each test, for docs/tests.md
	@docs/make-gallery $(PROGRAM)
converge: all ## what accuracy costs: the demo's tests, into docs/speed-and-error.md; goes on where it was stopped
	@JOBS=$(JOBS) docs/make-converge $(PROGRAM)
paper-gt12 paper-vgcm: paper-%: all ## the paper's numbers beside ours, into docs/validation.md; VERIFY=1: does 2 % again, FRESH=1: all
	@JOBS=$(JOBS) docs/make-paper $(PROGRAM) $*
build/bench/tools: .ci/deps
	@mkdir -p $(@D); .ci/deps bench $@
bench: all $(BENCH_PROGRAMS) build/bench/tools ## times of the hot loops, costs of options, the machine's limits
	@+$(MAKE) --no-print-directory CFG=bare build/bare/tests/bench/bench_options
	@+$(MAKE) --no-print-directory CFG=free build/free/tests/bench/bench_vgcm
	@for program in $(BENCH_PROGRAMS); do $$program || exit 1; done

# --- lint: each check leaves a mark, so that only what has changed is checked again ----------------
LINT_SOURCES := $(LIB_SOURCES) $(MAIN_SOURCES)
LINT_FILES   := $(sort $(wildcard $(foreach d,common common/* calib $(MODELS) tests tests/*,$(addprefix $d/*.,c cpp h))))
LINT_HEADERS := $(filter %.h,$(LINT_FILES))
# the analyzer needs minutes for the headers of CGAL
TIDY_CXX     := -clang-analyzer-*
LINT_MARKS   := $(addprefix build/lint/,$(LINT_FILES:=.format) $(addsuffix .tidy,$(filter %.cpp,$(LINT_SOURCES)) $(filter %.c,$(LINT_SOURCES))) $(LINT_HEADERS:=.alone))
lint: build/lint/tools ## format, clang-tidy, rules of includes, names, style and equation tags
	@+$(MAKE) --no-print-directory -k lint-files lint-tree
.PHONY: lint-files lint-tree
lint-files: $(LINT_MARKS)
lint-tree: $(LIB_OBJECTS) $(call objects,$(MAIN_SOURCES))
	@tests/lint/run $(BUILD)/obj
build/lint/tools: .ci/deps
	@mkdir -p $(@D); .ci/deps lint $@
build/lint/%.format: % .clang-format
	@mkdir -p $(@D); clang-format --dry-run -Werror $< && touch $@
build/lint/%.tidy: $(BUILD)/obj/%.o .clang-tidy
	@mkdir -p $(@D); echo "tidy $*"
	@clang-tidy --quiet $(if $(filter %.cpp,$*),--checks=$(TIDY_CXX)) $* -- $(if $(filter %.cpp,$*),-std=c++17,-std=c17) -D_POSIX_C_SOURCE=200809L \
		-I. -I$(BUILD) $(DEPS_CFLAGS) 2>$@.log || { cat $@.log; exit 1; }
	@touch $@
build/lint/%.alone: % $(BUILD)/flags | $(BUILD)/registry_list.h $(BUILD)/rig_list.h
	@mkdir -p $(@D); $(CC) $(CFLAGS_ALL) -Wno-unused-macros -MMD -MP -MT $@ -MF $@.d -fsyntax-only -x c -include $< /dev/null \
		&& touch $@
-include $(patsubst %,build/lint/%.alone.d,$(LINT_HEADERS))

deps: ## install what is missing (Debian, Ubuntu)
	@.ci/deps build build/deps.mk
clean: ## remove build/
	rm -rf build
help: ## this list
	@awk -F ':.*## ' '/^[a-z][a-z -]*:.*## / { printf "  %-14s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))
ifneq ($(filter clean,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif
