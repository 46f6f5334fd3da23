# install.mk - `make install`: headers, libraries, plumb.pc, CMake package, command line with manual and completion,
# scenes, examples. PRECISION=float (double, far, or several) installs these alone.
# Included by the Makefile. Templates are in tools/install.

VERSION := $(shell sed -n 's/^\#define PLUMB_VERSION  *"\(.*\)"/\1/p' include/plumb/base.h)

.PHONY: install install-lib uninstall

BINDIR     := $(PREFIX)/bin
LIBDIR     := $(PREFIX)/lib
INCLUDEDIR := $(PREFIX)/include
PKGDIR     := $(LIBDIR)/pkgconfig
CMAKEDIR   := $(LIBDIR)/cmake/plumb
BASHDIR    := $(PREFIX)/share/bash-completion/completions
MANDIR     := $(PREFIX)/share/man/man1
DOCDIR     := $(PREFIX)/share/doc/plumb
SHAREDIR   := $(PREFIX)/share/plumb

fill = sed -e 's|@PREFIX@|$(PREFIX)|g' -e 's|@VERSION@|$(VERSION)|g' -e 's|@SUFFIX@|$1|g' \
	-e 's|@DEFINES@|$2|g' -e 's|@PRECISION@|$3|g'

# $(call install_one,float,,defines): library and package (plumb, plumb_d, plumb_far) of one precision.
define install_one
install -m 644 $(O)/libplumb$2.a $(DESTDIR)$(LIBDIR)
install -m 755 $(O)/libplumb$2.so $(DESTDIR)$(LIBDIR)/libplumb$2.so.$(VERSION)
ln -sf libplumb$2.so.$(VERSION) $(DESTDIR)$(LIBDIR)/libplumb$2.so.0
ln -sf libplumb$2.so.0 $(DESTDIR)$(LIBDIR)/libplumb$2.so
$(call fill,$2,$3,$1) tools/install/plumb.pc.in >$(DESTDIR)$(PKGDIR)/plumb$2.pc

endef

install-lib: lib
	install -d $(addprefix $(DESTDIR),$(INCLUDEDIR)/plumb $(PKGDIR) $(CMAKEDIR) $(DOCDIR))
	install -m 644 include/plumb/*.h $(DESTDIR)$(INCLUDEDIR)/plumb
	install -m 644 include/plumb/README.md $(DESTDIR)$(DOCDIR)/library.md
	install -m 644 LICENSE $(DESTDIR)$(DOCDIR)
	$(foreach p,$(WANTED),$(call install_one,$p,$(SUFFIX_$p),$(DEFS_$p)))
	$(call fill) tools/install/plumb-config.cmake.in >$(DESTDIR)$(CMAKEDIR)/plumb-config.cmake
	$(call fill) tools/install/plumb-config-version.cmake.in \
		>$(DESTDIR)$(CMAKEDIR)/plumb-config-version.cmake

# The manual is what the command line says of itself.
$(O)/plumb.1: $(O)/plumb
	@echo "  GEN   $@"
	$(Q)$(O)/plumb help --man >$@

SCENE_FOLDERS := assets/scenes $(patsubst %/,%,$(wildcard assets/scenes/*/))
install: install-lib $(O)/plumb $(O)/plumb.1
	install -d $(addprefix $(DESTDIR),$(BINDIR) $(BASHDIR) $(MANDIR) $(SHAREDIR)/examples/sdl2 \
		$(SCENE_FOLDERS:assets/%=$(SHAREDIR)/%))
	install -m 755 $(O)/plumb $(DESTDIR)$(BINDIR)/plumb
	install -m 644 tools/plumb/plumb.bash-completion $(DESTDIR)$(BASHDIR)/plumb
	install -m 644 $(O)/plumb.1 $(DESTDIR)$(MANDIR)
	install -m 644 README.md $(DESTDIR)$(DOCDIR)
	install -m 644 tools/plumb/README.md $(DESTDIR)$(DOCDIR)/command-line.md
	install -m 644 tools/scene/README.md $(DESTDIR)$(DOCDIR)/scenes.md
	for d in $(SCENE_FOLDERS); do install -m 644 $$d/*.* $(DESTDIR)$(SHAREDIR)/$${d#assets/} || exit 1; done
	install -m 644 tools/examples/*.c $(DESTDIR)$(SHAREDIR)/examples
	install -m 644 tools/examples/sdl2/*.c $(DESTDIR)$(SHAREDIR)/examples/sdl2

# All precisions, whichever were installed; below DESTDIR also folders that are left empty.
UNINSTALLED = $(addprefix $(DESTDIR),$(BINDIR) $(PKGDIR) $(LIBDIR)/cmake $(INCLUDEDIR) $(BASHDIR) $(MANDIR) \
	$(PREFIX)/share/doc)
uninstall:
	rm -rf $(addprefix $(DESTDIR),$(INCLUDEDIR)/plumb $(CMAKEDIR) $(DOCDIR) $(SHAREDIR))
	rm -f $(addprefix $(DESTDIR),$(BINDIR)/plumb $(BASHDIR)/plumb $(MANDIR)/plumb.1)
	rm -f $(foreach v,$(VARIANTS),$(DESTDIR)$(PKGDIR)/plumb$(SUFFIX_$v).pc \
		$(DESTDIR)$(LIBDIR)/libplumb$(SUFFIX_$v).a $(DESTDIR)$(LIBDIR)/libplumb$(SUFFIX_$v).so*)
	$(if $(DESTDIR),for d in $(UNINSTALLED); do rmdir -p --ignore-fail-on-non-empty $$d 2>/dev/null || true; done)
