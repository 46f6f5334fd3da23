# effects.mk - which effects are in the library: EFFECTS="gravity friction", "all -liquid", "none". Included by the Makefile.
# The list, with what each needs and which files are its own: src/schema/effects.h.

EFFECTS ?= all

# name=NAME=-,needs=-,files, a word a row
EFFECT_ROWS := $(shell tr -d '\\\n' <src/schema/effects.h | sed 's/"  *"//g; s/ X./\n/g' | sed -n \
	's/^\([A-Z_]*\), *"\([a-z_]*\)", *"\([^"]*\)", *"\([^"]*\)".*/\2=\1=-,\3=-,\4/p' | tr ' ' ',')
comma := ,
# $(call effect_part,row,2): a part as words
effect_part = $(filter-out -,$(subst $(comma), ,$(word $2,$(subst =, ,$1))))
ALL_EFFECTS := $(foreach r,$(EFFECT_ROWS),$(call effect_part,$r,1))

PRESENT := $(filter-out $(patsubst -%,%,$(filter -%,$(EFFECTS))),\
	$(if $(filter all,$(EFFECTS)),$(ALL_EFFECTS),$(filter-out -% none,$(EFFECTS))))
ifneq ($(or $(filter-out $(ALL_EFFECTS) all none,$(EFFECTS:-%=%)),$(if $(strip $(EFFECTS)),,x)),)
$(error EFFECTS is '$(EFFECTS)'; it must be all, none, or some of: $(ALL_EFFECTS); "all -liquid" leaves one out)
endif
ABSENT := $(foreach r,$(EFFECT_ROWS),$(if $(filter $(PRESENT),$(call effect_part,$r,1)),,$r))
$(foreach r,$(filter-out $(ABSENT),$(EFFECT_ROWS)),$(foreach n,$(filter-out $(PRESENT),$(call effect_part,$r,3)),\
	$(error EFFECTS has '$(call effect_part,$r,1)', which needs '$n', which it has not)))

EFFECT_DEFS := $(foreach r,$(ABSENT),-DPL_WITHOUT_$(call effect_part,$r,2))
LEFT_OUT    := $(foreach r,$(ABSENT),$(call effect_part,$r,4))
