"""PEP 517 build backend: builds the module with CMake and packs it as a wheel.

RIGCAL_BUILD may name a build tree that already contains the module, such as build/release.
"""

from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def _version() -> str:
    found = re.search(r"project\(rigcal VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert found, "CMakeLists.txt names no version"
    return found[1]


def _built() -> pathlib.Path:
    """Returns the package folder that CMake built."""
    tree = os.environ.get("RIGCAL_BUILD")
    if not tree:
        tree = str(ROOT / "build" / "wheel")
        subprocess.run(
            ["cmake", "-S", ROOT, "-B", tree, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DRIGCAL_UNITY=ON",
             "-DRIGCAL_TESTS=OFF", "-DRIGCAL_PYTHON_REQUIRED=ON", f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", tree, "--target", "rigcal_python"], check=True)
    package = pathlib.Path(tree) / "python" / "rigcal"
    if not any(package.glob("_rigcal*.so")):
        raise SystemExit(f"{package}: found no compiled module; expected one made for {sys.executable}: it needs its headers, "
                         "pybind11 and NumPy (scripts/setup --dev)")
    return package


def _metadata() -> str:
    return (f"Metadata-Version: 2.1\nName: rigcal\nVersion: {_version()}\n"
            "Summary: Calibrates and validates models of servo-hydraulic rigs from recorded runs\n"
            "Requires-Python: >=3.9\nRequires-Dist: numpy\nProvides-Extra: notebook\n"
            "Requires-Dist: matplotlib; extra == 'notebook'\nRequires-Dist: pandas; extra == 'notebook'\n")


def build_wheel(wheel_directory: str, config_settings: object = None, metadata_directory: str | None = None) -> str:
    package = _built()
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    about = f"rigcal-{_version()}.dist-info"
    contents = {f"rigcal/{file.name}": file.read_bytes() for file in sorted(package.iterdir()) if file.is_file()}
    contents[f"{about}/METADATA"] = _metadata().encode()
    contents[f"{about}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: rigcal\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    contents[f"{about}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = ""
    for path, content in contents.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{path},sha256={digest},{len(content)}\n"
    contents[f"{about}/RECORD"] = (record + f"{about}/RECORD,,\n").encode()
    name = f"rigcal-{_version()}-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in contents.items():
            wheel.writestr(path, content)
    return name


def build_sdist(sdist_directory: str, config_settings: object = None) -> str:
    raise SystemExit("a source archive is `git archive`; expected `pip install .` or `pip wheel .` in a checkout")
