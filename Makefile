# Plumb. The two commands of the README are
#
#     make deps demo        install what is missing, build, draw a picture
#     make deps test        install what is missing, build, run every test
#
# `make help` lists the rest. Everything is made below $(O). Nothing here needs a compiler or
# pkg-config before a recipe runs, so that `deps` can install them first.
#
# Reading order: this file (library, command line), tools/make/flags.mk, tools/make/effects.mk (what is left out),
# tools/make/test.mk (tests, benchmark, fuzzing, sanitizers), tools/make/install.mk, tools/make/deps.sh.

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
MAKEFLAGS += --no-builtin-rules
.SUFFIXES:

# ---- what a user may set on the command line or in the environment

O       ?= build
JOBS    ?= $(shell nproc 2>/dev/null || echo 1)
# -O2 takes 27 % less processor time to compile; steps take 8 to 24 % longer.
CFLAGS  ?= -O3
PREFIX  ?= /usr/local
DESTDIR ?=
BOX2D3  ?=
ifeq ($(origin CC),default)
CC := gcc
endif
ifeq ($(origin CXX),default)
CXX := g++
endif
LD      ?= ld
AR      ?= ar
OBJCOPY ?= objcopy
ARCH    ?= $(shell uname -m)
# WERROR=1: warnings are errors.  SAN=address,undefined: sanitizers.  V=1: show the commands.

# All processors, whatever goals are asked for; a make inside a make keeps its parent's jobs.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(JOBS)
endif
Q := $(if $(V),,@)

# ---- flags

WARN     := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wvla $(if $(WERROR),-Werror)
WARN_C   := $(WARN) -Wmissing-prototypes -Wstrict-prototypes
SANFLAGS := $(if $(SAN),-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer -g)
SANFLAGS += $(if $(FUZZ),-fsanitize=fuzzer-no-link)

include tools/make/flags.mk
include tools/make/effects.mk
ifneq ($(filter x86_64 amd64,$(ARCH)),)
MACHINE := X86_64
endif
BASELINE := $(BASELINE_$(MACHINE))

# No function takes more of a stack than this: threads of games and of wasm have small ones. Sanitizers and -O0
# keep every temporary.
ifneq ($(filter -O2 -O3,$(CFLAGS)),)
FRAME := $(if $(SAN),,$(if $(findstring clang,$(CC)),-Wframe-larger-than=16384 -Werror=frame-larger-than,\
	-Werror=frame-larger-than=16384))
# Nor may a kernel have vectors that its registers do not hold: GCC takes them to pieces, masks and shuffles lane by lane.
WHOLE := $(if $(findstring clang,$(CC)),,-Wvector-operation-performance)
endif

# One set of objects serves the static and the shared library: hidden symbols are as fast as
# local ones, and a static library that is position-independent can go into a user's plug-in.
SHARED   := -fPIC -fvisibility=hidden -fno-semantic-interposition -DPLUMB_BUILD_SHARED

COMMON   := -std=c17 $(WARN_C) $(MATHS) $(SANFLAGS) -MMD -MP $(EFFECT_DEFS) -Iinclude
LIB_FLAGS  = $(COMMON) $(FRAME) $(SHARED) -Isrc $(CFLAGS) $(BASELINE)
TOOL_FLAGS = $(COMMON) $(if $(filter tests/%,$<),,$(FRAME)) -Isrc -Itools -Itests $(CFLAGS) $(BASELINE) $(PKG_CFLAGS)
CXX_FLAGS  = -std=c++20 $(WARN) $(MATHS) $(SANFLAGS) -MMD -MP -Iinclude $(CFLAGS)

# Asked once, when the first recipe that needs it runs; where pkg-config knows nothing, Debian's places.
DEBIAN_CFLAGS := -I/usr/include/lua5.4 -I/usr/include/cjson -I/usr/include/freetype2
PKG_CFLAGS = $(eval PKG_CFLAGS := $$(shell pkg-config --cflags lua5.4 libcjson libpng freetype2 \
	2>/dev/null || echo $(DEBIAN_CFLAGS)))$(PKG_CFLAGS)
SCENE_LIBS  := -llua5.4 -lcjson
RENDER_LIBS := -lOSMesa -lfreetype -lpng -lgif

