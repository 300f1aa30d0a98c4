#!/usr/bin/env bash
# Feeds every reader of files with what nobody should have written: libFuzzer with AddressSanitizer over each target of fuzz/.
# RUNS=20000 inputs for each target, or those in TARGETS. An input that breaks a reader stays in target/fuzz/broken/TARGET/; mend
# the reader and keep the input in fuzz/regressions/TARGET/, from where the ordinary tests feed it for ever.
set -euo pipefail
cd "$(dirname "$0")/../.."

runs=${RUNS:-20000}
out=$PWD/target/fuzz
tools=$PWD/target/tools
skip() {
    echo "SKIPPED fuzzing: $1"
    exit 0
}

command -v c++ >/dev/null || skip "libFuzzer is C++, needs the system package g++"
PATH=$tools/bin:$PATH
if ! command -v cargo-fuzz >/dev/null; then
    cargo install --quiet --locked --root "$tools" cargo-fuzz || skip "needs the tool cargo-fuzz (cargo install cargo-fuzz)"
fi
# The versions of the workspace, and libFuzzer beside them.
cp Cargo.lock fuzz/Cargo.lock
cargo fetch --quiet --manifest-path fuzz/Cargo.toml || skip "needs the crate libfuzzer-sys (cargo fetch --manifest-path fuzz/Cargo.toml)"

# A sanitizer asks for switches that a stable compiler has and keeps for itself.
export RUSTC_BOOTSTRAP=1 CARGO_TARGET_DIR=$out
sanitizer=address
if ! compgen -G "$(rustc --print target-libdir)/librustc*_rt.asan.a" >/dev/null; then
    echo "SKIPPED AddressSanitizer: the toolchain has no librustc_rt.asan.a; fuzzing without it"
    sanitizer=none
fi
cargo fuzz build --fuzz-dir fuzz --sanitizer "$sanitizer"
host=$(rustc -vV | sed -n 's/^host: //p')

# Seeds are made by the code that the tests use, in the target folder of the ordinary builds.
env -u RUSTC_BOOTSTRAP -u CARGO_TARGET_DIR cargo run --quiet --release -p hostile-files --example seeds -- "$out/seeds"

# Readers are given files: in memory they are there in no time.
if [ -d /dev/shm ] && [ -w /dev/shm ]; then
    TMPDIR=$(mktemp -d /dev/shm/fuzz-XXXXXX)
    export TMPDIR
    trap 'rm -rf "$TMPDIR"' EXIT
fi

broken=0
for target in ${TARGETS:-$(cargo fuzz list --fuzz-dir fuzz)}; do
    mkdir -p "$out/found/$target" "$out/broken/$target"
    folders=("$out/found/$target" "$out/seeds/$target")
    for kept in fuzz/corpus/$target fuzz/regressions/$target; do
        [ -d "$kept" ] && folders+=("$kept")
    done
    log=$out/$target.log
    if "$out/$host/release/$target" "${folders[@]}" -runs="$runs" -max_len=20000 -timeout=20 -rss_limit_mb=2048 \
        -malloc_limit_mb=512 -artifact_prefix="$out/broken/$target/" >"$log" 2>&1; then
        echo "$target: $(sed -n 's/^Done \([0-9]*\) runs in \([0-9]*\) second(s)$/\1 inputs in \2 s, no fault/p' "$log")"
    else
        echo "$target: BROKEN by a file in $out/broken/$target; the end of $log:"
        tail -n 30 "$log"
        broken=1
    fi
done
exit "$broken"
