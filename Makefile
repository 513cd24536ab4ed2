# contact-normal: `make demo` and `make test` are all one needs to know. Rust itself is expected (https://rustup.rs).

CARGO ?= cargo
CC = gcc
FC = gfortran
include packaging/install.mk

WHEEL_RAIL := data/wheel_rail/y4_82kN.txt

# Programs of Python's environments; $(call environment,folder,packages) makes one, and a file "ready" in it.
SCRIPTS := $(if $(filter Windows_NT,$(OS)),Scripts,bin)
TOOLS := build/tools/$(SCRIPTS)
environment = python3 -c 'import ensurepip, venv' 2>/dev/null || { $(call apt_get,python3-venv); }; \
	python3 -m venv $(1) && $(1)/$(SCRIPTS)/python -m pip install --quiet --disable-pip-version-check $(2) && touch $(1)/ready

# The first Python that has numpy and matplotlib: a python3 of the user's own may lack what /usr/bin/python3 has.
find_python = $$(for p in "$$PYTHON" python3 /usr/bin/python3 build/demo/$(SCRIPTS)/python; do \
	test -n "$$p" && "$$p" -c 'import numpy, matplotlib' 2>/dev/null && echo "$$p" && break; done; true)

# $(call apt_get,packages): installs Debian packages, without what they only recommend, with sudo unless we are root; says so. Without
# sudo it prints what to ask for.
apt_get = command -v apt-get >/dev/null || { echo "missing, and no apt-get to install them: $(1)" >&2; exit 1; }; \
	sudo=''; test "$$(id -u)" = 0 || sudo=sudo; \
	test -z "$$sudo" || command -v sudo >/dev/null || { \
		echo "Missing here, and no sudo. Ask your administrator for:  apt-get install --no-install-recommends $(1)" >&2; exit 1; }; \
	echo "Missing here: $(1). Installing by $$sudo apt-get install --no-install-recommends; to do without, install them before."; \
	$$sudo apt-get $(APT_KEEPS_LITTLE) update -qq && \
	$$sudo env DEBIAN_FRONTEND=noninteractive apt-get $(APT_KEEPS_LITTLE) install -y -qq --no-install-recommends $(1)
# A bare Debian would get descriptions in words (39 MB), caches of the lists (78 MB), and keep the packages. What is there stays.
APT_KEEPS_LITTLE := -o Acquire::Languages=none -o APT::Get::List-Cleanup=false -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= \
	-o APT::Keep-Downloaded-Packages=false

.PHONY: all demo demo-tools tools test campaign soak bench bench-table bench-peers analysis accuracy plain-cost
.PHONY: wheel wheel-library dist machines package-test docs pictures crates notices clean
.DEFAULT_GOAL := all

all:
	$(CARGO) build --profile $(PROFILE) --locked $(if $(TARGET),--target $(TARGET))

# Installs those Debian packages whose tool is missing: for the demo fewer than for the tests. Without sudo: have them installed
# before, then nothing is done here.
tools demo-tools:
	@missing=''; \
	need() { command -v "$$1" >/dev/null 2>&1 || missing="$$missing $$2"; }; \
	need gcc gcc; \
	if test $@ = tools; then need gfortran gfortran; need g++ g++; need valgrind valgrind; need pkg-config pkg-config; need cmake cmake; fi; \
	echo 'int main(void) { return 0; }' | gcc -x c - -o /dev/null 2>/dev/null || missing="$$missing gcc libc6-dev"; \
	if test -n "$(find_python)"; then :; \
	elif test $@ = tools; then missing="$$missing python3 python3-numpy python3-matplotlib"; \
	else python3 -c 'import ensurepip, venv' 2>/dev/null || missing="$$missing python3-venv"; fi; \
	test -z "$$missing" || { $(call apt_get,$$missing); }

