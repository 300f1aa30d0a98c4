#!/usr/bin/env bash
# The longer tier: one archive for every platform. It is packed in two folders of different name and must be the same bytes; its
# libraries are looked into; and what can be run here (Windows under wine, arm64 under qemu) must give the bits of this machine, for
# every filter in every mission. Writes the table of docs/platforms.md. What lacks a package says SKIPPED and which.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/common/environment.sh

work=$PWD/target/platforms
here=tests/platforms
steps=${STEPS:-600}
mkdir -p "$work"
skipped() { echo "SKIPPED $1: needs $2"; }

environment "$work" "$here/requirements.txt" "every platform"
export PATH="$work/venv/bin:$PATH"
cargo build --release --quiet --package trade-harness
harness=$(realpath "${CARGO_TARGET_DIR:-target}")/release/trade-harness
# Before another compiler is taken: this machine's own library is one of those compared.
"$harness" pack --quiet --out "$work/native" >/dev/null
# The other folder is no repository that could say when the commit was made.
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH
# Both folders use one, so that only what is ours is compiled twice.
export CARGO_TARGET_DIR="$work/cargo"
# Cargo takes objects for fresh that were made with other names for paths.
rm -rf "$work/cargo"
pack() { "$harness" pack --quiet "$@" >/dev/null; }

if [ -z "${RUSTC:-}" ] && ! [ -d "$(rustc --print sysroot)/lib/rustlib/aarch64-apple-darwin" ]; then
    if exports=$(deploy/debian_rust.sh "$work/rust" 2>"$work/rust.log"); then
        eval "$exports"
    else
        echo "no other compiler than this machine's: $(tail -n 1 "$work/rust.log")"
    fi
fi

platforms=
absent=()
for platform in linux64 win64 darwin64 aarch64-linux; do
    echo "# $platform"
    if pack --platforms "$platform" --out "$work/$platform" 2>"$work/$platform.log"; then
        platforms+=,$platform
    elif grep -q 'cannot build for every platform' "$work/$platform.log"; then
        absent+=("$platform=")
        skipped "$platform" "what is said here: $(cat "$work/$platform.log")"
    else
        tail -n 30 "$work/$platform.log"
        exit 1
    fi
done
platforms=${platforms#,}
if [ -z "$platforms" ]; then
    exit 0
fi

echo "# one archive of $platforms, the same from two folders"
pack --platforms "$platforms" --out "$work/one"
other="$work/a folder of another name"
rm -rf "$other"
mkdir -p "$other"
git ls-files -z --cached --others --exclude-standard | tar -c --null --files-from=- | tar -x -C "$other"
pack --platforms "$platforms" --out "$work/other" --workspace "$other"
for fmu in fmu-truth fmu-nav; do
    cmp "$work/one/$fmu.fmu" "$work/other/$fmu.fmu"
    python3 "$here/libraries.py" "$work/one/$fmu.fmu" "$PWD" "$other" "$work" "$HOME" "${CARGO_HOME:-$HOME/.cargo}"
    mkdir -p "$work/fmus/$fmu"
    (cd "$work/fmus/$fmu" && python3 -m zipfile -e "$work/one/$fmu.fmu" . && python3 -m zipfile -e "$work/native/$fmu.fmu" ../"$fmu-native")
done

echo "# every filter in every mission, $steps steps"
python3 "$here/plan.py" "$work/fmus" "$steps" >"$work/plan.txt"
cc -O1 -std=c11 -o "$work/host" "$here/host.c" -ldl
libraries() { echo "$work/fmus/fmu-truth$2/binaries/$1/fmu_truth.$3" "$work/fmus/fmu-nav$2/binaries/$1/fmu_nav.$3"; }
ran=()
run() { # NAME COMMAND...
    local name=$1
    shift
    "$@" "$work/plan.txt" "$work/outputs.txt" && mv "$work/outputs.txt" "$work/outputs.$name.txt"
    ran+=("$name=$work/outputs.$name.txt")
}
# A folder's name must not have blanks here.
# shellcheck disable=SC2046
{
    run "this machine's" "$work/host" $(libraries linux64 -native so)
    for platform in ${platforms//,/ }; do
        case $platform in
        linux64) run linux64 "$work/host" $(libraries linux64 '' so) ;;
        win64)
            if command -v wine >/dev/null; then
                x86_64-w64-mingw32-gcc -O1 -std=c11 -o "$work/host.exe" "$here/host.c"
                export WINEPREFIX="$work/wine" WINEDEBUG=-all
                run win64 wine "$work/host.exe" $(libraries win64 '' dll)
            else
                skipped "running win64" "the system package wine64"
                ran+=("win64=")
            fi
            ;;
        aarch64-linux)
            if command -v qemu-aarch64 >/dev/null && [ -d /usr/aarch64-linux-gnu/lib ]; then
                python-zig cc -target aarch64-linux-gnu.2.17 -O1 -std=c11 -o "$work/host-aarch64" "$here/host.c" -ldl
                run aarch64-linux qemu-aarch64 -L /usr/aarch64-linux-gnu "$work/host-aarch64" $(libraries aarch64-linux '' so)
            else
                skipped "running aarch64-linux" "the system packages qemu-user and libc6-arm64-cross"
                ran+=("aarch64-linux=")
            fi
            ;;
        # Nothing runs it here.
        darwin64) ran+=("darwin64=") ;;
        esac
    done
}
python3 "$here/same.py" docs/platforms.md "$steps" "${ran[@]}" "${absent[@]}"
