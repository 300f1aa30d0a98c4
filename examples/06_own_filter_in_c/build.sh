#!/usr/bin/env bash
# Packs the filter: build.sh [FILE.fmu]. Needs a C compiler and Python (for its zip module alone).
set -euo pipefail
target=$(realpath -m "${1:-direct_inversion.fmu}")
cd "$(dirname "${BASH_SOURCE[0]}")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

case "$(uname -s)-$(uname -m)" in
    Darwin-*) binary=binaries/darwin64/direct_inversion.dylib ;;
    Linux-aarch64) binary=binaries/aarch64-linux/direct_inversion.so ;;
    *) binary=binaries/linux64/direct_inversion.so ;;
esac
mkdir -p "$work/$(dirname "$binary")"
"${CC:-cc}" -O2 -Wall -Werror -shared -fPIC -o "$work/$binary" direct_inversion.c -lm
cp modelDescription.xml "$work"
rm -f "$target"
(cd "$work" && python3 -m zipfile -c "$target" modelDescription.xml binaries)
