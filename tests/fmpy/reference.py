"""Let FMPy repeat the reference results that FMUs have inside: reference.py FMU...

Prints, for each, the rows and columns compared and how many values have other bits; ends at the first that is off.
"""

import io
import sys
import tempfile
import zipfile
from pathlib import Path

import numpy as np
from fmpy import read_model_description, simulate_fmu
from fmpy.util import read_csv, read_ref_opt_file


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
            columns = [column for column in reference.dtype.names if column != "time"]
            shown, sys.stdout = sys.stdout, io.StringIO()  # FMPy prints which inputs the file leaves out
            try:
                result = simulate_fmu(
                    path,
                    start_time=options["StartTime"],
                    stop_time=options["StopTime"],
                    step_size=options["StepSize"],
                    output_interval=options["OutputIntervalLength"],
                    input=read_csv(given) if given.exists() else None,
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
