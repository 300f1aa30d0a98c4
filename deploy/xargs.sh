#!/bin/sh
# A study in parts on the cores of this machine: deploy/xargs.sh PARTS DIR [options of compare]
set -eu
parts=$1
out=$2
shift 2
program=${TRADE_HARNESS:-target/release/trade-harness}
seq 1 "$parts" | xargs -P "$(nproc)" -I '{}' \
    "$program" compare "$@" --no-build --quiet --jobs 1 --resume --shard '{}'/"$parts" --out "$out"
"$program" merge "$out"
