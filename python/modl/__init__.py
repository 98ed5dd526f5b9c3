"""The language Modl from Python: check and run programs, read and judge plans, compute studies.

Every function calls the ``modl`` command, which this package installs, and gives its answer as Python objects::

    import modl
    plan = modl.run("walkbot.mod").plan("walk.plan.json")
    print(plan.verify().ok)

A wrong program raises :class:`ModlError`, with its diagnostics.
"""

from ._command import Diagnostic, Label, ModlError, binary, version
from ._plan import Plan, Series, Verdict
from ._program import Checked, Ran, check, run, show, simulate
from ._study import Study, study
from ._values import Quantity

__all__ = [
    "Checked",
    "Diagnostic",
    "Label",
    "ModlError",
    "Plan",
    "Quantity",
    "Ran",
    "Series",
    "Study",
    "Verdict",
    "binary",
    "check",
    "run",
    "show",
    "simulate",
    "study",
    "version",
]

__version__ = version()


def load_ipython_extension(shell) -> None:
    """Register the cell magic ``%%modl`` with IPython: ``%load_ext modl``."""
    from ._notebook import register

    register(shell)