# Compiler or flags changed: everything is built again.
FLAGS_LINE := $(CC) $(CXX) $(WARN_C) $(FRAME) $(MATHS) $(BASELINE) $(SANFLAGS) $(SHARED) $(CFLAGS) $(LDFLAGS) $(BOX2D3)$(EFFECT_DEFS:%= %)
NO_BUILD   := help clean deps deps-ci deps-dev format format-check
ifneq ($(filter-out $(NO_BUILD),$(or $(MAKECMDGOALS),all)),)
ifneq ($(file <$(O)/flags),$(FLAGS_LINE))
$(shell mkdir -p $(O))
$(file >$(O)/flags,$(FLAGS_LINE))
endif
endif

# ---- sources and objects: build/float/..., build/double/... and build/far/... mirror the tree

LIB_SRC    := $(filter-out %.simd.c $(LEFT_OUT),$(wildcard src/*/*.c))
SIMD_SRC   := $(filter-out $(LEFT_OUT),$(wildcard src/*/*.simd.c))
SCENE_SRC  := $(wildcard tools/scene/*.c)
RENDER_SRC := $(wildcard tools/render/*.c)
ENGINE_SRC := $(wildcard tools/plumb/engine*.c)
CLI_SRC    := $(filter-out $(ENGINE_SRC),$(wildcard tools/plumb/*.c))
EXAMPLES   := $(patsubst tools/examples/%.c,$(O)/examples/%,$(wildcard tools/examples/*.c)) $(O)/examples/show

# $(call objects,float,sources)
objects = $(patsubst %.c,$(O)/$1/%.o,$2)
lib_objects = $(call objects,$1,$(LIB_SRC)) \
	$(foreach w,$(WIDTHS),$(SIMD_SRC:%.simd.c=$(O)/$1/%.w$w.o))
RENDER_OBJ := $(call objects,float,$(RENDER_SRC))
CLI_OBJ    := $(call objects,float,$(CLI_SRC))

# ---- goals

# The precisions that are asked for; all, if none is. The demo needs one.
PRECISION ?= $(if $(filter-out deps deps-ci deps-dev demo,$(or $(MAKECMDGOALS),all)),$(VARIANTS),float)
WANTED    := $(if $(filter all,$(PRECISION)),$(VARIANTS),$(PRECISION))
ifneq ($(or $(if $(strip $(WANTED)),,none),$(filter-out $(VARIANTS),$(WANTED))),)
$(error PRECISION is '$(PRECISION)'; it must be some of: $(VARIANTS))
endif
LIBRARIES := $(foreach v,$(WANTED),$(O)/libplumb$(SUFFIX_$v).a $(O)/libplumb$(SUFFIX_$v).so)

.PHONY: all lib help clean deps deps-ci deps-dev demo examples amalgamation windows
all: lib $(O)/plumb examples
lib: $(LIBRARIES)
examples: $(EXAMPLES)

help:
	@sed -n 's/^#: \{0,1\}//p' Makefile

#: Plumb: what make can do (all of it below O=build; V=1 shows the commands)
#:
#:   make deps demo    install what is missing, build (float alone), draw build/demo.png
#:   make deps test    install what is missing, build, run every test
#:
#:   all (default)     build/plumb, build/libplumb.a and .so, _d in double, _far with far places, examples
#:   deps, deps-dev    Debian packages: for the two commands above; for fuzz, format, lint as well
#:   deps-ci           those of deps, and what checks the formatting
#:   lib               the libraries alone: PRECISION=float (double, far; all without)
#:   test              every test; T="tests/unit/test_math.c ..." runs only these; TRIALS=10: ten times the random cases
#:   stability         the hard-case tests, the expectations of every scene; hard scenes beside Box2D 2.4.1, Chipmunk (BOX2D3=)
#:   shots             what gets through thin walls, beside Box2D 2.4.1; SHOTS=100000
#:   soak              a busy world for 10^6 steps, twice at once: flat memory, the same bits; SOAK="1000000 seed"
#:   bench             side by side with Box2D 2.4.1; BOX2D3=/prefix adds Box2D 3; BENCH="arguments"
#:   effects           what each effect costs, used, not used, left out: instructions by callgrind, build/effects.csv
#:   amalgamation      build/plumb.h and build/plumb.c: the library as one pair of files
#:   determinism       the same bits with gcc and clang, -O0 to -O3, ASan, every SIMD width
#:   hashes            write tests/determinism/hashes.txt anew, when physics was meant to change
#:   cost              what accuracy costs, beside Box2D 2.4.1, Chipmunk and, with BOX2D3=/prefix, Box2D 3: build/cost
#:   asan, ubsan, tsan every test again under a sanitizer
#:   fuzz              each fuzz harness for FUZZ_TIME=60 seconds
#:   format, lint      clang-format in place; the rules of tools/lint
#:   headers           what a change of the ten headers most included compiles anew
#:   install           PREFIX=/usr/local DESTDIR= (install-lib leaves out the command line; PRECISION= as for lib)
#:   uninstall         takes away what install brought, of all precisions
#:   windows           build/windows/hello.exe: the amalgamation by mingw-w64, for Windows
#:   clean             remove build/
#:
#:   EFFECTS="gravity friction joints"  EFFECTS="all -liquid": a library without the rest (src/schema/effects.h)
#:   CC=clang  CFLAGS="-O2 -g"  WERROR=1  JOBS=1  O=elsewhere

clean:
	rm -rf $(O)

# Packages of Debian 12: for building and testing, and what only developers need.
DEPS := gcc g++ libc6-dev make binutils pkg-config cmake libbox2d-dev libchipmunk-dev libccd-dev libosmesa6-dev \
	libfreetype-dev fonts-dejavu-core liblua5.4-dev libcmocka-dev libpng-dev libgif-dev \
	libcjson-dev libsdl2-dev ffmpeg gnuplot-nox mandoc
DEPS_DEV := $(DEPS) clang clang-format libclang-rt-14-dev valgrind git gcc-mingw-w64-x86-64-posix \
	gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user

deps:
	@tools/make/deps.sh $(DEPS)
deps-ci:
	@tools/make/deps.sh $(DEPS) clang-format
deps-dev:
	@tools/make/deps.sh $(DEPS_DEV)

# When packages are asked for in the same command, they come before anything is compiled.
DEPS_FIRST := $(filter deps deps-ci deps-dev,$(MAKECMDGOALS))

DEMO := assets/scenes/fruit_bowl.lua
demo: $(O)/plumb
	$(Q)$(O)/plumb render $(DEMO) -o $(O)/demo.png
	@echo "demo: $(DEMO) is drawn in $(abspath $(O)/demo.png)"

# ---- rules

define variant_rules
$$(O)/$1/src/%.o: src/%.c $$(O)/flags | $$(DEPS_FIRST)
	@mkdir -p $$(@D)
	@echo "  CC    $$@"
	$$(Q)$$(CC) $$(LIB_FLAGS) $$(DEFS_$1) -c $$< -o $$@

$$(O)/$1/%.o: %.c $$(O)/flags | $$(DEPS_FIRST)
	@mkdir -p $$(@D)
	@echo "  CC    $$@"
	$$(Q)$$(CC) $$(TOOL_FLAGS) $$(OWN_FLAGS) $$(DEFS_$1) -c $$< -o $$@

$$(O)/$1/libscene.a: $$(call objects,$1,$$(SCENE_SRC))
	$$(archive)

# The command line holds all precisions: each is linked into one object of which only the table
# of functions engine_float, engine_double or engine_far can be seen from outside.
$$(O)/engine_$1.o: $$(call objects,$1,$$(ENGINE_SRC)) $$(O)/$1/libscene.a $$(O)/libplumb$2.a
	@echo "  LD    $$@"
	$$(Q)$$(LD) -r -o $$@.all $$(filter %.o,$$^) --start-group $$(filter %.a,$$^) --end-group
	$$(Q)$$(OBJCOPY) --keep-global-symbol=engine_$1 $$@.all $$@
	@rm -f $$@.all

$$(O)/libplumb$2.a: $$(call lib_objects,$1)
	$$(archive)

$$(O)/libplumb$2.so: $$(call lib_objects,$1)
	@echo "  LD    $$@"
	$$(Q)$$(CC) -shared $$(if $$(ABSENT),-Wl$$(comma)-z$$(comma)defs) $$(SANFLAGS) $$(LDFLAGS) -Wl,-soname,libplumb$2.so.0 -o $$@ $$^ -lm -lpthread
	$$(Q)ln -sf libplumb$2.so $$@.0
endef

define width_rule
$$(O)/$1/src/%.w$2.o: src/%.simd.c $$(O)/flags | $$(DEPS_FIRST)
	@mkdir -p $$(@D)
	@echo "  CC    $$@"
	$$(Q)$$(CC) $$(LIB_FLAGS) $$(DEFS_$1) -DPL_SIMD=$2 $$(if $$(WIDTH_$2_$$(MACHINE)),$$(WIDTH_$2_$$(MACHINE)) $$(WHOLE)) -Wno-psabi -c $$< -o $$@
endef

define archive
@echo "  AR    $@"
@rm -f $@
$(Q)$(AR) rcs $@ $(filter %.o,$^)
endef

$(eval $(call variant_rules,float,))
$(eval $(call variant_rules,double,_d))
$(eval $(call variant_rules,far,_far))
$(foreach w,$(WIDTHS),$(foreach v,$(VARIANTS),$(eval $(call width_rule,$v,$w))))

$(O)/librender.a: $(RENDER_OBJ)
	$(archive)

# Float alone for `make demo` and PRECISION=float; what was once built stays in.
ENGINES := $(filter $(WANTED) float $(patsubst $(O)/engine_%.o,%,$(wildcard $(O)/engine_*.o)),$(VARIANTS))
$(O)/plumb: $(CLI_OBJ) $(ENGINES:%=$(O)/engine_%.o) $(O)/librender.a
	@echo "  LD    $@"
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(SCENE_LIBS) $(RENDER_LIBS) -lm -lpthread

# The one example that wants a window.
$(O)/examples/show: $(O)/float/tools/examples/sdl2/show.o $(O)/libplumb.a
	@mkdir -p $(@D)
	@echo "  LD    $@"
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ -lSDL2 -lm -lpthread

$(O)/examples/%: $(O)/float/tools/examples/%.o $(O)/libplumb.a
	@mkdir -p $(@D)
	@echo "  LD    $@"
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ -lm -lpthread

# The library as one pair of files, written by a program of ours.
AMALGAMATED := $(filter-out src/snapshot/complete.c,$(LIB_SRC)) $(SIMD_SRC)
AMALGAMATE_OBJ := $(call objects,float,$(wildcard tools/amalgamate/*.c))
amalgamation: $(O)/plumb.c
$(O)/plumb.c: $(O)/amalgamate LICENSE $(wildcard include/plumb/*.h src/*/*.h) $(AMALGAMATED)
	@echo "  GEN   $@ $(O)/plumb.h"
	$(Q)$(O)/amalgamate $(O) LICENSE include/plumb/plumb.h $(AMALGAMATED)
