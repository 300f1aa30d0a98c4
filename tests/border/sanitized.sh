#!/usr/bin/env bash
# The longer tier: a million calls in any order with any arguments, with both FMUs and what calls them built under AddressSanitizer.
# PERCENT=100 of them.
set -euo pipefail
cd "$(dirname "$0")/../.."

if ! compgen -G "$(rustc --print target-libdir)/librustc*_rt.asan.a" >/dev/null; then
    echo "SKIPPED AddressSanitizer: the toolchain has no librustc_rt.asan.a"
    exit 0
fi
# A sanitizer asks for a switch that a stable compiler has and keeps for itself; with a target named, what runs while it compiles
# is built without.
CARGO_BUILD_TARGET=$(rustc -vV | sed -n 's/^host: //p')
export CARGO_BUILD_TARGET RUSTC_BOOTSTRAP=1 RUSTFLAGS="-Zsanitizer=address -Clink-arg=-Wl,--export-dynamic" CARGO_TARGET_DIR="$PWD/target/sanitized"
# Leaks are looked for by valgrind and counted by the ordinary test.
ASAN_OPTIONS=detect_leaks=0 BORDER_PERCENT=${PERCENT:-100} \
    cargo test --release --test border a_million_hostile_calls -- --nocapture
