#!/usr/bin/env bash
# Adds the law of this folder to a copy of the workspace, runs every test that loops over filters, and studies it beside snc.
# RUNS and OUT as in the other examples. The copy is removed afterwards.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
out=$(realpath -m "${OUT:-$root/results/own_law}")
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
git -C "$root" ls-files -z | (cd "$root" && xargs -0 cp --parents -t "$copy")
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$root/target/own_law}
cd "$copy"

# One file, and its two lines: the module and the registry.
cp "$root/examples/02_own_law/covariance_matching.rs" crates/filters/src/laws/
sed -i 's/^mod dmc;/mod covariance_matching;\n&/' crates/filters/src/laws/mod.rs
sed -i '/^registry! {/,/^}/ s/^}/    CovarianceMatching => covariance_matching;\n&/' crates/filters/src/laws/registry.rs

UPDATE_GOLDEN=1 cargo test --release --quiet --package fmu-nav
cargo test --release --quiet --package filters --test all_filters
cargo run --release --quiet --package trade-harness -- compare --workspace "$copy" --scenario leo_venting \
    --filters snc,covariance_matching --runs "${RUNS:-10}" --out "$out"
