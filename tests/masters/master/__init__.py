"""Other people's masters, one module each.

A module says its SCHEMES (name in the table, and its order: gauss-seidel or jacobi), the `version` of the tool, and
`points`: what a case reads, at the end of each communication step.
"""

MODULES = ("fmpy_loop", "fmpy_ssp", "libcosim", "ecos", "fmucontainer")
# Without a module: they cannot be had from a package registry.
NOT_HERE = {
    "OMSimulator": "its package on PyPI holds no library and downloads one from elsewhere as it is installed",
    "PyFMI": "its package on PyPI is source for Python 2 that needs FMI Library and Assimulo, which no package brings",
}
