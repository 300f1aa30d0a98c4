# The virtual environment of a test: sourced by scripts that stand in the project's folder.

# environment WORK REQUIREMENTS TEST: makes WORK/venv with what the file REQUIREMENTS names, unless it is there already. Where
# that is not possible, the script ends, saying that TEST is SKIPPED.
environment() {
    local work=$1 requirements=$2 test=$3
    if cmp --silent "$requirements" "$work/venv/requirements.txt"; then
        return
    fi
    if ! python3 -m venv --clear "$work/venv"; then
        echo "SKIPPED $test: needs the system package python3-venv"
        exit 0
    fi
    "$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$requirements"
    cp "$requirements" "$work/venv/requirements.txt"
}
