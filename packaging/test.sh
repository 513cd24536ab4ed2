#!/usr/bin/env bash
# Uses what `make install` and `make wheel` have made, as somebody who has no Rust: programs by pkg-config, CMake, fpm, and Python from
# the wheel in an empty environment. Each prints the force of the paper's problem. Usage: packaging/test.sh PREFIX WHEEL FOLDER
set -euo pipefail
shopt -s inherit_errexit
prefix=$(realpath "$1") wheel=$(realpath "$2") folder=$3
consumers=$(realpath "$(dirname "$0")/consumers") data=$(realpath "$(dirname "$0")/../data/wheel_rail")
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder"

# Without Rust: the folders of PATH that have cargo are left out. Where it lies beside the compilers, one that fails stands before it.
without=$PWD/without_rust && mkdir "$without"
path=$without
for entry in ${PATH//:/ }; do test -x "$entry/cargo" -a ! -x "$entry/gcc" || path=$path:$entry; done
export PATH=$path
if command -v cargo >/dev/null; then
    for tool in cargo rustc; do printf '#!/bin/sh\necho "no Rust here" >&2\nexit 1\n' > "$without/$tool"; done
    chmod +x "$without"/*
    ! cargo --version 2>/dev/null || { echo "cargo is still in PATH" >&2; exit 1; }
fi
unset CARGO_TARGET_DIR CONTACT_NORMAL_LIBRARY PYTHONPATH LD_LIBRARY_PATH

# The exact force is 81986.8 N; on 128 x 128 elements it is 81989 N (cxx_examples/hertz.expected).
expected="force 81989 N" passed=0
consumer() { # name, command: builds and runs; the last line that it prints is the force
    local name=$1 start end printed
    shift
    start=$(date +%s.%N)
    printed=$("$@" | tail -n 1)
    end=$(date +%s.%N)
    test "$printed" = "$expected" || { echo "$name printed \"$printed\"; expected \"$expected\"" >&2; exit 1; }
    printf '%-22s %s  %6.1f s\n' "$name" "$printed" "$(awk "BEGIN { print $end - $start }")"
    passed=$((passed + 1))
}

export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
by_pkg_config() { # compiler, source, flags of pkg-config, further flags
    # shellcheck disable=SC2046
    "$1" "$consumers/c/$2" -o program $4 $(pkg-config --cflags --libs $3 contact-normal) 2>link.log || { cat link.log >&2; return 1; }
    if test -n "$3" && readelf -d program | grep 'NEEDED.*contact_normal' >&2; then
        echo "linked with --static, and yet it needs the shared library" >&2
        return 1
    fi
    LD_LIBRARY_PATH=$prefix/lib ./program
}
consumer "C, shared" by_pkg_config gcc force.c "" "-std=c99"
consumer "C, static" by_pkg_config gcc force.c --static ""
consumer "C, all static" by_pkg_config gcc force.c --static "-static"
consumer "C++, shared" by_pkg_config g++ force.cpp "" "-std=c++17"
consumer "C++, static" by_pkg_config g++ force.cpp --static "-std=c++17"

by_cmake() {
    test -d cmake || {
        cmake -S "$consumers/cmake" -B cmake -DCMAKE_PREFIX_PATH="$prefix" >cmake.log && cmake --build cmake >>cmake.log
    } || { cat cmake.log >&2; return 1; }
    "cmake/$1"
}
for program in shared_c static_c shared_cxx static_cxx fortran host; do
    consumer "CMake, $program" by_cmake $program
done

by_fpm() {
    cp -r "$consumers/fpm" fpm
    # fpm takes relative paths only.
    sed "s|@PACKAGE@|$(realpath --relative-to=fpm "$prefix/share/contact-normal")|" fpm/fpm.toml.in > fpm/fpm.toml
    (cd fpm && LIBRARY_PATH=$prefix/lib LD_LIBRARY_PATH=$prefix/lib "${FPM:-fpm}" run) 2>fpm.log || { cat fpm.log >&2; return 1; }
}
if command -v "${FPM:-fpm}" >/dev/null || test "$(uname -m)" = x86_64; then consumer "Fortran, fpm" by_fpm; else echo "Fortran, fpm: not run, no fpm here"; fi

by_wheel() {
    python3 -m venv python && python/bin/pip install --quiet --disable-pip-version-check "$wheel"
    # numpy and nothing else.
    test "$(python/bin/pip list --format freeze | grep -vc '^pip\|^setuptools')" = 2 || { python/bin/pip list >&2; return 1; }
    python/bin/python "$consumers/python/force.py"
}
consumer "Python, wheel" by_wheel

python/bin/pip install --quiet --disable-pip-version-check "$wheel[plot]"
cp "$data/y4_82kN.txt" . && MPLBACKEND=Agg python/bin/python "$consumers/python/five_lines.py"
test "$(stat -c %s wheel_rail.png)" -gt 10000
echo "Python, five lines     drew wheel_rail.png"
python/bin/contact-normal prices --help >/dev/null
# Tables in files and on a cluster of two processes, files of instruments and of VTK: the tests that need more than numpy.
python/bin/pip install --quiet --disable-pip-version-check "$wheel[tables,dask,progress,vtk,surface]"
tests=$(realpath "$consumers/../../python/tests_tables")
python/bin/python -m unittest discover -s "$tests" 2>tables.log || { cat tables.log >&2; exit 1; }
grep -q "^Ran $(cat "$tests"/test_*.py | grep -c '^    def test_') tests" tables.log || { cat tables.log >&2; exit 1; }
echo "Python, tables         $(grep '^Ran' tables.log)"
echo "$passed passed, 0 failed"
