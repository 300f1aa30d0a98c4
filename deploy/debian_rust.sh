#!/usr/bin/env bash
# Debian's current Rust with the sources of its standard library, unpacked in a folder and not installed, so that it stands beside
# rustup's. With it comes every library it hangs on that this machine lacks. Prints what to export.
#
#     eval "$(deploy/debian_rust.sh FOLDER)"
set -euo pipefail
folder=$(mkdir -p "$1" && cd "$1" && pwd)
libraries="$folder/usr/lib/$(uname -m)-linux-gnu"
starts() { LD_LIBRARY_PATH=$libraries "$folder/usr/bin/$1" --version >/dev/null; }

if ! { starts cargo && starts rustc; } 2>/dev/null; then
    cd "$folder"
    rust="rustc-web cargo-web rust-web-src"
    # shellcheck disable=SC2086
    missing=$(apt-get --simulate --no-install-recommends install $rust | sed -n 's/^Inst \([^ ]*\).*/\1/p')
    # shellcheck disable=SC2046
    apt-get download $(printf '%s\n' $rust $missing | sort -u) >&2
    for package in ./*.deb; do
        dpkg -x "$package" .
    done
    rm -- ./*.deb
    starts cargo
    starts rustc
fi
echo "export CARGO='$folder/usr/bin/cargo' RUSTC='$folder/usr/bin/rustc'"
echo "export LD_LIBRARY_PATH='$libraries'"
