# `make install`, `make uninstall`: a part of the Makefile. PREFIX is where the files are used, DESTDIR a packager's staging folder.

PREFIX ?= /usr/local
override PREFIX := $(abspath $(PREFIX))
# Debian's packagers want lib/<machine>-linux-gnu, others lib64.
LIBDIR ?=
override LIBDIR := $(abspath $(or $(LIBDIR),$(PREFIX)/lib))
DESTDIR ?=
INSTALL ?= install
OBJCOPY ?= objcopy
# STRIPPED=no leaves debug information in the libraries, for packagers' tools that take it out. DEBUGDIR=/usr/lib/debug keeps that of the
# shared library there, where debuggers look for it.
STRIPPED ?= yes
DEBUGDIR ?=
# RELOCATABLE=yes: pkg-config finds the files where they are, for archives that are unpacked anywhere.
RELOCATABLE ?=

VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)

# The target of Rust that the library is built for: empty for this machine.
TARGET ?=
# The profile of cargo that it is built in.
PROFILE := release
# Its system: linux, macos, or windows (by MinGW-w64).
ifneq ($(findstring windows,$(TARGET))$(and $(if $(TARGET),,here),$(filter Windows_NT,$(OS))),)
SYSTEM := windows
else ifneq ($(findstring darwin,$(TARGET))$(and $(if $(TARGET),,here),$(filter Darwin,$(shell uname -s))),)
SYSTEM := macos
else
SYSTEM := linux
endif

# BUILT: what cargo calls the library. SONAME has the version of the ABI that broke last, and changes when it breaks again: build.rs links
# with it. STATIC_LIBS: what the static library needs of the system, as `cargo rustc --release --lib --crate-type staticlib -- --print
# native-static-libs` says; on Linux with the static unwinder of gcc in place of the shared one, so that `cc -static` works, too.
# SHARED_LIBS leave the shared library out of programs that have all from the static one.
ifeq ($(SYSTEM),linux)
BUILT := libcontact_normal.so
SONAME := libcontact_normal.so.2
REALNAME := libcontact_normal.so.$(VERSION)
IMPORTED_SONAME := $(SONAME)
STATIC_LIBS := -lgcc_eh -lutil -lrt -lpthread -lm -ldl -lc
SHARED_LIBS := -Wl,--push-state,--as-needed -lcontact_normal -Wl,--pop-state
LOADER_PATH := LD_LIBRARY_PATH
STRIP_SHARED = $(OBJCOPY) --strip-unneeded
# Without rustc's bitcode, most of its size.
STRIP_STATIC = $(OBJCOPY) --strip-debug --remove-section=.llvmbc --remove-section=.llvmcmd
STRIP_PROGRAM = $(OBJCOPY) --strip-debug
else ifeq ($(SYSTEM),macos)
BUILT := libcontact_normal.dylib
SONAME := libcontact_normal.2.dylib
REALNAME := libcontact_normal.$(VERSION).dylib
IMPORTED_SONAME := @rpath/$(SONAME)
STATIC_LIBS := -lSystem -lc -lm
SHARED_LIBS := -Wl,-dead_strip_dylibs -lcontact_normal
LOADER_PATH := DYLD_LIBRARY_PATH
# Debug information is not in the library; without strip its signature stays valid.
STRIP_SHARED = cp
STRIP_STATIC = cp
STRIP_PROGRAM = cp
else
BUILT := contact_normal.dll
# A DLL has one name.
SONAME := contact_normal.dll
REALNAME := contact_normal.dll
IMPORTED_SONAME := $(SONAME)
IMPORT_LIBRARY := libcontact_normal.dll.a
STATIC_LIBS := -lkernel32 -lntdll -luserenv -lws2_32 -ldbghelp
SHARED_LIBS := -lcontact_normal
LOADER_PATH := PATH
EXE := .exe
STRIP_SHARED = $(OBJCOPY) --strip-unneeded
STRIP_STATIC = $(OBJCOPY) --strip-debug --remove-section=.llvmbc --remove-section=.llvmcmd
STRIP_PROGRAM = $(OBJCOPY) --strip-debug
endif

ifneq ($(and $(DEBUGDIR),$(filter macos,$(SYSTEM))),)
$(error DEBUGDIR: on macOS the debug information is not in the library; dsymutil makes a folder of it)
endif

ifneq ($(STRIPPED),yes)
STRIP_SHARED = cp
STRIP_STATIC = cp
STRIP_PROGRAM = cp
endif

# Where the built libraries are: a packager (or a test) may have them elsewhere.
LIBDIR_BUILT ?= $(or $(CARGO_TARGET_DIR),target)$(addprefix /,$(TARGET))/$(PROFILE)
SHARED_BUILT ?= $(LIBDIR_BUILT)/$(BUILT)
# And the program that reads dumps.
REPLAY_BUILT ?= $(LIBDIR_BUILT)/contact-normal-replay$(EXE)

