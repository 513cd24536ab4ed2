# contact-normal: `make demo` and `make test` are all one needs to know. Rust itself is expected (https://rustup.rs).

CARGO ?= cargo
CC = gcc
FC = gfortran
PREFIX ?= /usr/local
override PREFIX := $(abspath $(PREFIX))
DESTDIR ?=
INSTALL ?= install

VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
# The soname changes when the ABI breaks, not with every version: build.rs links with it.
SONAME := libcontact_normal.so.0

# Where the built libraries are: a packager (or a test) may have them elsewhere.
LIBDIR_BUILT ?= target/release
LIBRARIES := $(LIBDIR_BUILT)/libcontact_normal.so $(LIBDIR_BUILT)/libcontact_normal.a
# What the static library needs of the system, as `cargo rustc --release --lib --crate-type staticlib -- --print
# native-static-libs` says; tests/clients/installed_package.rs links with it.
STATIC_LIBS := -lgcc_s -lutil -lrt -lpthread -lm -ldl -lc

INCLUDEDIR := $(DESTDIR)$(PREFIX)/include
LIBDIR := $(DESTDIR)$(PREFIX)/lib
WHEEL_RAIL := data/wheel_rail/y4_82kN.txt

# The first Python that has numpy and matplotlib: a python3 of the user's own may lack what /usr/bin/python3 has.
find_python = $$(for p in "$$PYTHON" python3 /usr/bin/python3; do \
	test -n "$$p" && "$$p" -c 'import numpy, matplotlib' 2>/dev/null && echo "$$p" && break; done; true)

.PHONY: all demo test campaign soak bench bench-peers analysis accuracy install tools clean
.DEFAULT_GOAL := all

all:
	$(CARGO) build --release --locked

# Installs those Debian packages whose tool is missing, with sudo unless we are root; says so.
tools:
	@missing=''; \
	need() { command -v "$$1" >/dev/null 2>&1 || missing="$$missing $$2"; }; \
	need gcc gcc; need g++ g++; need gfortran gfortran; need valgrind valgrind; need pkg-config pkg-config; \
	echo 'int main(void) { return 0; }' | gcc -x c - -o /dev/null 2>/dev/null || missing="$$missing gcc libc6-dev"; \
	if test -z "$(find_python)"; then missing="$$missing python3 python3-numpy python3-matplotlib"; fi; \
	test -z "$$missing" && exit 0; \
	command -v apt-get >/dev/null || { echo "missing, and no apt-get to install them:$$missing" >&2; exit 1; }; \
	sudo=''; test "$$(id -u)" = 0 || sudo=sudo; \
	echo "Missing here:$$missing. Installing with: $$sudo apt-get install"; \
	$$sudo apt-get update -qq && $$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq $$missing

demo: tools all
	@mkdir -p build
	@ln -sfn ../target/release/libcontact_normal.so build/$(SONAME)
	$(CC) -std=c99 -O2 -Iinclude c_examples/hertz.c -o build/hertz_c -Ltarget/release -lcontact_normal -lm
	$(CC) -std=c99 -O2 -Iinclude c_examples/wheel_rail.c -o build/wheel_rail_c -Ltarget/release -lcontact_normal -lm
	$(FC) -O2 -Jbuild include/contact_normal.f90 fortran_examples/hertz.f90 -o build/hertz_f \
		-Ltarget/release -lcontact_normal
	$(FC) -O2 -Jbuild include/contact_normal.f90 fortran_examples/wheel_rail.f90 -o build/wheel_rail_f \
		-Ltarget/release -lcontact_normal
	@echo; echo "== The paper's problem, from C"
	@LD_LIBRARY_PATH=build build/hertz_c
	@echo; echo "== The paper's problem, from Fortran"
	@LD_LIBRARY_PATH=build build/hertz_f
	@echo; echo "== Wheel and rail, from C"
	@LD_LIBRARY_PATH=build build/wheel_rail_c $(WHEEL_RAIL)
	@echo; echo "== Wheel and rail, from Fortran"
	@LD_LIBRARY_PATH=build build/wheel_rail_f $(WHEEL_RAIL)
	@echo; echo "== Wheel and rail, from Python"
	@CONTACT_NORMAL_LIBRARY=target/release/libcontact_normal.so PYTHONPATH=python PYTHONDONTWRITEBYTECODE=1 \
		"$(find_python)" python_examples/wheel_rail.py $(WHEEL_RAIL) build/wheel_rail.png
	@echo; echo "The picture: build/wheel_rail.png"

