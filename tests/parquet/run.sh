#!/usr/bin/env bash
# Histories as Parquet files, read by pandas and polars, beside the CSV files.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/common/environment.sh

work=target/parquet
here=tests/parquet
python=$work/venv/bin/python
rm -rf "$work/leo_venting" "$work/formation" "$work"/replay_*
mkdir -p "$work"
environment "$work" "$here/requirements.txt" Parquet
harness() { cargo run --release --quiet --package trade-harness --features parquet -- "$@" >/dev/null; }
# Filters with each kind of column: without a covariance, with rows of the six of a metrology, without an acceleration.
compare() {
    harness compare --scenario "$1" --filters "$2" --runs 2 --duration 600 --quiet --out "$work/$1" || [ $? -eq 1 ]
    harness report "$work/$1" --parquet --quiet
    for file in csv parquet; do
        harness replay "$work/$1" --run 1 --out "$work/replay_$1.$file"
    done
}
compare leo_venting snc,milton
compare formation snc,observer
"$python" "$here/same.py" "$work"/*.parquet "$work"/*/*/*.parquet
