"""Writes the wheel with the planner as WebAssembly: `wheel.py PROGRAM FOLDER`. It needs Python 3.11 or later and no package."""

import base64
import hashlib
import sys
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# The earliest time that a zip file has: the same sources give the same bytes.
TIME = (1980, 1, 1, 0, 0, 0)


def metadata(project: dict, version: str) -> str:
    """Returns the metadata of `pyproject.toml`, with the package that runs WebAssembly where no browser does."""
    lines = [
        "Metadata-Version: 2.4",
        f"Name: {project['name']}",
        f"Version: {version}",
        f"Summary: {project['description']}",
        f"License-Expression: {project['license']}",
        f"Keywords: {','.join(project['keywords'])}",
        f"Requires-Python: {project['requires-python']}",
    ]
    lines += [f"Requires-Dist: {needed}" for needed in project["dependencies"]]
    lines.append('Requires-Dist: wasmtime>=24; sys_platform != "emscripten"')
    for extra, packages in project["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {needed}; extra == "{extra}"' for needed in packages]
    readme = (ROOT / project["readme"]).read_text()
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme])


def contents(program: Path, folder: str, project: dict, version: str) -> dict[str, bytes]:
    """Returns the files of the wheel, except the list of them."""
    files = {}
    for package in (ROOT / "python/cplan", ROOT / "python/wasm/cplan"):
        sources = [path for path in package.rglob("*") if path.suffix in (".py", ".pyi", ".typed")]
        files |= {f"cplan/{path.relative_to(package).as_posix()}": path.read_bytes() for path in sources}
    files["cplan/cplan.wasm"] = program.read_bytes()
    files[f"{folder}/METADATA"] = metadata(project, version).encode()
    files[f"{folder}/WHEEL"] = b"Wheel-Version: 1.0\nGenerator: cplan\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    scripts = "".join(f"{name} = {function}\n" for name, function in project["scripts"].items())
    files[f"{folder}/entry_points.txt"] = f"[console_scripts]\n{scripts}".encode()
    for path in ROOT.glob("LICENSE-*"):
        files[f"{folder}/licenses/{path.name}"] = path.read_bytes()
    return files


def record(files: dict[str, bytes], folder: str) -> bytes:
    """Returns the list of files, with their hashes."""
    lines = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(content)}")
    return "\n".join([*lines, f"{folder}/RECORD,,", ""]).encode()


def main(program: Path, target: Path) -> None:
    """Writes the wheel into a folder."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    version = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
    folder = f"cplan-{version}.dist-info"
    files = dict(sorted(contents(program, folder, project, version).items()))
    files[f"{folder}/RECORD"] = record(files, folder)
    target.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(target / f"cplan-{version}-py3-none-any.whl", "w") as wheel:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, TIME)
            entry.external_attr = 0o644 << 16
            wheel.writestr(entry, content, zipfile.ZIP_DEFLATED, 9)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