# Builds the shared library only, in a profile that compiles in less time and memory than that of a release, and without AVX-512. What comes on the
# way, several times its size, is deleted. Then numpy and matplotlib come by pip: Debian's packages of them bring twice as much. The examples in
# Fortran run where its compiler is; none is installed for them.
DEMO_BUILT := build/demo_library
DEMO_FORTRAN := $(shell command -v $(FC) 2>/dev/null)
demo: demo-tools $(DEMO_BUILT)/$(BUILT)
	@test -n "$(find_python)" || { $(call environment,build/demo,--no-cache-dir --no-compile numpy matplotlib) && \
		build/demo/$(SCRIPTS)/python -m pip uninstall --quiet --yes setuptools pip; }
	@ln -sfn $(abspath $(DEMO_BUILT))/$(BUILT) build/$(SONAME)
	$(CC) -std=c99 -O2 -Iinclude c_examples/hertz.c -o build/hertz_c -L$(DEMO_BUILT) -lcontact_normal -lm
	$(CC) -std=c99 -O2 -Iinclude c_examples/wheel_rail.c -o build/wheel_rail_c -L$(DEMO_BUILT) -lcontact_normal -lm
ifdef DEMO_FORTRAN
	$(FC) -O2 -Jbuild include/contact_normal.f90 fortran_examples/hertz.f90 -o build/hertz_f \
		-L$(DEMO_BUILT) -lcontact_normal
	$(FC) -O2 -Jbuild include/contact_normal.f90 fortran_examples/wheel_rail.f90 -o build/wheel_rail_f \
		-L$(DEMO_BUILT) -lcontact_normal
endif
	@echo; echo "== The paper's problem, from C"
	@$(LOADER_PATH)=build build/hertz_c
ifdef DEMO_FORTRAN
	@echo; echo "== The paper's problem, from Fortran"
	@$(LOADER_PATH)=build build/hertz_f
endif
	@echo; echo "== Wheel and rail, from C"
	@$(LOADER_PATH)=build build/wheel_rail_c $(WHEEL_RAIL)
ifdef DEMO_FORTRAN
	@echo; echo "== Wheel and rail, from Fortran"
	@$(LOADER_PATH)=build build/wheel_rail_f $(WHEEL_RAIL)
endif
	@echo; echo "== Wheel and rail, from Python"
	@CONTACT_NORMAL_LIBRARY=$(abspath $(DEMO_BUILT))/$(BUILT) PYTHONPATH=python PYTHONDONTWRITEBYTECODE=1 \
		"$(find_python)" python_examples/wheel_rail.py $(WHEEL_RAIL) build/wheel_rail.png
	@echo; echo "The picture: build/wheel_rail.png"
ifndef DEMO_FORTRAN
	@echo "For the same in Fortran: install gfortran, then make demo."
endif

$(DEMO_BUILT)/$(BUILT): Cargo.toml Cargo.lock build.rs $(shell find src crates -name '*.rs') | demo-tools
	$(CARGO) rustc --profile demo --locked --lib --crate-type cdylib --no-default-features --target-dir build/demo_target
	@mkdir -p $(DEMO_BUILT)
	@cp build/demo_target/demo/$(BUILT) $(DEMO_BUILT)
	@rm -rf build/demo_target

# Optimised, with debug assertions and overflow checks on; the feature is for tests/handles.
test: tools
	$(CARGO) test --profile checked --locked --workspace --features contact-normal/test-panics --lib --bins --tests
	$(CARGO) build --profile checked --locked --workspace --features contact-normal/test-panics --examples
	$(CARGO) test --profile checked --locked --workspace --features contact-normal/test-panics --doc

# N random scenes over all effects, methods, guesses and handles, each certified by an oracle of the campaign's own; prints what
# was run, what was excused, and every failure. SURFACES=measured: scenes of what people bring, measured maps with their faults, line
# scans, strips, punches. SURFACES=adhesion: bodies that attract each other; friction, laws, relaxing: friction alone, its laws, bodies that
# relax. One case again: cargo run --release -p campaign -- --seed S, or -- --measured --seed S; of the others -- --adhesion 1 S
N ?= 20000
FIRST ?= 0
SURFACES ?= ordinary
campaign:
	$(CARGO) run --release --locked -p campaign -- $(if $(filter-out ordinary,$(SURFACES)),--$(SURFACES)) $(N) $(FIRST)

