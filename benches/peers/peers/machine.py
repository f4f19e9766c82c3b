"""What the figures were measured on and with."""

from __future__ import annotations

import datetime
import importlib.metadata
import os
import platform
import subprocess
import tomllib
from pathlib import Path

LOCK = Path(__file__).parent.parent / "rust" / "Cargo.lock"

PYTHON_PEERS = ("ompl", "pyvisgraph", "scikit-fmm", "scikit-image", "pyamg", "scipy", "numpy")
RUST_PEERS = ("oxmpl", "parry2d", "polyanya")


def _output(*command: str) -> str:
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def _first(file: str, key: str) -> str:
    lines = (line.split(":", 1) for line in Path(file).read_text().splitlines() if ":" in line)
    return next((value.strip() for name, value in lines if name.strip() == key), "unknown")


def python_version(package: str) -> str | None:
    """The installed version of a Python package."""
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def machine() -> list[str]:
    """Processor, memory, system, date."""
    memory = int(_first("/proc/meminfo", "MemTotal").split()[0]) / 2**20
    load = " ".join(f"{value:.2f}" for value in os.getloadavg())
    try:
        system = platform.freedesktop_os_release()["PRETTY_NAME"]
    except OSError:
        system = platform.system()
    return [
        f"{_first('/proc/cpuinfo', 'model name')}, {os.cpu_count()} cores, {memory:.0f} GiB; {system}",
        f"{datetime.datetime.now(datetime.UTC):%Y-%m-%d %H:%M} UTC; load at the start {load}",
    ]


def versions(cplan: str, work: Path) -> list[str]:
    """Of cplan and of everything beside it."""
    commit = _output("git", "-C", str(LOCK.parent), "rev-parse", "--short", "HEAD")
    changed = _output("git", "-C", str(LOCK.parents[3]), "status", "--porcelain", "--untracked-files=no", "--", "src")
    locked = {package["name"]: package["version"] for package in tomllib.loads(LOCK.read_text())["package"]}
    ompl = _output(str(work / "ompl_peer"), "version")
    installed = [f"{package} {python_version(package) or 'not installed'}" for package in PYTHON_PEERS]
    return [
        f"{_output(cplan, '--version')} at {commit}{' with changes' if changed not in ('', 'unknown') else ''}; "
        f"{_output('rustc', '--version')}",
        f"C++: OMPL {ompl} (Debian {_output('dpkg-query', '-W', '-f', '${Version}', 'libompl-dev')}), "
        f"{_output('g++', '-dumpfullversion')} (g++ -O3)",
        f"Rust: {', '.join(f'{name} {locked[name]}' for name in RUST_PEERS)}",
        f"Python {platform.python_version()}: {', '.join(installed)}",
    ]
