"""Programs: checked, run, shown and simulated."""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ._command import Answer, Diagnostic, ModlError, PathLike, call, options
from ._plan import Plan
from ._values import typed


@dataclass(frozen=True)
class Checked:
    """The result of :func:`check`: a program without errors."""

    diagnostics: tuple[Diagnostic, ...]

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """The warnings, in order."""
        return tuple(d for d in self.diagnostics if d.severity == "warning")


@dataclass(frozen=True)
class Ran:
    """The result of :func:`run`: what a program printed and wrote."""

    printed: list[str]
    """The lines that it printed."""
    values: list[Any]
    """The values that it printed, in order, quantities in SI units; see :class:`modl.Quantity`."""
    written: list[Path]
    """The files that it wrote."""
    diagnostics: tuple[Diagnostic, ...]
    """What was found about it: warnings and notes."""

    def plan(self, name: str | None = None) -> Plan:
        """Return the plan that the program emitted under this name, or its only one.

        Raises:
            KeyError: if it emitted none of this name, or several and none is named.
        """
        plans = [path for path in self.written if path.name.endswith(".plan.json")]
        found = [path for path in plans if name is None or str(path).endswith(name)]
        if len(found) != 1:
            raise KeyError(f"{name or 'one plan'}: the program emitted {[str(path) for path in plans]}")
        return Plan.load(found[0])


def _source(program: PathLike, text: str | None) -> str:
    return "-" if text is not None else os.fspath(program)


def _limits(seed, threads, max_steps, root) -> list[str]:
    return options(seed=seed, threads=threads, max_steps=max_steps, root=root)


def check(program: PathLike = "-", *, text: str | None = None, root: PathLike | None = None) -> Checked:
    """Check a program file, or a program's text, without planning or writing.

    Raises:
        ModlError: if it has errors, with all diagnostics.
    """
    answer = call(["check", _source(program, text), *options(root=root)], text)
    return Checked(answer.diagnostics)


def run(
    program: PathLike = "-",
    *,
    text: str | None = None,
    out: PathLike = "out",
    root: PathLike | None = None,
    seed: int = 0,
    threads: int | None = None,
    max_steps: int | None = None,
) -> Ran:
    """Run a program file, or a program's text: print, verify, and write its plans below ``out``.

    ``root`` is the project outside of which nothing is read, by default the folder of the file; ``seed`` that of planners to
    which the program gives none; ``threads`` how many planners may use, which changes no result.

    Raises:
        ModlError: if something is wrong: the program, a plan that fails verification, or a file.
    """
    words = ["run", _source(program, text), *options(out=out), *_limits(seed, threads, max_steps, root)]
    return _ran(call(words, text))


def _ran(answer: Answer) -> Ran:
    report = answer.report
    values = [typed(value["value"]) for value in report.get("values", ())]
    written = [Path(path) for path in report.get("written", ())]
    return Ran(report.get("printed", []), values, written, answer.diagnostics)


def simulate(
    what: PathLike | Plan, *, step: float | None = None, friction: float | None = None, root: PathLike | None = None
) -> list[dict[str, Any]]:
    """Play the plans of a program, or a plan, on rigid bodies: what the robots really do.

    Returns a dictionary for each plan, in SI units and radians, as ``docs/json.md`` tells; ``ok`` is false for one that falls,
    breaks a bond or does not dock. ``step`` is the time step in milliseconds, ``friction`` a factor on all friction.

    Raises:
        ModlError: if the program or the plan is wrong.
    """
    file = what.file if isinstance(what, Plan) else os.fspath(what)
    answer = call(["simulate", file, *options(step=step, friction=friction, root=root)], raises=False)
    if answer.code != 0 and (not answer.report.get("simulations") or answer.report.get("errors")):
        from ._command import failure

        raise failure(answer)
    return answer.report.get("simulations", [])


class Page:
    """A page that plays a plan; in a notebook it is shown inline."""

    def __init__(self, path: Path, height: int = 480):
        self.path = path
        self.height = height

    def __repr__(self) -> str:
        return f"Page({str(self.path)!r})"

    def _repr_html_(self) -> str:
        import html

        page = html.escape(self.path.read_text(encoding="utf-8"), quote=True)
        return f'<iframe srcdoc="{page}" width="100%" height="{self.height}" style="border:0"></iframe>'


def show(
    what: PathLike | Plan = "-",
    *,
    text: str | None = None,
    out: PathLike | None = None,
    height: int = 480,
    root: PathLike | None = None,
) -> Page:
    """Draw a plan, or what a program plans, as a page that plays it; of several plans the last.

    A failed plan is drawn up to its failure. In a notebook the page is shown inline, ``height`` pixels high.

    Raises:
        ModlError: if the program is wrong, or has nothing to show.
    """
    folder = tempfile.mkdtemp(prefix="modl-") if out is None else os.fspath(out)
    file = what.file if isinstance(what, Plan) else _source(what, text)
    answer = call(["show", file, *options(out=folder, root=root)], text, raises=False)
    pages = [Path(path) for path in answer.report.get("written", ()) if path.endswith(".html")]
    if not pages:
        from ._command import failure

        raise failure(answer) if answer.code != 0 else ModlError("there is nothing to show", answer.diagnostics)
    return Page(pages[-1], height)