# 10^5 solves of a rolling sequence: no drift, no growth, the same bits when repeated. Some minutes.
SOAK ?= 100000
soak:
	$(CARGO) run --release --locked --example soak -- $(SOAK)

# What a solve costs, in products, beside what it may cost and beside an older version, which is built once. BENCH="--large" goes up to
# 4096 x 4096; see benches/performance.
BENCH ?=
OLD := 9fd3772
OLD_LIBRARY := build/old-$(OLD)/target/release/libcontact_normal.so
OLD_PROGRAM := build/old-$(OLD)/target/release/performance
bench: all $(OLD_PROGRAM)
	CONTACT_NORMAL_OLD="$(CURDIR)/$(OLD_LIBRARY)" CONTACT_NORMAL_OLD_PROGRAM="$(CURDIR)/$(OLD_PROGRAM)" \
		CONTACT_NORMAL_NEW="$(CURDIR)/target/release/libcontact_normal.so" \
		$(CARGO) bench --locked --bench performance -- $(BENCH)

# And its library, beside it.
$(OLD_PROGRAM):
	@mkdir -p build/old-$(OLD)
	git archive $(OLD) | tar -x -C build/old-$(OLD)
	cd build/old-$(OLD) && CARGO_TARGET_DIR=target $(CARGO) build --release --locked --lib --bench performance
	cp "$$(ls -t build/old-$(OLD)/target/release/deps/performance-* | grep -v '\.d$$' | head -n 1)" $(OLD_PROGRAM)

# The yardstick of tables of creep forces: 204800 ellipses of 35 x 35 elements on two processes. TABLE="--sample 0.01" extrapolates from a
# hundredth of them; TABLE="--errors" compares the estimated errors with finer grids.
TABLE ?=
bench-table: all
	CONTACT_NORMAL_LIBRARY=$(abspath $(LIBDIR_BUILT))/$(BUILT) PYTHONPATH=python PYTHONDONTWRITEBYTECODE=1 \
		"$(find_python)" benches/creep_force_table.py $(TABLE)

# The same problems by other solvers, at pinned versions in an environment under build/; see benches/peers. PEERS="--quick". Then adhesion beside tamaas.
PEERS ?=
PEERS_PYTHON := build/peers/bin/python
bench-peers: all $(PEERS_PYTHON)
	$(PEERS_PYTHON) benches/peers/run.py $(PEERS)
	$(PEERS_PYTHON) benches/peers/adhesion.py --largest 256
	$(PEERS_PYTHON) benches/peers/thickness.py
	$(PEERS_PYTHON) benches/visco_tamaas.py

# aspher is built here, for this machine: C++, CMake and Eigen's headers.
$(PEERS_PYTHON): benches/peers/requirements.txt
	@missing=''; \
	command -v g++ >/dev/null || missing="$$missing g++"; \
	command -v cmake >/dev/null || missing="$$missing cmake"; \
	test -d /usr/include/eigen3 || missing="$$missing libeigen3-dev"; \
	python3 -c 'import ensurepip, venv' 2>/dev/null || missing="$$missing python3-venv"; \
	test -z "$$missing" || { $(call apt_get,$$missing); }
	python3 -m venv build/peers
	CFLAGS="-O3 -march=native" CXXFLAGS="-O3 -march=native" build/peers/bin/pip install --quiet --no-binary aspher \
		-r benches/peers/requirements.txt
	touch $@

# Local Fourier analysis beside measurement; keeps what `make pictures` and `make docs` draw.
analysis: tools
	$(CARGO) run --release --locked -p local_fourier_analysis target/local_fourier_analysis
	"$(find_python)" local_fourier_analysis/picture.py --keep target/local_fourier_analysis

