"""Executes the notebooks of this folder and writes them as pages of the book: `python examples/notebooks/pages.py`.

Needs nbclient, ipykernel and matplotlib beside cplan (`pip install .[test]`). The notebooks are stored without outputs.
"""

import base64
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbformat import NotebookNode

FOLDER = Path(__file__).parent
DOCS = FOLDER.parents[1] / "docs"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def executed(notebook: Path) -> NotebookNode:
    """Returns the notebook with the outputs of its cells, executed in a new kernel.

    The kernel sends the lines of a cell in one piece or several, as time allows; they are joined.
    """
    cells = nbformat.read(notebook, as_version=4)
    return NotebookClient(cells, timeout=120, kernel_name="python3", coalesce_streams=True).execute()


def page(name: str, notebook: NotebookNode) -> tuple[str, dict[str, bytes]]:
    """Returns the Markdown of an executed notebook, and its pictures by file name."""
    blocks, pictures = [], {}
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            blocks.append(cell.source)
            continue
        blocks.append(f"```python\n{cell.source}\n```")
        for output in cell.outputs:
            data = output.get("data", {"text/plain": output.get("text", "")})
            if "image/png" in data:
                picture = f"{name}_{len(pictures) + 1}.png"
                pictures[picture] = base64.b64decode(data["image/png"])
                blocks.append(f"![{cell.metadata.get('caption', '')}](pictures/notebooks/{picture})")
            else:
                blocks.append(f"```text\n{data['text/plain'].rstrip()}\n```")
    # Below the title.
    where = f"This page is generated from the notebook [{name}.ipynb](../examples/notebooks/{name}.ipynb)."
    return "\n\n".join([blocks[0], where, *blocks[1:]]) + "\n", pictures


def main() -> None:
    folder = DOCS / "pictures/notebooks"
    folder.mkdir(exist_ok=True)
    for notebook in NOTEBOOKS:
        text, pictures = page(notebook.stem, executed(notebook))
        (DOCS / f"{notebook.stem}.md").write_text(text)
        for name, picture in pictures.items():
            (folder / name).write_bytes(picture)


if __name__ == "__main__":
    main()
