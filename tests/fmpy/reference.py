"""Let FMPy repeat the reference results that FMUs have inside: reference.py FMU...

Prints, for each, the rows and columns compared and how many values have other bits; ends at the first that is off.
"""

import csv
import io
import sys
import tempfile
import zipfile
from pathlib import Path

import numpy as np
from fmpy import read_model_description, simulate_fmu
from fmpy.util import read_ref_opt_file
from couple import slave


def read_csv(path):
    """A table of the rules. FMPy's own reader takes the comma within "m[1,2]" for the end of a name."""
    with open(path, newline="") as file:
        names, *rows = csv.reader(file)
    cells = [[tuple(map(float, cell.split(" "))) for cell in row] for row in rows]
    kinds = [(name, float, (len(cell),) if len(cell) > 1 else ()) for name, cell in zip(names, cells[0])]
    return np.array([tuple(c if len(c) > 1 else c[0] for c in row) for row in cells], dtype=kinds)


def stepped(path, options, given, columns):
    """What FMPy's simulate_fmu does, for arrays that change from step to step: its search for events knows scalars alone."""
    fmu = slave(path, "reference")
    kinds = {"Boolean": bool, "Int32": int, "Float64": float}

    def hand_over(row):
        for name in given.dtype.names[1:]:
            kind = kinds[fmu.variables[name].type]
            fmu.set(name, [kind(value) for value in np.atleast_1d(row[name])])

    hand_over(given[0])
    fmu.start()
    step = options["StepSize"]
    rows = [(options["StartTime"], *(fmu.get(column) for column in columns))]
    for k in range(round(options["StopTime"] / step)):
        hand_over(given[k])
        fmu.fmu.doStep(k * step, step)
        rows.append(((k + 1) * step, *(fmu.get(column) for column in columns)))
    fmu.close()
    return dict(zip(["time", *columns], zip(*rows)))


def main(paths):
    for path in paths:
        name = read_model_description(path).modelName
        with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(path) as archive:
            inside = f"documentation/reference/{name}"
            archive.extractall(folder, [f for f in archive.namelist() if f.startswith(inside)])
            base = Path(folder) / inside
            options = read_ref_opt_file(f"{base}_ref.opt")
            reference = read_csv(f"{base}_ref.csv")
            given = Path(f"{base}_in.csv")
            inputs = read_csv(given) if given.exists() else None
            columns = [column for column in reference.dtype.names if column != "time"]
            arrays = inputs is not None and any(inputs[column].ndim > 1 for column in inputs.dtype.names)
            shown, sys.stdout = sys.stdout, io.StringIO()  # FMPy prints which inputs the file leaves out
            try:
                result = stepped(path, options, inputs, columns) if arrays else simulate_fmu(
                    path,
                    start_time=options["StartTime"],
                    stop_time=options["StopTime"],
                    step_size=options["StepSize"],
                    output_interval=options["OutputIntervalLength"],
                    input=inputs,
                    output=columns,
                )
            finally:
                sys.stdout = shown
        others = 0
        for column in ["time", *columns]:
            ours, theirs = (np.asarray(table[column], dtype=float) for table in (reference, result))
            assert ours.shape == theirs.shape, (column, ours.shape, theirs.shape)
            others += np.count_nonzero(ours != theirs)
            assert np.allclose(ours, theirs, rtol=1e-12, atol=0.0), column
            assert column == "est.dimension" or np.ptp(theirs) > 0.0, f"{column} never changes"
        print(f"{name}: {len(reference)} rows, {len(columns)} columns, {others} other bits")


if __name__ == "__main__":
    main(sys.argv[1:])
