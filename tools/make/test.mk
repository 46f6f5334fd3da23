# test.mk - tests, benchmark, fuzzing, sanitizers. Included by the Makefile.
#
# A test is tests/<kind>/test_<name>.c or tests/<kind>/test_<name>.sh. What it is linked with follows from
# its name and folder; tests/README.md has the table. Other .c files of the folder are helpers of all its
# tests. `make test` links the tests of a folder into one program, build/tests/unit/all; the runner starts it
# once for every test under that test's name, build/tests/unit/test_<name>, so that a crash is the failure of
# one test. `make test T=...` links the tests that it names alone, and so does what follows a folder that
# could not be linked.

TEST_SRC    := $(sort $(wildcard tests/*/test_*.c))
TEST_SH     := $(sort $(wildcard tests/*/test_*.sh))
FUZZ_SRC    := $(sort $(wildcard tests/fuzz/fuzz_*.c))
BENCH_SRC   := $(wildcard tests/bench/*.c)
HARNESS_SRC := $(filter-out tests/harness/engine_% tests/harness/peer% tests/harness/main.c,$(wildcard tests/harness/*.c))

# Built and run in double precision as well, unless the file says PLUMB_FLOAT_ONLY, or PLUMB_LONG.
DOUBLE_KINDS := unit analytic stability api determinism
DOUBLE_SRC   := $(filter $(DOUBLE_KINDS:%=tests/%/%),$(TEST_SRC))
ifneq ($(DOUBLE_SRC),)
DOUBLE_SRC   := $(filter-out $(shell grep -l PLUMB_FLOAT_ONLY $(DOUBLE_SRC)),$(DOUBLE_SRC))
# What takes long and asks nothing of the precision says PLUMB_LONG: in float always, in the others with TRIALS of 3 and more.
ALL_OF_IT    := $(shell awk 'BEGIN { print ($(or $(TRIALS),1) >= 3) }')
ifeq ($(ALL_OF_IT),0)
DOUBLE_SRC   := $(filter-out $(shell grep -l PLUMB_LONG $(DOUBLE_SRC)),$(DOUBLE_SRC))
endif
endif

# Built and run in the far build. Its solver is that of float, its places are doubles, which have tests of both in the other two:
# what follows closed forms or stays calm there does so here, and is asked with TRIALS of 3 and more, or where it says PLUMB_FAR.
FAR_SRC := $(DOUBLE_SRC)
ifeq ($(ALL_OF_IT),0)
FAR_SRC := $(filter $(patsubst %,tests/%,unit/% api/% determinism/%) $(shell grep -l PLUMB_FAR $(DOUBLE_SRC)),$(DOUBLE_SRC))
endif

TEST_PROGRAMS := $(TEST_SRC:%.c=$(O)/%) $(DOUBLE_SRC:tests/%.c=$(O)/tests-double/%) \
	$(FAR_SRC:tests/%.c=$(O)/tests-far/%) \
	$(FUZZ_SRC:tests/fuzz/%.c=$(O)/tests/fuzz/replay_%)

# ---- building

# $(call helpers,source): the other files of its folder, and harness/X.c where one of them, or the
# test, includes harness/X.h; what X.c itself includes comes along.
HARNESS_USES := $(if $(HARNESS_SRC),$(shell grep -oHE 'harness/[a-z0-9_]+[.]h' tests/*/*.[ch]))
harness_of   = $(sort $(filter $(HARNESS_SRC),$(foreach f,$1,\
	$(patsubst $f:harness/%.h,tests/harness/%.c,$(filter $f:%,$(HARNESS_USES))))))
folder_files = $(filter-out $(dir $1)test_%,$(wildcard $(dir $1)*.[ch]))
helpers = $(filter %.c,$(folder_files)) \
	$(call harness_of,$(call harness_of,$1 $(folder_files)) $1 $(folder_files))
# Scene files are read by tests of these names, pictures drawn by those.
needs_scene  = $(filter test_scene% fuzz_scene%,$(notdir $1))
needs_render = $(filter test_render%,$(notdir $1))

# $(call test_parts,source,float,): objects and archives;  $(call test_libs,source): -l flags
test_parts = $(call objects,$2,$1 $(call helpers,$1)) \
	$(if $(filter tests/crossval/%,$1),$(O)/box2d2.o $(call objects,$2,tests/harness/engine_plumb.c)) \
	$(if $(filter tests/stability/%,$1),$(call objects,$2,tests/harness/engine_plumb.c)) \
	$(if $(call needs_scene,$1),$(O)/$2/libscene.a) \
	$(if $(call needs_render,$1),$(O)/librender.a) $(O)/libplumb$3.a