$(O)/amalgamate: $(AMALGAMATE_OBJ)
	@echo "  LD    $@"
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^

# For Windows, on Debian: apt-get install gcc-mingw-w64-x86-64-posix. MSVC has no vector extensions.
MINGW ?= x86_64-w64-mingw32-gcc
windows: $(O)/windows/hello.exe
$(O)/windows/hello.exe: $(O)/plumb.c tools/examples/hello.c
	@mkdir -p $(O)/windows/plumb
	$(Q)cp $(O)/plumb.h $(O)/windows/plumb
	$(Q)$(MINGW) -std=c17 -O2 $(WARN) -Wno-conversion -Wno-shadow -static -I$(O)/windows \
		$(O)/plumb.c tools/examples/hello.c -o $@ -lpthread
	@echo "windows: $(abspath $@)"

include tools/make/test.mk
include tools/make/install.mk

ALL_OBJ := $(AMALGAMATE_OBJ) $(CLI_OBJ) $(RENDER_OBJ) \
	$(foreach v,$(VARIANTS),$(call lib_objects,$v) $(call objects,$v,$(SCENE_SRC) $(ENGINE_SRC))) $(TEST_OBJ) \
	$(filter-out %/show.o,$(EXAMPLES:$(O)/%=$(O)/float/tools/%.o)) $(O)/float/tools/examples/sdl2/show.o
.SECONDARY: $(ALL_OBJ)
-include $(ALL_OBJ:.o=.d)
