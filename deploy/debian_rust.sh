#!/usr/bin/env bash
# Debian's current Rust with the sources of its standard library, unpacked in a folder and not installed, so that it stands beside
# rustup's. Prints what to export.
#
#     eval "$(deploy/debian_rust.sh FOLDER)"
set -euo pipefail
folder=$(mkdir -p "$1" && cd "$1" && pwd)

if [ ! -e "$folder/usr/bin/cargo" ]; then
    cd "$folder"
    version=$(apt-cache show rustc-web | sed -n 's/^Version: \([0-9]*\.[0-9]*\).*/\1/p' | head -n 1)
    llvm=$(apt-cache show "libstd-rust-web-$version" | grep -o 'libllvm[0-9]*' | head -n 1)
    apt-get download rustc-web cargo-web rust-web-src libstd-rust-web-dev "libstd-rust-web-$version" "$llvm" libgit2-1.5 >&2
    for package in ./*.deb; do
        dpkg -x "$package" .
    done
    rm -- ./*.deb
fi
echo "export CARGO='$folder/usr/bin/cargo' RUSTC='$folder/usr/bin/rustc'"
echo "export LD_LIBRARY_PATH='$folder/usr/lib/$(uname -m)-linux-gnu'"