test_libs = $(if $(filter tests/crossval/%,$1),-lbox2d -lccd) \
	$(if $(call needs_scene,$1),$(SCENE_LIBS)) $(if $(call needs_render,$1),$(RENDER_LIBS)) \
	-lcmocka -lm -lpthread
# Every test has a main; compiled, it bears the name of its file, and is declared. tests/harness/main.c calls it.
OWN_MAIN = '-Dmain(...)=$(notdir $*)(__VA_ARGS__);int $(notdir $*)(__VA_ARGS__)'
# What they spend their time in is the library: without optimisation they compile in a third of the time.
$(foreach v,$(VARIANTS),$(call objects,$v,$(TEST_SRC))): OWN_FLAGS = $(OWN_MAIN) $(if $(filter -O2 -O3,$(CFLAGS)),-O0)
$(foreach v,$(VARIANTS),$(call objects,$v,$(TEST_SRC))): tests/harness/main.c

# $(call link_tests,sources,main's flags): tests/harness/main.c with their names, and what they need.
define link_tests
@mkdir -p $(@D)
@echo "  LD    $@"
$(Q)$(CC) $(COMMON) -Itests $(CFLAGS) '-DTESTS=$(patsubst %.c,TEST(%),$(notdir $1))' -c tests/harness/main.c \
	-o $@.main.o -MF /dev/null
$(Q)rm -f $@
$(Q)$(if $(filter tests/crossval/%,$1),$(CXX),$(CC)) $(SANFLAGS) $(LDFLAGS) -o $@ $@.main.o $(filter-out %/main.c,$^) \
	$(call test_libs,$1)
$(Q)rm -f $@.main.o
endef

# Tests that are linked with the same things are one program: unit/all, unit/all_scene, unit/all_render.
ONE_EACH ?= $(if $(T),1,$(if $(filter test-programs,$(MAKECMDGOALS)),,1))
group_of  = $(dir $1)all$(if $(call needs_render,$1),_render,$(if $(call needs_scene,$1),_scene))

# $(call parts_of,sources,float,): objects before archives, each once
parts_of = $(call in_order,$(sort $(foreach t,$1,$(call test_parts,$t,$2,$3))))
in_order = $(filter %.o,$1) $(filter %/libscene.a,$1) $(filter %/librender.a,$1) $(filter $(O)/libplumb%.a,$1)

# $(call test_rule,source,float,,tests)
define test_rule
$(O)/$4/$(1:tests/%.c=%): $(call parts_of,$1,$2,$3) tests/harness/main.c
	$$(call link_tests,$1)

endef
# $(call group_rule,all,float,,tests,sources)
define group_rule
$(O)/$4/$(1:tests/%=%): $(call parts_of,$5,$2,$3) tests/harness/main.c
	$$(call link_tests,$5)
$(5:tests/%.c=$(O)/$4/%): $(O)/$4/$(1:tests/%=%)
	@ln -sf $$(<F) $$@

endef
# $(call test_rules,sources,float,,tests)
test_rules = $(if $(ONE_EACH),$(foreach t,$1,$(call test_rule,$t,$2,$3,$4)),$(foreach g,$(sort $(foreach t,$1,$(call \
	group_of,$t))),$(call group_rule,$g,$2,$3,$4,$(strip $(foreach t,$1,$(if $(filter $g,$(call group_of,$t)),$t))))))
$(eval $(call test_rules,$(TEST_SRC),float,,tests))
$(eval $(call test_rules,$(DOUBLE_SRC),double,_d,tests-double))
$(eval $(call test_rules,$(FAR_SRC),far,_far,tests-far))

$(O)/box2d2.o: tests/harness/engine_box2d2.cpp $(O)/flags | $(DEPS_FIRST)
	@mkdir -p $(@D)
	@echo "  CXX   $@"
	$(Q)$(CXX) $(CXX_FLAGS) -c $< -o $@

# Box2D 3 has a header folder of the same name as Box2D 2.4.1: only this file sees it.
$(O)/box2d3.o: tests/harness/engine_box2d3.c $(O)/flags | $(DEPS_FIRST)
	@echo "  CC    $@"
	$(Q)$(CC) $(COMMON) $(CFLAGS) -isystem $(BOX2D3)/include -c $< -o $@

