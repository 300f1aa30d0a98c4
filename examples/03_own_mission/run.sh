#!/usr/bin/env bash
# Checks a mission that is a file and nothing else, then studies filters in it. HARNESS may name the program; OUT the folder.
set -euo pipefail
cd "$(dirname "$0")/../.."
read -r -a harness <<<"${HARNESS:-cargo run --release --quiet --package trade-harness --}"
mission=examples/03_own_mission/station_flyaround.toml

"${harness[@]}" mission check "$mission" ${HARNESS_FLAGS:-}
"${harness[@]}" compare --mission "$mission" --runs "${RUNS:-10}" --out "${OUT:-results/own_mission}" ${HARNESS_FLAGS:-}
