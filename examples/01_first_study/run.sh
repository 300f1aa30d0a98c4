#!/usr/bin/env bash
# Three filters, ten runs, low Earth orbit. HARNESS may name the program; OUT the folder of the results.
set -euo pipefail
cd "$(dirname "$0")/../.."
read -r -a harness <<<"${HARNESS:-cargo run --release --quiet --package trade-harness --}"

"${harness[@]}" compare --scenario leo_venting --filters snc,fixed_q@small,milton --runs "${RUNS:-10}" \
    --out "${OUT:-results/first_study}" ${HARNESS_FLAGS:-}
