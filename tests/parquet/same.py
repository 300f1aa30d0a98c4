"""Holds Parquet files beside the CSV files that they were made of, read by pandas and by polars.

same.py FILE.parquet... : beside each stands FILE.csv. Every number must be the same to the last bit, every text the same.
"""

import sys
from pathlib import Path

import pandas
import polars

TEXT = {"filter", "status"}
WHOLE = {"sample", "measured", "run", "runs", "nis_runs"}


def kind(name):
    if name in TEXT:
        return "text"
    whole = name in WHOLE or (name.startswith("meas_") and name.endswith("_valid"))
    return "whole" if whole else "number"


def expected(path):
    """Columns of the CSV file, read by Python alone."""
    import csv

    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    read = {"text": str, "whole": int, "number": float}
    return {
        name: [read[kind(name)](row[name]) if row[name] else None for row in rows] for name in rows[0]
    }


def check(path):
    columns = expected(path.with_suffix(".csv"))
    by_polars = polars.read_parquet(path)
    by_pandas = pandas.read_parquet(path)
    assert by_polars.columns == list(columns) == list(by_pandas.columns), path
    types = {"text": polars.String, "whole": polars.Int64, "number": polars.Float64}
    cells = 0
    for name, values in columns.items():
        assert by_polars[name].dtype == types[kind(name)], (path, name)
        assert by_polars[name].to_list() == values, (path, name)
        seen = [None if pandas.isna(value) else value for value in by_pandas[name]]
        assert seen == values, (path, name)
        cells += len(values)
    return cells


paths = [Path(argument) for argument in sys.argv[1:]]
assert paths, "no file"
print(f"{len(paths)} files, {sum(map(check, paths))} cells: pandas and polars read what the CSV files hold")
