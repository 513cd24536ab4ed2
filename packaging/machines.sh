#!/usr/bin/env bash
# Builds the library for other machines and tries it there: Linux on aarch64 by qemu-user, Windows by MinGW-w64 and wine. Runs the examples in C,
# and the Python package, from its wheel, with its tests. For macOS it is only compiled. For Debian 12, as root or with sudo.
# Usage: packaging/machines.sh [TARGET...]
#
# The standard library of a target is rustup's (`rustup target add TARGET`), if it is installed. Otherwise the compiler of Debian's packages is
# unpacked into build/machines/rust, beside Rust itself: it has aarch64's standard library, and the source, from which cargo builds others.
set -euo pipefail
cd "$(dirname "$0")/.."
targets=("${@:-}")
test -n "${targets[0]}" || targets=(aarch64-unknown-linux-gnu x86_64-pc-windows-gnu aarch64-apple-darwin)
here=$PWD/build/machines
sudo=$(test "$(id -u)" = 0 || echo sudo)

need() { # program, packages
    local program=$1
    shift
    command -v "$program" >/dev/null || $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@"
}

# Debian's compiler, from lists of packages of its own: the system's do not know arm64.
debian_rust() {
    test ! -x "$here/rustc" || return 0
    local apt=$here/apt llvm std
    mkdir -p "$apt"/etc/apt/{apt.conf.d,preferences.d} "$apt"/var/lib/apt/lists/partial "$apt"/var/cache/apt/archives/partial "$here"/{debs,rust}
    : > "$apt/status"
    rm -rf "$apt"/etc/apt/sources.list.d && cp -r /etc/apt/sources.list.d "$apt/etc/apt"
    test ! -e /etc/apt/sources.list || cp /etc/apt/sources.list "$apt/etc/apt"
    cat > "$apt/conf" <<EOF
Dir "$apt"; Dir::State::status "$apt/status"; APT::Architecture "amd64"; APT::Architectures { "amd64"; "arm64"; }; APT::Sandbox::User "root";
EOF
    export APT_CONFIG=$apt/conf
    apt-get update -qq
    std=$(apt-cache depends libstd-rust-web-dev | sed -n 's/.*Depends: \(libstd-rust-web-[0-9.]*\)$/\1/p' | head -n 1)
    llvm=$(apt-cache depends "$std" | sed -n 's/.*Depends: \(libllvm[0-9]*\)$/\1/p' | head -n 1)
    (cd "$here/debs" && rm -f ./*.deb && apt-get download -qq rustc-web rust-web-src libstd-rust-web-dev libstd-rust-web-dev:arm64 "$std" "$llvm")
    unset APT_CONFIG
    local deb
    for deb in "$here"/debs/*.deb; do dpkg-deb -x "$deb" "$here/rust"; done
    cat > "$here/rustc" <<EOF
#!/bin/sh
LD_LIBRARY_PATH=$here/rust/usr/lib/x86_64-linux-gnu exec $here/rust/usr/bin/rustc --sysroot $here/rust/usr "\$@"
EOF
    chmod +x "$here/rustc"
}

# Sets RUSTC and `std`, what cargo needs to be told for the standard library of the target.
compiler_for() {
    unset RUSTC RUSTC_BOOTSTRAP
    std=()
    test ! -d "$(rustc --print target-libdir --target "$1")" || return 0
    debian_rust
    export RUSTC=$here/rustc
    test ! -d "$("$RUSTC" --print target-libdir --target "$1")" || return 0
    export RUSTC_BOOTSTRAP=1
    std=(-Zbuild-std=std,panic_unwind)
}

# Not below the project: cargo looks through its folders, and wine's has a link to the root of all.
rm -rf "$here/wine"
WINEPREFIX=$(mktemp -d)
trap 'rm -rf "$WINEPREFIX"' EXIT
export WINEPREFIX CARGO_TARGET_DIR=$here/target CARGO_PROFILE_CHECKED_DEBUG=0
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
test -n "$sudo" || apt-get update -qq
for target in "${targets[@]}"; do
    compiler_for "$target"
    case $target in
        *-apple-*) cargo check --locked "${std[@]}" --target "$target" && echo "$target: compiled, not run" && continue ;;
        *-windows-gnu)
            export STRIP=x86_64-w64-mingw32-strip
            need x86_64-w64-mingw32-gcc gcc-mingw-w64-x86-64 && need wine wine wine64 ;;
        aarch64-*)
            need aarch64-linux-gnu-gcc gcc-aarch64-linux-gnu libc6-dev-arm64-cross && need qemu-aarch64 qemu-user ;;
    esac
    cargo build --locked "${std[@]}" --profile checked --lib --bins --target "$target"
    python3 packaging/try_machine.py "$target" "$CARGO_TARGET_DIR/$target/checked" "$here/$target"
    # The wheel as `make wheel` makes it: that of Linux is linked by zig for glibc 2.28, with its tag checked.
    make -s wheel TARGET="$target" PROFILE=checked CARGO="cargo ${std[*]}"
    build/tools/bin/python packaging/try_foreign_wheel.py build/wheel/*.whl "$here/python-$target"
done