# Optimised, with debug assertions and overflow checks on; the feature is for tests/handles.
test: tools
	$(CARGO) test --profile checked --locked --workspace --features contact-normal/test-panics --lib --bins --tests
	$(CARGO) build --profile checked --locked --workspace --features contact-normal/test-panics --examples
	$(CARGO) test --profile checked --locked --workspace --features contact-normal/test-panics --doc

# N random scenes over all effects, methods, guesses and handles, each certified by an oracle of the campaign's own; prints what
# was run and every failure. One case again: cargo run --release -p campaign -- --seed S
N ?= 20000
FIRST ?= 0
campaign:
	$(CARGO) run --release --locked -p campaign -- $(N) $(FIRST)

# 10^5 solves of a rolling sequence: no drift, no growth, the same bits when repeated. Some minutes.
SOAK ?= 100000
soak:
	$(CARGO) run --release --locked --example soak -- $(SOAK)

# What a solve costs, in products, beside what it may cost. BENCH="--large" goes up to 4096 x 4096; see benches/performance.
BENCH ?=
bench:
	$(CARGO) bench --locked --bench performance -- $(BENCH)

# The same problems by other solvers, at pinned versions in an environment under build/; see benches/peers. PEERS="--quick".
PEERS ?=
PEERS_PYTHON := build/peers/bin/python
bench-peers: all $(PEERS_PYTHON)
	$(PEERS_PYTHON) benches/peers/run.py $(PEERS)

# aspher is built here, for this machine: C++, CMake and Eigen's headers.
$(PEERS_PYTHON): benches/peers/requirements.txt
	@missing=''; \
	command -v g++ >/dev/null || missing="$$missing g++"; \
	command -v cmake >/dev/null || missing="$$missing cmake"; \
	test -d /usr/include/eigen3 || missing="$$missing libeigen3-dev"; \
	python3 -c 'import ensurepip, venv' 2>/dev/null || missing="$$missing python3-venv"; \
	if test -n "$$missing"; then \
		command -v apt-get >/dev/null || { echo "missing, and no apt-get to install them:$$missing" >&2; exit 1; }; \
		sudo=''; test "$$(id -u)" = 0 || sudo=sudo; \
		echo "Missing here:$$missing. Installing with: $$sudo apt-get install"; \
		$$sudo apt-get update -qq && $$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq $$missing; \
	fi
	python3 -m venv build/peers
	CFLAGS="-O3 -march=native" CXXFLAGS="-O3 -march=native" build/peers/bin/pip install --quiet --no-binary aspher \
		-r benches/peers/requirements.txt
	touch $@

# Local Fourier analysis beside measurement, and docs/local_fourier_analysis.png.
analysis: tools
	$(CARGO) run --release --locked -p local_fourier_analysis target/local_fourier_analysis
	"$(find_python)" local_fourier_analysis/picture.py target/local_fourier_analysis docs/local_fourier_analysis.png

# What accuracy costs, and what the library says of it: all tables of docs/accuracy.md and docs/notes/accuracy.md on the screen, and the
# picture. ACCURACY="--quick", or some of estimates, searches, prices, study.
ACCURACY ?=
accuracy: tools
	$(CARGO) run --release --locked --example accuracy -- $(ACCURACY)
	@test ! -e build/accuracy.csv || "$(find_python)" benches/accuracy.py build/accuracy.csv docs

install:
	@test -e $(LIBDIR_BUILT)/libcontact_normal.so -a -e $(LIBDIR_BUILT)/libcontact_normal.a || $(MAKE) all
	$(INSTALL) -d $(INCLUDEDIR) $(LIBDIR)/pkgconfig
	$(INSTALL) -m 644 $(addprefix include/contact_normal,.h .f90 _exports.inc _norm_solve.inc) $(INCLUDEDIR)
	$(INSTALL) -m 755 $(LIBDIR_BUILT)/libcontact_normal.so $(LIBDIR)/$(SONAME).$(VERSION:0.%=%)
	ln -sfn $(SONAME).$(VERSION:0.%=%) $(LIBDIR)/$(SONAME)
	ln -sfn $(SONAME) $(LIBDIR)/libcontact_normal.so
	$(INSTALL) -m 644 $(LIBDIR_BUILT)/libcontact_normal.a $(LIBDIR)
	@printf '%s\n' \
		'prefix=$(PREFIX)' 'includedir=$${prefix}/include' 'libdir=$${prefix}/lib' '' \
		'Name: contact-normal' 'Description: The elastic normal contact problem by full multigrid' \
		'Version: $(VERSION)' 'Cflags: -I$${includedir}' 'Libs: -L$${libdir} -lcontact_normal' \
		'Libs.private: $(STATIC_LIBS)' > $(LIBDIR)/pkgconfig/contact-normal.pc

clean:
	$(CARGO) clean
	rm -rf build
