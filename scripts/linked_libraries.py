"""Prints the shared libraries that a program loads, apart from those of glibc, each with its Debian package.
usage: linked_libraries.py PROGRAM

glibc is taken from the machine, because its libraries must match each other and the kernel's loader.
"""
import pathlib
import re
import subprocess
import sys

GLIBC = re.compile(r"(ld-linux[^/]*|lib(c|m|dl|rt|pthread|resolv|util|anl|nss_[a-z]+|BrokenLocale))\.so[.0-9]*$")


def packages_of(files):
    """Returns the Debian package of each file. /lib and /usr/lib are the same folder, and dpkg knows a file under only one of
    the two names."""
    names = {file: str(pathlib.Path(file).resolve()) for file in files}
    asked = {name for resolved in names.values() for name in (resolved, resolved.removeprefix("/usr"))}
    found = subprocess.run(["dpkg-query", "-S", *sorted(asked)], capture_output=True, text=True, check=False).stdout
    owners = {path.removeprefix("/usr"): package.partition(":")[0]
              for package, _, path in (line.rpartition(": ") for line in found.splitlines())}
    for file, resolved in names.items():
        if resolved.removeprefix("/usr") not in owners:
            raise SystemExit(f"linked_libraries: {file}: no Debian package has this file, so its licence is unknown")
    return {file: owners[resolved.removeprefix("/usr")] for file, resolved in names.items()}


def libraries_of(program):
    """Returns the paths of the shared libraries that a program loads, direct and indirect ones, without those of glibc."""
    loaded = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    missing = re.findall(r"^\s*(\S+) => not found", loaded, re.MULTILINE)
    if missing:
        raise SystemExit(f"linked_libraries: {program}: not found: {', '.join(missing)}")
    return [path for path in re.findall(r" => (/\S+)", loaded) if not GLIBC.match(pathlib.Path(path).name)]


def highest_glibc(binary):
    """Returns the highest version of glibc that the symbols of a binary ask for: (2, 35)."""
    needs = subprocess.run(["readelf", "-VW", binary], capture_output=True, text=True, check=True).stdout
    return max((tuple(map(int, found.split("."))) for found in re.findall(r"GLIBC_([\d.]+)", needs)), default=(0,))


if __name__ == "__main__":
    for library, package in packages_of(libraries_of(sys.argv[1])).items():
        print(library, package)
