"""A study in parts on a Dask cluster; a part whose worker dies is taken up by another and goes on where it stood."""

import argparse
import os
import subprocess
import time

from dask.distributed import Client, LocalCluster, as_completed

PROGRAM = os.environ.get("TRADE_HARNESS", "target/release/trade-harness")


def part(number: int, parts: int, out: str, options: list[str]) -> int:
    """Does one part; returns its number."""
    command = [PROGRAM, "compare", *options, "--no-build", "--quiet", "--jobs", "1"]
    command += ["--resume", "--shard", f"{number}/{parts}", "--out", out]
    while True:
        done = subprocess.run(command, capture_output=True, text=True)
        # What a dead worker has left may still be at it.
        if done.returncode == 2 and "in use" in done.stderr:
            time.sleep(0.5)
            continue
        if done.returncode != 0:
            raise RuntimeError(f"part {number}: {done.stderr.strip()}")
        return number


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--parts", type=int, default=8)
    parser.add_argument("--scheduler", help="address of a running cluster; without it, one on this machine")
    parser.add_argument("--workers", type=int, default=2, help="of a cluster on this machine")
    parser.add_argument("out", help="folder of the study")
    arguments, options = parser.parse_known_args()
    if arguments.scheduler:
        client = Client(arguments.scheduler)
    else:
        client = Client(LocalCluster(n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None))
    with client:
        for worker in client.run(os.getpid).values():
            print(f"worker {worker}", flush=True)
        numbers = range(1, arguments.parts + 1)
        futures = [client.submit(part, n, arguments.parts, arguments.out, options, retries=10, pure=False) for n in numbers]
        for finished, future in enumerate(as_completed(futures), start=1):
            print(f"part {future.result()} is done, {finished} of {arguments.parts}", flush=True)
    subprocess.run([PROGRAM, "merge", arguments.out], check=True)


if __name__ == "__main__":
    main()
