#!/usr/bin/env bash
# Studies in parts, by xargs and by Dask with a worker killed half-way: the bytes of the whole.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/common/environment.sh

work=target/deploy
here=tests/deploy
python=$work/venv/bin/python
rm -rf "$work/whole" "$work/xargs" "$work/dask"
mkdir -p "$work"
cargo build --release --quiet --package trade-harness
program=${CARGO_TARGET_DIR:-target}/release/trade-harness
"$program" pack --quiet >/dev/null
study=(--scenario leo_venting --filters snc,fixed_q --runs 60)
"$program" compare "${study[@]}" --no-build --quiet --out "$work/whole" >/dev/null

echo "# xargs"
deploy/xargs.sh 4 "$work/xargs" "${study[@]}" >/dev/null
python3 "$here/same.py" "$work/whole" "$work/xargs"

environment "$work" "$here/requirements.txt" Dask
echo "# Dask, one of two workers killed half-way"
"$python" deploy/dask_study.py --parts 6 --workers 2 "$work/dask" "${study[@]}" >"$work/dask.log" 2>"$work/dask.err" &
dask=$!
until grep -q "part .* is done" "$work/dask.log"; do
    kill -0 "$dask" || { cat "$work/dask.err"; exit 1; }
    sleep 0.1
done
victim=$(sed -n 's/^worker //p' "$work/dask.log" | head -n 1)
kill -9 "$victim"
wait "$dask" || { cat "$work/dask.err"; exit 1; }
python3 "$here/same.py" "$work/whole" "$work/dask"
echo "# all of it agrees"
