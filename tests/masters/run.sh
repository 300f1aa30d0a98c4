#!/usr/bin/env bash
# The longer tier with other people's tools: other masters fly our FMUs, a filter made with PythonFMU takes the place of
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
ours=(--no-build --fmu-dir "$work/fmu")

if ! cmp --silent "$here/requirements.txt" "$work/venv/requirements.txt"; then
    if python3 -m venv --clear "$work/venv"; then
        "$python" -m pip install --quiet --disable-pip-version-check --requirement "$here/requirements.txt"
        cp "$here/requirements.txt" "$work/venv/"
    fi
fi

if [ -x "$python" ]; then
    echo "# the same bits from every master, in open and in closed loop"
    example=examples/05_closed_loop
    for model in guidance life_support; do
        "$work/venv/bin/pythonfmu" build --file "$example/$model.py" --dest "$work/fmu" "$example/pulse.py" >"$work/pythonfmu.log"
    done
    "$python" "$here/equal.py" "$work" "${CARGO_TARGET_DIR:-target}/release/trade-harness --quiet ${ours[*]}" docs/masters.md

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
    skipped "other masters and PythonFMU" python3-venv
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
    BORDER_PERCENT=2 watched border a_million_hostile_calls
else
    skipped valgrind valgrind
fi
echo "# all of it agrees"
