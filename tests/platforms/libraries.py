"""Looks into the libraries of an archive for every platform, with tools that only read.

    libraries.py ARCHIVE WORD...

Fails where a library asks for a newer system than promised, exports more than FMI, takes an elementary function from the system, is
not stripped, or holds one of the WORDs: folders of the machine that built it.
"""

import re
import struct
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

# Functions of a C library whose bits differ between systems. fmod is exact and may stay.
ELEMENTARY = """acos acosh asin asinh atan atan2 atanh cbrt cos cosh exp exp10 exp2 expm1 hypot log log10 log1p log2 pow sin sincos
    sinh tan tanh __sincos_stret __sincos __exp10""".split()
GLIBC = (2, 17)
MACOS = {0x0100_0007: ("x86_64", (10, 12)), 0x0100_000C: ("arm64", (11, 0))}

faults = []


def fault(library, what):
    faults.append(f"{library}: {what}")


def said(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def check_exports(library, exports):
    fmi = set()
    for version in "fmi2", "fmi3":
        of_version = {name for name in exports if name.startswith(version)}
        fmi |= of_version
        if len(of_version) < 30:
            fault(library, f"exports {len(of_version)} functions of {version} only")
    if others := sorted(set(exports) - fmi):
        fault(library, f"exports {', '.join(others)}")


def check_imports(library, imports):
    if theirs := sorted(set(imports) & set(ELEMENTARY)):
        fault(library, f"takes {', '.join(theirs)} from the system")


def elf(library, path):
    imports, exports, newest = [], [], (0, 0)
    for line in said("objdump", "-T", path).splitlines():
        if "*UND*" in line:
            imports.append(line.split()[-1])
        elif re.match(r"[0-9a-f]{16} ", line):
            exports.append(line.split()[-1])
        for version in re.findall(r"GLIBC_([0-9.]+)", line):
            newest = max(newest, tuple(map(int, version.split("."))))
    if newest > GLIBC:
        fault(library, f"needs glibc {'.'.join(map(str, newest))}")
    check_exports(library, exports)
    check_imports(library, imports)
    if ".symtab" in said("readelf", "-SW", path):
        fault(library, "is not stripped")
    needed = re.findall(r"NEEDED.*\[(.*)\]", said("readelf", "-d", path))
    return f"glibc {'.'.join(map(str, newest))}; needs {', '.join(needed)}"


def pe(library, path):
    text = said("x86_64-w64-mingw32-objdump", "-p", path)
    table = text.split("[Ordinal/Name Pointer] Table", 1)[1]
    exports = re.findall(r"^\s*\[ *\d+\].*?([A-Za-z_]\w*)\s*$", table, re.M)
    check_exports(library, exports)
    imports = text.split("The Import Tables", 1)[1].split("The Export Tables", 1)[0]
    check_imports(library, re.findall(r"^\s+[0-9a-f]+\s+\d+\s+(\S+)\s*$", imports, re.M))
    if not re.search(r"Time/Date\s.*1970", text):
        fault(library, "knows when it was made")
    major, minor = (re.search(rf"{part}SubsystemVersion\s+(\d+)", text)[1] for part in ("Major", "Minor"))
    needed = sorted(set(re.findall(r"DLL Name: (\S+)", text)))
    return f"subsystem of Windows {major}.{minor}; needs {', '.join(needed)}"


def mach_o(library, data):
    """One processor's part of a library for macOS, read by Apple's <mach-o/loader.h>."""
    magic, processor, _, kind, commands, _, _, _ = struct.unpack_from("<8I", data)
    name, least = MACOS[processor]
    library = f"{library} ({name})"
    if (magic, kind) != (0xFEEDFACF, 6):
        fault(library, "is no 64-bit dynamic library")
    at, needed, minimum, signed, imports, exports, debugging = 32, [], None, False, [], [], 0
    for _ in range(commands):
        command, size = struct.unpack_from("<2I", data, at)
        text = lambda offset: data[at + offset : at + size].split(b"\0")[0].decode()
        if command in (0xC, 0x80000018, 0x8000001F):
            needed.append(text(struct.unpack_from("<I", data, at + 8)[0]))
        elif command == 0xD:
            own = text(struct.unpack_from("<I", data, at + 8)[0])
            if not own.startswith("@rpath/"):
                fault(library, f"is named {own}")
        elif command == 0x24:
            (version,) = struct.unpack_from("<I", data, at + 8)
            minimum = version >> 16, version >> 8 & 255
        elif command == 0x32:
            (version,) = struct.unpack_from("<I", data, at + 12)
            minimum = version >> 16, version >> 8 & 255
        elif command == 0x1D:
            signed = True
        elif command == 2:
            table, count, strings, _ = struct.unpack_from("<4I", data, at + 8)
            for k in range(count):
                index, type_, _, _, _ = struct.unpack_from("<IBBHQ", data, table + 16 * k)
                symbol = data[strings + index :].split(b"\0", 1)[0].decode()
                if type_ & 0xE0:
                    debugging += 1
                elif not type_ & 1:
                    continue
                elif type_ & 0x0E == 0:
                    imports.append(symbol.removeprefix("_"))
                elif not type_ & 0x10:
                    exports.append(symbol.removeprefix("_"))
        at += size
    if minimum is None or minimum > least:
        fault(library, f"needs macOS {minimum}, not {least}")
    if name == "arm64" and not signed:
        fault(library, "is not signed, which arm64 refuses to load")
    if others := [lib for lib in needed if not lib.startswith("/usr/lib/")]:
        fault(library, f"needs {', '.join(others)}")
    # Names are looked up in the library that they were linked from, so that these are taken by nobody else.
    if not struct.unpack_from("<I", data, 24)[0] & 0x80:
        fault(library, "has one name space with its host")
    # Zig's linker exports every function that is not hidden, Rust's own names too.
    check_exports(library, [name for name in exports if name.startswith(("fmi2", "fmi3"))])
    check_imports(library, imports)
    if debugging:
        fault(library, f"holds {debugging} symbols for debuggers")
    return f"{name}: macOS {minimum[0]}.{minimum[1]}; needs {', '.join(needed)}"


def universal(library, data):
    magic, count = struct.unpack_from(">2I", data)
    if magic != 0xCAFEBABE:
        fault(library, "is not universal")
        return ""
    parts = [struct.unpack_from(">5I", data, 8 + 20 * k) for k in range(count)]
    if {part[0] for part in parts} != set(MACOS):
        fault(library, "is not for both processors")
    return "; ".join(mach_o(library, data[offset : offset + size]) for _, _, offset, size, _ in parts)


def main():
    archive, words = Path(sys.argv[1]), sys.argv[2:]
    with zipfile.ZipFile(archive) as files, tempfile.TemporaryDirectory() as folder:
        for name in files.namelist():
            if not name.startswith("binaries/"):
                continue
            data = files.read(name)
            path = files.extract(name, folder)
            _, platform, file = name.split("/")
            library = f"{platform}/{file}"
            if platform == "win64":
                told = pe(library, path)
            elif platform == "darwin64":
                told = universal(library, data)
            else:
                told = elf(library, path)
            for word in words:
                if word.encode() in data or word.encode("utf-16-le") in data:
                    at = max(data.find(word.encode()), 0)
                    fault(library, f"holds {data[at : at + 120]!r}")
            print(f"{library}: {len(data) / 1e6:.1f} MB; {told}")
    if faults:
        sys.exit("\n".join(faults))


main()
