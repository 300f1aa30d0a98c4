#!/usr/bin/env bash
# The longer tier with other people's tools: libcosim couples our FMUs, a filter made with PythonFMU takes the place of
# fmu-nav, the checker reads and runs public FMUs, and valgrind watches real life cycles. Results and the virtual environment
# stay in target/masters. What lacks a system package says SKIPPED and which.
set -euo pipefail
cd "$(dirname "$0")/../.."

work=target/masters
here=tests/masters
python=$work/venv/bin/python
mkdir -p "$work"
skipped() { echo "SKIPPED $1: needs the system package $2"; }

echo "# packing"
cargo build --release --quiet --package trade-harness
harness() { cargo run --release --quiet --package trade-harness -- "$@" --quiet; }
harness pack --out "$work/fmu"
truth=$work/fmu/fmu-truth.fmu
nav=$work/fmu/fmu-nav.fmu
ours=(--no-build --fmu-dir "$work/fmu")

if ! cmp --silent "$here/requirements.txt" "$work/venv/requirements.txt"; then
    if python3 -m venv --clear "$work/venv"; then
        "$python" -m pip install --quiet --disable-pip-version-check --requirement "$here/requirements.txt"
        cp "$here/requirements.txt" "$work/venv/"
    fi
fi

if [ -x "$python" ]; then
    echo "# libcosim: the same bits as the harness, in steps of 1 s and 0.25 s"
    settings=(fixed_q.s=3e-6 chaser.q_coupled=false)
    harness replay "${ours[@]}" --filters fixed_q "${settings[@]/#/--set=fmu-nav.}" --run 3 --seed 7 --out "$work/replay.csv"
    "$python" "$here/ssp.py" "$truth" "$nav" "$work/ssp" "${settings[@]/#/fmu-nav.}" \
        fmu-{truth,nav}.run=3 fmu-{truth,nav}.study_seed=7
    for step in 1 0.25; do
        "$python" "$here/cosim.py" "$work/ssp" "$step" 700 "$work/cosim.csv" >"$work/cosim.log" 2>&1 \
            || { tail -n 20 "$work/cosim.log"; exit 1; }
        # Values arrive one step late, so the last sample is not seen.
        "$python" "$here/same.py" "$work/cosim.csv" "$work/replay.csv" 699
    done

    echo "# PythonFMU: a stranger's filter in the study"
    # Its library takes Python from the program that loads it, so the harness must bring one.
    interpreter=$("$python" -c 'import os, sysconfig as s; print(os.path.join(*s.get_config_vars("LIBDIR", "LDLIBRARY")))')
    if [ -f "$interpreter" ] && [[ $interpreter == *.so* ]]; then
        "$work/venv/bin/pythonfmu" build --file examples/04_own_filter_in_python/direct_inversion.py --dest "$work" >"$work/pythonfmu.log"
        program=$(cargo build --release --quiet --package trade-harness --message-format json \
            | "$python" -c 'import json, sys; print([a["executable"] for a in map(json.loads, sys.stdin) if a.get("executable")][-1])')
        study() {
            "$program" compare "${ours[@]}" --preload "$interpreter" --quiet --runs 2 --filters fixed_q \
                --nav toy="$work/Toy.fmu" "$@"
        }
        # A study of earlier FMUs is another one.
        rm -rf "$work/toy" "$work/toy-stops"
        study --set fmu-truth.lidar.sigma_range=0 --set fmu-truth.lidar.sigma_angle=0 --out "$work/toy" >/dev/null
        # It fails in every run, which is an exit code of its own.
        study --set toy.stop_after=400 --out "$work/toy-stops" >/dev/null 2>"$work/toy.log" || [ $? = 1 ]
        "$python" "$here/toy_check.py" "$work/toy" "$work/toy-stops"
        echo "# check: FMUs of other people, and the one that PythonFMU has built"
        "$python" "$here/check_public.py" "$program" "$work/public" "$work/Toy.fmu"
    else
        skipped PythonFMU libpython3-dev
    fi
else
    skipped "libcosim and PythonFMU" python3-venv
fi

if command -v valgrind >/dev/null; then
    echo "# valgrind: life cycles, saved states, refused calls and hostile calls of both FMUs"
    watched() {
        test=$(cargo test --release --quiet --test "$1" --no-run --message-format json \
            | sed -n 's/.*"executable":"\([^"]*'"$1"'[^"]*\)".*/\1/p')
        valgrind --quiet --error-exitcode=1 --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite \
            --keep-debuginfo=yes --num-callers=40 --suppressions="$here/unloaded.supp" \
            "$test" --test-threads 1 "${@:2}"
    }
    watched lifecycle a_damaged_state mistakes_are_refused a_model_that_cannot
    ENDURANCE_PERCENT=2 watched border a_million_hostile_calls
else
    skipped valgrind valgrind
fi
echo "# all of it agrees"