# What accuracy costs, and what the library says of it: all tables of docs/accuracy.md and docs/notes/2026-11-accuracy.md on the screen;
# `make pictures` draws the first of them. ACCURACY="--quick", or some of estimates, searches, prices, study. Those by Python follow: searches on
# fourteen kinds of surface and for all quantities, and what neglect_below leaves out.
ACCURACY ?=
accuracy: tools all build/tools/ready
	$(CARGO) run --release --locked --example accuracy -- $(ACCURACY)
	@test ! -e build/accuracy.csv || "$(find_python)" benches/accuracy.py build/accuracy.csv
	@export CONTACT_NORMAL_LIBRARY=$(abspath $(LIBDIR_BUILT))/$(BUILT) PYTHONPATH=$(abspath python); \
	$(TOOLS)/python benches/searches/run.py $(if $(findstring --quick,$(ACCURACY)),--seeds 1) && \
	$(TOOLS)/python benches/searches/quantities.py $(if $(findstring --quick,$(ACCURACY)),--seeds 1) && \
	$(TOOLS)/python benches/searches/neglect.py $(if $(findstring --quick,$(ACCURACY)),--scenes 20) && \
	$(TOOLS)/python benches/searches/neglect.py --elements 128 --scenes $(if $(findstring --quick,$(ACCURACY)),10,50)

# An effect that is not named is free: instructions and bytes of a plain solve beside the recorded ones. RECORD="what came in" records them.
RECORD ?=
plain-cost: tools all
	"$(find_python)" benches/plain_solve/check.py $(LIBDIR_BUILT)/libcontact_normal.so include $(if $(RECORD),--record "$(RECORD)")

