#!/usr/bin/python3
"""Runs a notebook and prints it as Markdown: its text, its code, and what each cell returns in words.

    docs/notebook/show.py NOTEBOOK FOLDER     runs it in FOLDER; $RIGCAL: the program, beside which the module lies

Tables are printed as text; figures and frames are named. An error in a cell ends it with exit code 1.
"""
import os
import pathlib
import sys

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def printed(output: dict) -> str:
    if output["output_type"] == "stream":
        return output["text"]
    data = output["data"]
    if "image/png" in data:
        return "(a figure)\n"
    if "<iframe" in data.get("text/html", ""):
        return f"{data['text/plain']}: (a frame)\n"
    return data["text/plain"] + "\n"


def main() -> int:
    notebook, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    program = pathlib.Path(os.environ.get("RIGCAL", ROOT / "build" / "release" / "rigcal")).resolve()
    os.environ["PYTHONPATH"] = str(program.parent / "python")
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # a warning of the kernel on stderr
    os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "datasets").symlink_to(ROOT / "datasets")
    content = nbformat.read(notebook, as_version=4)
    try:
        NotebookClient(content, kernel_name="python3", resources={"metadata": {"path": str(folder)}}, timeout=600).execute()
    except CellExecutionError as error:
        print(error, file=sys.stderr)
        return 1
    for cell in content.cells:
        if cell.cell_type == "markdown":
            text = cell.source.partition("\n\n")[2] if cell.source.startswith("# ") else cell.source
            print(text + "\n")
            continue
        print(f"```python\n{cell.source}\n```\n")
        text = "".join(printed(output) for output in cell.outputs)
        print(f"```\n{text.rstrip()}\n```\n")
    return 0


sys.exit(main())