to_include := $(DESTDIR)$(PREFIX)/include
to_lib := $(DESTDIR)$(LIBDIR)
to_bin := $(DESTDIR)$(PREFIX)/bin
to_share := $(DESTDIR)$(PREFIX)/share/contact-normal
to_debug := $(if $(DEBUGDIR),$(DESTDIR)$(DEBUGDIR)$(LIBDIR))
# Windows finds DLLs beside programs.
to_shared := $(if $(filter windows,$(SYSTEM)),$(to_bin),$(to_lib))
MODULE := contact_normal.f90 $(notdir $(wildcard include/*.inc))
HEADERS := contact_normal.h $(notdir $(wildcard include/*.hpp)) $(MODULE)
LINKS := $(filter-out $(REALNAME),$(SONAME) $(if $(filter-out windows,$(SYSTEM)),$(BUILT)))

# The files for pkg-config and CMake have LIBDIR relative to the prefix if it is below it, so that an installation can be moved.
below := $(patsubst $(PREFIX)/%,%,$(filter $(PREFIX)/%,$(LIBDIR)))
ifneq ($(and $(RELOCATABLE),$(if $(below),,elsewhere)),)
$(error RELOCATABLE: LIBDIR is $(LIBDIR), and only a folder below PREFIX, $(PREFIX), moves with it)
endif
empty :=
up := $(subst $(empty) $(empty),/,$(foreach folder,$(subst /, ,$(below)),..))
PC_PREFIX := $(if $(RELOCATABLE),$${pcfiledir}/../$(up),$(PREFIX))
PC_LIBDIR := $(if $(below),$${prefix}/$(below),$(LIBDIR))
CMAKE_PREFIX := $(if $(below),$${CMAKE_CURRENT_LIST_DIR}/../../$(up),$(PREFIX))

# $(call filled,template,folder): a template of packaging/ with its names filled in.
filled = sed -e 's|@PREFIX@|$(PC_PREFIX)|' -e 's|@LIBDIR@|$(PC_LIBDIR)|' -e 's|@CMAKE_PREFIX@|$(CMAKE_PREFIX)|' -e 's|@VERSION@|$(VERSION)|' \
	-e 's|@SONAME@|$(IMPORTED_SONAME)|' -e 's|@BUILT@|$(BUILT)|' -e 's|@STATIC_LIBS@|$(STATIC_LIBS)|' \
	-e 's|@SHARED_LIBS@|$(SHARED_LIBS)|' packaging/$(1).in > $(2)/$(1)

.PHONY: install uninstall

install:
	@test -e $(SHARED_BUILT) -a -e $(LIBDIR_BUILT)/libcontact_normal.a -a -e $(REPLAY_BUILT) || $(MAKE) all
	$(INSTALL) -d $(to_include) $(to_bin) $(to_lib)/pkgconfig $(to_lib)/cmake/contact-normal $(to_share)/include $(to_debug)
	$(INSTALL) -m 644 $(addprefix include/,$(HEADERS)) $(to_include)
	# The shared library, under its full name, and links of its other names.
ifneq ($(to_debug),)
	$(OBJCOPY) --only-keep-debug $(SHARED_BUILT) $(to_debug)/$(REALNAME).debug
	chmod 644 $(to_debug)/$(REALNAME).debug
endif
	$(STRIP_SHARED) $(SHARED_BUILT) $(to_shared)/$(REALNAME)
ifneq ($(to_debug),)
	$(OBJCOPY) --add-gnu-debuglink=$(to_debug)/$(REALNAME).debug $(to_shared)/$(REALNAME)
endif
	chmod 755 $(to_shared)/$(REALNAME)
	@for link in $(LINKS); do ln -sfn $(REALNAME) $(to_shared)/$$link || exit 1; done
ifdef IMPORT_LIBRARY
	$(INSTALL) -m 644 $(LIBDIR_BUILT)/$(IMPORT_LIBRARY) $(to_lib)
endif
	$(STRIP_STATIC) $(LIBDIR_BUILT)/libcontact_normal.a $(to_lib)/libcontact_normal.a
	chmod 644 $(to_lib)/libcontact_normal.a
	$(STRIP_PROGRAM) $(REPLAY_BUILT) $(to_bin)/contact-normal-replay$(EXE)
	chmod 755 $(to_bin)/contact-normal-replay$(EXE)
	@$(call filled,contact-normal.pc,$(to_lib)/pkgconfig)
	@$(call filled,contact-normal-shared.pc,$(to_lib)/pkgconfig)
	@$(call filled,contact-normal-config.cmake,$(to_lib)/cmake/contact-normal)
	@$(call filled,contact-normal-config-version.cmake,$(to_lib)/cmake/contact-normal)
	# The Fortran module as a package of fpm, and the licences.
	$(INSTALL) -m 644 fpm.toml LICENSE-MIT LICENSE-APACHE THIRD_PARTY_NOTICES $(to_share)
	$(INSTALL) -m 644 $(addprefix include/,$(MODULE)) $(to_share)/include

# What `make install` of this version with the same variables has written.
uninstall:
	rm -f $(addprefix $(to_include)/,$(HEADERS))
	rm -f $(addprefix $(to_shared)/,$(REALNAME) $(LINKS)) $(addprefix $(to_lib)/,libcontact_normal.a $(IMPORT_LIBRARY))
	rm -f $(to_bin)/contact-normal-replay$(EXE) $(if $(to_debug),$(to_debug)/$(REALNAME).debug)
	rm -f $(to_lib)/pkgconfig/contact-normal.pc $(to_lib)/pkgconfig/contact-normal-shared.pc
	rm -rf $(to_lib)/cmake/contact-normal $(to_share)
	rmdir $(to_lib)/pkgconfig $(to_lib)/cmake 2>/dev/null || :