# The wheel, in build/wheel: py3-none-<platform>, with the stripped library inside. TARGET, a target of Rust, makes that of another machine.
wheel: wheel-library build/tools/ready
	rm -rf build/wheel
	CONTACT_NORMAL_LIBRARY=$(abspath $(WHEEL_LIBRARY)) $(if $(filter linux,$(SYSTEM)),STRIP=true) \
		$(TOOLS)/python -m build --wheel --no-isolation --outdir build/wheel >build/wheel.log || { cat build/wheel.log >&2; exit 1; }
	$(TOOLS)/python packaging/check_wheel.py build/wheel/*.whl $(if $(filter linux,$(SYSTEM)),manylinux_$(subst .,_,$(GLIBC)))

# The library of the wheel. On Linux the static library is linked once more, by zig, which has the symbols of each version of glibc: this
# machine's glibc would ask for its own, newest ones. Here the tag of the wheel is true from GLIBC on.
GLIBC := 2.28
ifeq ($(SYSTEM),linux)
MACHINE := $(firstword $(subst -, ,$(or $(TARGET),$(shell uname -m))))
WHEEL_LIBRARY := build/wheel_library/$(MACHINE)/$(BUILT)
wheel-library: all build/zig/ready
	@mkdir -p $(dir $(WHEEL_LIBRARY))
	@{ echo '{ global:'; sed 's/$$/;/' include/exported_symbols.txt; echo 'local: *; };'; } > build/wheel_library/exports
	build/zig/$(SCRIPTS)/python -m ziglang cc -target $(MACHINE)-linux-gnu.$(GLIBC) -shared -s -o $(WHEEL_LIBRARY) \
		-Wl,-soname,$(SONAME) -Wl,-z,nodelete -Wl,-z,defs -Wl,--version-script=build/wheel_library/exports -Wl,--gc-sections \
		-Wl,--whole-archive $(LIBDIR_BUILT)/libcontact_normal.a -Wl,--no-whole-archive -lunwind -lm -lpthread -ldl
else
WHEEL_LIBRARY := $(LIBDIR_BUILT)/$(BUILT)
wheel-library: all
endif

# Builds the library for other machines and tries it there: MACHINES="aarch64-unknown-linux-gnu" one of them. Some 20 minutes.
MACHINES ?=
machines:
	packaging/machines.sh $(MACHINES)

build/zig/ready: packaging/requirements_zig.txt
	@$(call environment,build/zig,-r $<)

# All that a release hands out, for this machine or for TARGET, in build/dist: the source, the library as `make install` has it, the wheel, the
# source for pip, the header, and their checksums.
DIST := contact-normal-$(VERSION)
PLATFORM := $(or $(TARGET),$(shell uname -m)-$(SYSTEM))
dist: wheel
	rm -rf build/dist build/dist_prefix
	mkdir -p build/dist
	git archive --format=tar.gz --prefix=$(DIST)/ -o build/dist/$(DIST)-source.tar.gz HEAD
	$(MAKE) --no-print-directory -s install DESTDIR= PREFIX=build/dist_prefix/$(DIST)-$(PLATFORM) LIBDIR= RELOCATABLE=yes \
		SHARED_BUILT=$(WHEEL_LIBRARY)
	tar -C build/dist_prefix -czf build/dist/$(DIST)-$(PLATFORM).tar.gz $(DIST)-$(PLATFORM)
	cp build/wheel/*.whl include/contact_normal.h build/dist
	$(TOOLS)/python -m build --sdist --no-isolation --outdir build/dist >build/sdist.log || { cat build/sdist.log >&2; exit 1; }
	cd build/dist && { command -v sha256sum >/dev/null && sha256sum * || shasum -a 256 *; } > ../SHA256SUMS
	mv build/SHA256SUMS build/dist
	@ls -l build/dist

# Installs the library into an empty prefix and the wheel into an empty environment, and uses them without Rust in PATH.
package-test: tools wheel build/tools/ready
	rm -rf build/prefix
	$(MAKE) --no-print-directory -s install PREFIX=build/prefix DESTDIR=
	@ls -l build/prefix/lib/$(REALNAME) build/prefix/lib/libcontact_normal.a build/wheel/*.whl
	$(TOOLS)/python -m mypy
	@test $$(stat -c %s build/wheel/*.whl) -le 5000000 || { echo "the wheel is larger than 5 MB" >&2; exit 1; }
	FPM=$(abspath $(TOOLS)/fpm) packaging/test.sh build/prefix build/wheel/*.whl build/consumers

# The site, in build/docs/html. Warnings are errors; links and code blocks are checked.
docs: tools all build/tools/ready
	rm -rf build/docs
	$(MAKE) --no-print-directory -s install PREFIX=build/prefix DESTDIR=
	CONTACT_NORMAL_LIBRARY=$(abspath $(LIBDIR_BUILT))/$(BUILT) PYTHONPATH=$(abspath python) \
		$(TOOLS)/python docs/pictures.py --dark docs/pictures/dark
	for notebook in notebooks/*.ipynb; do \
		CONTACT_NORMAL_LIBRARY=$(abspath $(LIBDIR_BUILT))/$(BUILT) PYTHONPATH=$(abspath python) \
			$(TOOLS)/python docs/run_notebook.py $$notebook docs/notebooks || exit 1; \
	done
	CONTACT_NORMAL_LIBRARY=$(abspath $(LIBDIR_BUILT))/$(BUILT) \
		$(TOOLS)/python -m sphinx -W --keep-going -q docs build/docs/html
	$(TOOLS)/python docs/check_links.py
	CONTACT_NORMAL_LIBRARY=$(abspath build/prefix/lib/$(BUILT)) PYTHONPATH=$(abspath python) \
		$(TOOLS)/python docs/check_code.py build/prefix build/docs/code
	@echo "The site: build/docs/html/index.html"

# The pictures of the pages, anew: after a change of an example or of the style.
pictures: all build/tools/ready
	CONTACT_NORMAL_LIBRARY=$(abspath $(LIBDIR_BUILT))/$(BUILT) PYTHONPATH=$(abspath python) \
		$(TOOLS)/python docs/pictures.py docs/pictures

# What builds wheels and the site: an environment of Python, apart from the user's.
build/tools/ready: packaging/requirements.txt
	@$(call environment,build/tools,-r $<)

# The three crates for crates.io, packed but not published: CONTRIBUTING.md has the order.
crates:
	$(CARGO) package --locked --no-verify -p contact-normal-par -p contact-normal-toeplitz -p contact-normal

# The licences of what is linked, anew: after a change of Cargo.lock.
notices:
	$(CARGO) about --version >/dev/null 2>&1 || $(CARGO) install --locked cargo-about --no-default-features --features cli
	$(CARGO) about generate --locked --fail -o THIRD_PARTY_NOTICES about.hbs

clean:
	$(CARGO) clean
	rm -rf build