BENCH_OBJ := $(call objects,float,$(BENCH_SRC) tests/harness/engine_plumb.c) \
	$(O)/box2d2.o $(if $(BOX2D3),$(O)/box2d3.o)
$(O)/float/tests/bench/%.o: OWN_FLAGS := $(if $(BOX2D3),-DBENCH_BOX2D3)
$(O)/bench: $(BENCH_OBJ) $(O)/libplumb.a
	@echo "  LD    $@"
	$(Q)$(CXX) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(if $(BOX2D3),$(BOX2D3)/lib/libbox2d.a) \
		-lbox2d -lm -lpthread

# What accuracy costs (tests/cost) and what stays stable (tests/referee), beside other engines. A peer is one relocatable
# object, as the variants of the command line are: scene loader and library in double, of which only the tables peer_... can
# be seen.
PEERS    := box2d2 chipmunk $(if $(BOX2D3),box2d3)
COST_CLI := $(call objects,float,$(patsubst %,tools/plumb/%.c,cost cost_track cost_truth cost_ladder cost_front \
	cost_print cost_chart scene_args watch allow output files progress options suggest help))
PEER_OBJ := $(call objects,double,$(wildcard tests/harness/peer*.c))
REFEREE_SRC := $(wildcard tests/referee/*.c)
COST_OBJ := $(call objects,float,tests/cost/suite.c tests/cost/sizes.c tests/harness/engine_chipmunk.c $(REFEREE_SRC)) $(PEER_OBJ) \
	$(O)/double/tests/cost/frozen.o
$(O)/float/tests/cost/%.o $(O)/float/tests/referee/%.o $(PEER_OBJ): OWN_FLAGS := $(if $(BOX2D3),-DPEER_BOX2D3)
$(O)/engine_peer.o: $(PEER_OBJ) $(call objects,double,$(ENGINE_SRC)) $(O)/double/libscene.a \
		$(O)/libplumb_d.a
	@echo "  LD    $@"
	$(Q)$(LD) -r -o $@.all $(filter %.o,$^) --start-group $(filter %.a,$^) --end-group
	$(Q)$(OBJCOPY) $(PEERS:%=--keep-global-symbol=peer_%) $@.all $@
	@rm -f $@.all
SUITE_PARTS := $(call objects,float,tests/harness/engine_chipmunk.c tests/harness/interrupt.c) $(COST_CLI) $(VARIANTS:%=$(O)/engine_%.o) \
	$(O)/engine_peer.o $(O)/box2d2.o $(if $(BOX2D3),$(O)/box2d3.o) $(O)/librender.a
$(O)/cost-suite: $(call objects,float,tests/cost/suite.c) $(SUITE_PARTS)
$(O)/referee: $(call objects,float,$(REFEREE_SRC)) $(SUITE_PARTS)
$(O)/cost-suite $(O)/referee:
	@echo "  LD    $@"
	$(Q)$(CXX) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(if $(BOX2D3),$(BOX2D3)/lib/libbox2d.a) -lbox2d -lchipmunk \
		$(SCENE_LIBS) $(RENDER_LIBS) -lm -lpthread

# Contact problems out of scenes, each solver against their exact answer.
$(O)/cost-frozen: $(O)/double/tests/cost/frozen.o $(call objects,float,tests/harness/interrupt.c) $(COST_CLI) $(O)/double/libscene.a $(O)/libplumb_d.a
	@echo "  LD    $@"
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(SCENE_LIBS) -lm -lpthread

# How the exact solver's time grows with an island.
$(O)/cost-sizes: $(call objects,float,tests/cost/sizes.c tests/harness/sim.c) $(O)/libplumb.a
	@echo "  LD    $@"
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ -lm -lpthread

# Shots at thin walls, beside Box2D: tests/shots.
$(O)/shots: $(call objects,float,tests/shots/table.c tests/harness/shots.c \
		tests/harness/engine_plumb.c) $(O)/box2d2.o $(O)/libplumb.a
	@echo "  LD    $@"
	$(Q)$(CXX) $(SANFLAGS) $(LDFLAGS) -o $@ $^ -lbox2d -lm -lpthread

# A busy world for a million steps, twice at once: tests/soak.
$(O)/soak: $(call objects,float,tests/soak/table.c tests/harness/soak.c) $(O)/libplumb.a
	@echo "  LD    $@"
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ -lm -lpthread

# A fuzz harness twice: with a main that goes through its seeds, and with libFuzzer.
define fuzz_rule
$(O)/tests/fuzz/$3: $(call objects,float,$1 $2) $(O)/float/libscene.a $(O)/libplumb.a
	@mkdir -p $$(@D)
	@echo "  LD    $$@"
	$$(Q)$$(CC) $$(SANFLAGS) $4 $$(LDFLAGS) -o $$@ $$^ $(SCENE_LIBS) -lm -lpthread
endef
$(foreach f,$(FUZZ_SRC),$(eval $(call fuzz_rule,$f,tests/fuzz/replay_main.c,replay_$(notdir $(f:.c=)))))
$(foreach f,$(FUZZ_SRC),$(eval $(call fuzz_rule,$f,,$(notdir $(f:.c=)),-fsanitize=fuzzer)))

TEST_OBJ := $(sort $(call objects,float,$(TEST_SRC) $(FUZZ_SRC) $(BENCH_SRC) $(HARNESS_SRC)) \
	$(foreach t,$(TEST_SRC),$(filter %.o,$(call test_parts,$t,float,))) \
	$(foreach t,$(DOUBLE_SRC),$(filter %.o,$(call test_parts,$t,double,_d))) \
	$(foreach t,$(FAR_SRC),$(filter %.o,$(call test_parts,$t,far,_far))) \
	$(O)/float/tests/fuzz/replay_main.o $(COST_OBJ) $(O)/box2d2.o $(O)/box2d3.o)

# ---- running

.PHONY: test test-programs stability shots soak bench effects cost determinism hashes asan ubsan tsan sanitized fuzz fuzz-run lint headers \
	format format-check

# T names the tests to run by their sources; without it, all of them.
T ?=
ifeq ($(T),)
RUN_PROGRAMS := $(TEST_PROGRAMS)
RUN_SH       := $(TEST_SH)
else
RUN_PROGRAMS := $(filter $(T:tests/%.c=$(O)/tests/%) $(T:tests/%.c=$(O)/tests-double/%) \
	$(T:tests/%.c=$(O)/tests-far/%) $(T:tests/fuzz/%.c=$(O)/tests/fuzz/replay_%),$(TEST_PROGRAMS))
RUN_SH       := $(filter $(T),$(TEST_SH))
endif

test-programs: $(RUN_PROGRAMS) $(O)/plumb lib examples $(if $(filter %/test_cost_suite.sh,$(RUN_SH)),$(O)/cost-suite $(O)/cost-frozen $(O)/cost-sizes) \
	$(if $(filter %/test_referee.sh,$(RUN_SH)),$(O)/referee)

# What does not build must not hide what does: every test is still run, those that have no up to date
# program count as failed, and the last line is the sum of the whole run. Scripts first: the longest of all are among them, and
# what ends last should be short. One more at a time than there are cores, for some of them wait.
test: | $(DEPS_FIRST)
	@$(MAKE) --no-print-directory -k test-programs || \
		$(MAKE) --no-print-directory -k ONE_EACH=1 test-programs || { \
		echo "test: the build failed; what could not be built counts as failed" >&2; \
		for p in $(RUN_PROGRAMS) $(O)/plumb $(O)/cost-suite $(O)/referee; do \
			$(MAKE) -q $$p >/dev/null 2>&1 || rm -f $$p; \
		done; }
	@O=$(O) SAN=$(SAN) bash tests/run.sh -j $(if $(filter-out 1,$(JOBS)),$$(($(JOBS) + 1)),1) -l $(O)/test-logs $(RUN_SH) $(RUN_PROGRAMS)

STABILITY := $(wildcard tests/stability/test_*)
SCENES ?= $(sort $(wildcard assets/scenes/*.lua))
HARD   ?= $(sort $(wildcard assets/scenes/hard/*.lua))
stability: $(O)/plumb $(O)/referee
	$(if $(STABILITY),@$(MAKE) --no-print-directory test T="$(STABILITY)")
	$(Q)$(O)/plumb check $(SCENES)
	$(Q)$(O)/referee --folder $(O)/referee-out --jobs $(JOBS) --sweeps tests/referee $(REFEREE) $(HARD)

SHOTS ?= 100000
shots: $(O)/shots
	$(O)/shots $(SHOTS)

# Instructions, not time: anything else may run beside it.
effects:
	@O=$(O) CC=$(CC) bash tests/effects/run.sh

# SOAK="1000000 2": so many steps, a seed.
SOAK ?= 1000000
soak: $(O)/soak
	$(O)/soak $(SOAK)

bench: $(O)/bench
	$(O)/bench $(BENCH)

# Alone on the machine: COST="--budget 0.05" or other arguments, COST_SCENES="a.lua b.lua".
COST_SCENES ?= $(sort $(wildcard assets/scenes/accuracy/*.lua))
FROZEN_SCENES ?= $(sort $(wildcard assets/scenes/*.lua assets/scenes/hard/*.lua))
cost: $(O)/cost-suite $(O)/cost-frozen $(O)/cost-sizes
	$(O)/cost-suite --folder $(O)/cost $(COST) $(COST_SCENES)
	$(O)/cost-frozen --folder $(O)/cost $(FROZEN_SCENES)
	$(O)/cost-sizes | tee $(O)/cost/sizes.md

# The matrix of compilers, optimisation levels, a sanitizer, widths, solvers. See the script.
determinism:
	@O=$(O) JOBS=$(JOBS) bash tools/make/determinism.sh

# Writes the committed hashes anew: after every change that is meant to change what bodies do.
HASH_PROGRAMS := $(foreach d,tests tests-double tests-far,$(O)/$d/determinism/test_scene_hashes)
hashes: $(HASH_PROGRAMS)
	$(Q)echo "# Written by \`make hashes\`: precision, solver, scene, steps, plumb_world_hash." >$(O)/hashes
	$(Q)for p in $(HASH_PROGRAMS); do $$p --print >>$(O)/hashes || exit 1; done
	$(Q)mv $(O)/hashes tests/determinism/hashes.txt
	@echo "hashes: tests/determinism/hashes.txt is written"

# Sanitizers build apart, so that they and the ordinary build do not undo one another.
asan:  ; @$(MAKE) --no-print-directory O=$(O)/asan  SAN=address   CFLAGS="-O1" test
# GCC's `undefined` leaves out a float that does not fit its integer; clang's has it.
ubsan: ; @$(MAKE) --no-print-directory O=$(O)/ubsan SAN=undefined,float-cast-overflow CFLAGS="-O1" test
tsan:  ; @$(MAKE) --no-print-directory O=$(O)/tsan  SAN=thread    CFLAGS="-O1" test

# Half of libFuzzer's time went into its entropic schedule: these inputs differ little in how rare their branches are.
# New findings are left in $(O)/fuzz/found; once mended they belong to tests/fuzz/seeds/<name>.
FUZZ_TIME ?= 60
FUZZ_BIN  := $(FUZZ_SRC:tests/fuzz/%.c=$(O)/tests/fuzz/%)
fuzz:
	@$(MAKE) --no-print-directory O=$(O)/fuzz CC=clang CXX=clang++ SAN=address,undefined FUZZ=1 \
		CFLAGS="-O2" fuzz-run
fuzz-run: $(FUZZ_BIN)
	@set -e; for f in $(FUZZ_BIN); do \
		name=$${f##*/fuzz_}; mkdir -p $(O)/corpus/$$name $(O)/found; \
		echo "fuzz: $$name for $(FUZZ_TIME) s"; \
		$$f -max_total_time=$(FUZZ_TIME) -entropic=0 -artifact_prefix=$(O)/found/$$name- -print_final_stats=1 \
			$(O)/corpus/$$name $$(ls -d tests/fuzz/seeds/$$name 2>/dev/null); \
	done

# ---- the text itself

FORMATTED := $(wildcard include/plumb/*.h src/*/*.[ch] tools/*/*.[ch] tests/*/*.[ch] tests/*/*.cpp)
# Other versions lay some lines out otherwise: Debian 13 has 19.
FORMATTER := 14
find_formatter = f=$$(command -v clang-format-$(FORMATTER) || command -v clang-format); \
	v=$$($${f:-false} --version 2>/dev/null | sed 's/.*version \([0-9]*\).*/\1/'); \
	if [ "$$v" != $(FORMATTER) ]; then echo "$@: skipped: needs clang-format $(FORMATTER), here is $${v:-none}"; exit 0; fi
format:
	@$(find_formatter); $$f -i $(FORMATTED)
format-check:
	@$(find_formatter); $$f --dry-run -Werror $(FORMATTED)
lint: lib
	@O=$(O) bash tools/lint/lint.sh
headers: $(O)/libplumb.a
	@O=$(O) bash tools/lint/headers.sh
