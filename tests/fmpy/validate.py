"""Let FMPy look for faults in FMUs: validate.py FMU...

Prints every message FMPy has about an FMU and exits with 1 if there is one.
"""

import sys

from fmpy import read_model_description
from fmpy.validation import validate_fmu


def main(paths):
    faults = 0
    for path in paths:
        # Schema first, then FMPy's own rules on names, units, initial values and the model structure.
        description = read_model_description(path, validate=True)
        for message in validate_fmu(path):
            print(f"{path}: {message}")
            faults += 1
        print(f"{path}: {description.modelName}, {len(description.modelVariables)} variables, FMI {description.fmiVersion}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
