# install.mk - `make install`: headers, libraries, plumb.pc, CMake package, command line and its completion.
# Included by the Makefile. Templates are in tools/install.

VERSION := $(shell sed -n 's/^\#define PLUMB_VERSION  *"\(.*\)"/\1/p' include/plumb/base.h)

.PHONY: install install-lib uninstall

BINDIR     := $(PREFIX)/bin
LIBDIR     := $(PREFIX)/lib
INCLUDEDIR := $(PREFIX)/include
PKGDIR     := $(LIBDIR)/pkgconfig
CMAKEDIR   := $(LIBDIR)/cmake/plumb
BASHDIR    := $(PREFIX)/share/bash-completion/completions

fill = sed -e 's|@PREFIX@|$(PREFIX)|g' -e 's|@VERSION@|$(VERSION)|g' -e 's|@SUFFIX@|$1|g' \
	-e 's|@DEFINES@|$2|g' -e 's|@PRECISION@|$3|g'

install-lib: $(LIBRARIES)
	install -d $(addprefix $(DESTDIR),$(INCLUDEDIR)/plumb $(PKGDIR) $(CMAKEDIR))
	install -m 644 include/plumb/*.h $(DESTDIR)$(INCLUDEDIR)/plumb
	install -m 644 $(O)/libplumb.a $(O)/libplumb_d.a $(O)/libplumb_far.a $(DESTDIR)$(LIBDIR)
	set -e; for lib in libplumb libplumb_d libplumb_far; do \
		install -m 755 $(O)/$$lib.so $(DESTDIR)$(LIBDIR)/$$lib.so.$(VERSION); \
		ln -sf $$lib.so.$(VERSION) $(DESTDIR)$(LIBDIR)/$$lib.so.0; \
		ln -sf $$lib.so.0 $(DESTDIR)$(LIBDIR)/$$lib.so; \
	done
	$(call fill,,,float) tools/install/plumb.pc.in >$(DESTDIR)$(PKGDIR)/plumb.pc
	$(call fill,_d,-DPLUMB_DOUBLE=1,double) tools/install/plumb.pc.in >$(DESTDIR)$(PKGDIR)/plumb_d.pc
	$(call fill,_far,-DPLUMB_FAR=1,far) tools/install/plumb.pc.in >$(DESTDIR)$(PKGDIR)/plumb_far.pc
	$(call fill) tools/install/plumb-config.cmake.in >$(DESTDIR)$(CMAKEDIR)/plumb-config.cmake
	$(call fill) tools/install/plumb-config-version.cmake.in \
		>$(DESTDIR)$(CMAKEDIR)/plumb-config-version.cmake

install: install-lib $(O)/plumb
	install -d $(DESTDIR)$(BINDIR) $(DESTDIR)$(BASHDIR)
	install -m 755 $(O)/plumb $(DESTDIR)$(BINDIR)/plumb
	install -m 644 tools/plumb/plumb.bash-completion $(DESTDIR)$(BASHDIR)/plumb

uninstall:
	rm -rf $(addprefix $(DESTDIR),$(INCLUDEDIR)/plumb $(CMAKEDIR) $(PKGDIR)/plumb.pc \
		$(PKGDIR)/plumb_d.pc $(PKGDIR)/plumb_far.pc $(BINDIR)/plumb $(BASHDIR)/plumb)
	rm -f $(foreach l,libplumb libplumb_d libplumb_far,$(DESTDIR)$(LIBDIR)/$l.a $(DESTDIR)$(LIBDIR)/$l.so*)
