"""The cell magic ``%%modl``: a program in a cell of a notebook."""

from __future__ import annotations

import argparse
import shlex

from ._command import ModlError
from ._program import run, show


def modl_cell(line: str, cell: str):
    """Run the program in the cell, print what it prints, and return its result; ``%%modl --show`` returns its page."""
    parser = argparse.ArgumentParser(prog="%%modl", add_help=False)
    parser.add_argument("--show", action="store_true")
    parser.add_argument("--out", default="out")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args(shlex.split(line))
    try:
        if arguments.show:
            return show(text=cell, out=arguments.out)
        ran = run(text=cell, out=arguments.out, seed=arguments.seed)
    except ModlError as error:
        # The cell's own lines are in the message, and a traceback through this package says nothing more.
        print(error)
        return None
    for printed in ran.printed:
        print(printed)
    return ran


def register(shell) -> None:
    """Register the magic with an IPython shell."""
    shell.register_magic_function(modl_cell, "cell", "modl")
