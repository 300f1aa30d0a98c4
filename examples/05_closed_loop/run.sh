#!/usr/bin/env bash
# Guidance and life support in Python, packed as FMUs and flown with fmu-truth and fmu-nav: with FMPy, as a table and a figure, as an SSP
# archive, and as a study of the harness. Exit code 1 if the loop does not hold its point.
# HARNESS may name the program, FMUS the folder of FMUs that are packed already, OUT that of the results, RUNS the runs of the study.
# With QUICK=1 one flight and one filter, and no figure.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/common/environment.sh
read -r -a harness <<<"${HARNESS:-cargo run --release --quiet --package trade-harness --}"
read -r -a flags <<<"${HARNESS_FLAGS:-}"
here=examples/05_closed_loop
out=${OUT:-results/closed_loop}
work=target/closed_loop
mapfile -t settings <"$here/settings.txt"
python=$work/venv/bin/python
mkdir -p "$work" "$out"
environment "$work" "$here/requirements.txt" "$here"

if [ -z "${FMUS:-}" ]; then
    "${harness[@]}" pack --quiet >/dev/null
    FMUS=target/fmu
fi
cp "$FMUS/fmu-truth.fmu" "$FMUS/fmu-nav.fmu" "$out"
for model in guidance life_support; do
    "$work/venv/bin/pythonfmu" build --file "$here/$model.py" --dest "$out" "$here/pulse.py" >"$work/pythonfmu.log"
done

# One file for any tool that reads SSP. Truth, filter, guidance: the order of a Gauss-Seidel master.
"$python" "$here/ssp.py" "$out/closed_loop.ssp" "$out"/{fmu-truth,fmu-nav,Guidance,LifeSupport}.fmu \
    "${settings[@]}"

if [ -n "${QUICK:-}" ]; then
    "$python" "$here/closed_loop.py" --fmus "$out" --quick
    filters=snc
else
    "$python" "$here/closed_loop.py" --fmus "$out" --svg "$here/closed_loop.svg" --document "$here/README.md"
    filters=snc,hybrid
fi

# PythonFMU's library takes Python from the program that loads it, so the harness must bring one.
interpreter=$("$python" -c 'import os, sysconfig as s; print(os.path.join(*s.get_config_vars("LIBDIR", "LDLIBRARY")))')
if [ -f "$interpreter" ] && [[ $interpreter == *.so* ]]; then
    "${harness[@]}" compare --scenario leo_venting --filters "$filters" --runs "${RUNS:-5}" \
        --drive "guide=$out/Guidance.fmu" --drive "life=$out/LifeSupport.fmu" --preload "$interpreter" \
        "${settings[@]/#/--set=}" --out "$out/study" "${flags[@]}"
else
    echo "SKIPPED the study of $here: needs the system package libpython3-dev"
fi
