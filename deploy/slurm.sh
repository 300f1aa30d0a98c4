#!/bin/sh
#SBATCH --job-name=trade-study
#SBATCH --cpus-per-task=2
#SBATCH --mem=2G
#SBATCH --time=04:00:00
#SBATCH --requeue
# One part of a study in each task of an array: sbatch --array=1-8 deploy/slurm.sh DIR [options of compare]
set -eu
out=$1
shift
program=${TRADE_HARNESS:-target/release/trade-harness}
exec "$program" compare "$@" --no-build --quiet --jobs "${SLURM_CPUS_PER_TASK:-1}" --resume \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --out "$out"
