# `make install`, `make uninstall`: a part of the Makefile. PREFIX is where the files are used, DESTDIR a packager's staging folder.

PREFIX ?= /usr/local
override PREFIX := $(abspath $(PREFIX))
DESTDIR ?=
INSTALL ?= install
OBJCOPY ?= objcopy

VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
# The soname has the version of the ABI that broke last, and changes when it breaks again: build.rs links with it.
SONAME := libcontact_normal.so.2
REALNAME := libcontact_normal.so.$(VERSION)

# Where the built libraries are: a packager (or a test) may have them elsewhere.
LIBDIR_BUILT ?= $(or $(CARGO_TARGET_DIR),target)/release
# And the program that reads dumps.
REPLAY_BUILT ?= $(LIBDIR_BUILT)/contact-normal-replay
# What the static library needs of the system, as `cargo rustc --release --lib --crate-type staticlib -- --print
# native-static-libs` says, with the static unwinder of gcc in place of the shared one, so that `cc -static` works, too.
STATIC_LIBS := -lgcc_eh -lutil -lrt -lpthread -lm -ldl -lc

INCLUDEDIR := $(DESTDIR)$(PREFIX)/include
LIBDIR := $(DESTDIR)$(PREFIX)/lib
BINDIR := $(DESTDIR)$(PREFIX)/bin
SHAREDIR := $(DESTDIR)$(PREFIX)/share/contact-normal
MODULE := contact_normal.f90 $(notdir $(wildcard include/*.inc))
HEADERS := contact_normal.h $(notdir $(wildcard include/*.hpp)) $(MODULE)

# $(call filled,template,file): a template of packaging/ with its names filled in.
filled = sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@VERSION@|$(VERSION)|' -e 's|@SONAME@|$(SONAME)|' \
	-e 's|@STATIC_LIBS@|$(STATIC_LIBS)|' packaging/$(1).in > $(2)/$(1)

.PHONY: install uninstall

install:
	@test -e $(LIBDIR_BUILT)/libcontact_normal.so -a -e $(LIBDIR_BUILT)/libcontact_normal.a -a -e $(REPLAY_BUILT) || $(MAKE) all
	$(INSTALL) -d $(INCLUDEDIR) $(BINDIR) $(LIBDIR)/.debug $(LIBDIR)/pkgconfig $(LIBDIR)/cmake/contact-normal $(SHAREDIR)/include
	$(INSTALL) -m 644 $(addprefix include/,$(HEADERS)) $(INCLUDEDIR)
	# The shared library; debuggers find its debug information in .debug.
	$(OBJCOPY) --only-keep-debug $(LIBDIR_BUILT)/libcontact_normal.so $(LIBDIR)/.debug/$(REALNAME).debug
	$(OBJCOPY) --strip-unneeded --add-gnu-debuglink=$(LIBDIR)/.debug/$(REALNAME).debug \
		$(LIBDIR_BUILT)/libcontact_normal.so $(LIBDIR)/$(REALNAME)
	chmod 755 $(LIBDIR)/$(REALNAME)
	chmod 644 $(LIBDIR)/.debug/$(REALNAME).debug
	ln -sfn $(REALNAME) $(LIBDIR)/$(SONAME)
	ln -sfn $(SONAME) $(LIBDIR)/libcontact_normal.so
	# The static library without debug information and without rustc's bitcode, most of its size.
	$(OBJCOPY) --strip-debug --remove-section=.llvmbc --remove-section=.llvmcmd \
		$(LIBDIR_BUILT)/libcontact_normal.a $(LIBDIR)/libcontact_normal.a
	chmod 644 $(LIBDIR)/libcontact_normal.a
	$(OBJCOPY) --strip-debug $(REPLAY_BUILT) $(BINDIR)/contact-normal-replay
	chmod 755 $(BINDIR)/contact-normal-replay
	@$(call filled,contact-normal.pc,$(LIBDIR)/pkgconfig)
	@$(call filled,contact-normal-shared.pc,$(LIBDIR)/pkgconfig)
	@$(call filled,contact-normal-config.cmake,$(LIBDIR)/cmake/contact-normal)
	@$(call filled,contact-normal-config-version.cmake,$(LIBDIR)/cmake/contact-normal)
	# The Fortran module as a package of fpm, and the licences.
	$(INSTALL) -m 644 fpm.toml LICENSE-MIT LICENSE-APACHE THIRD_PARTY_NOTICES $(SHAREDIR)
	$(INSTALL) -m 644 $(addprefix include/,$(MODULE)) $(SHAREDIR)/include

# What `make install` of this version with the same PREFIX and DESTDIR has written.
uninstall:
	rm -f $(addprefix $(INCLUDEDIR)/,$(HEADERS))
	rm -f $(LIBDIR)/$(REALNAME) $(LIBDIR)/$(SONAME) $(LIBDIR)/libcontact_normal.so $(LIBDIR)/libcontact_normal.a
	rm -f $(BINDIR)/contact-normal-replay
	rm -f $(LIBDIR)/.debug/$(REALNAME).debug $(LIBDIR)/pkgconfig/contact-normal.pc $(LIBDIR)/pkgconfig/contact-normal-shared.pc
	rm -rf $(LIBDIR)/cmake/contact-normal $(SHAREDIR)
	rmdir --ignore-fail-on-non-empty $(LIBDIR)/.debug $(LIBDIR)/pkgconfig $(LIBDIR)/cmake
