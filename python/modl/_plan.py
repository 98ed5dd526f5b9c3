"""Plans: their files, their verdicts, and samples of them."""

from __future__ import annotations

import io
import json
import os
from dataclasses import dataclass
from typing import Any, Iterator, Mapping

import numpy as np

from ._command import ModlError, PathLike, call, data, failure


@dataclass(frozen=True)
class Verdict:
    """The judge's verdict on a plan, computed from nothing but its file."""

    ok: bool
    """True if nothing failed."""
    data: Mapping[str, Any]
    """The whole verdict, as plan files have it: checks, worst values, failures."""

    def __bool__(self) -> bool:
        return self.ok

    def __getitem__(self, name: str) -> Any:
        return self.data[name]


class Series:
    """Samples of a plan over time: a mapping from the names of columns to NumPy arrays, in SI units and radians.

    ``series.time`` are the times; ``series["m[0].tilt"]`` is a column; ``series.array`` all of them but the time.
    """

    def __init__(self, names: list[str], array: np.ndarray):
        self.names = names[1:]
        self.time: np.ndarray = array[:, 0]
        self.array: np.ndarray = array[:, 1:]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.array[:, self.names.index(name)]

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        return f"Series({len(self)} samples of {len(self.names)} columns)"


class Plan:
    """A plan file."""

    def __init__(self, file: PathLike, data: Mapping[str, Any]):
        self.file = os.fspath(file)
        self.data = data

    @classmethod
    def load(cls, file: PathLike) -> "Plan":
        """Read a plan file.

        Raises:
            ModlError: if it is no plan.
            OSError: if it can't be read.
        """
        with open(file, encoding="utf-8") as stream:
            text = stream.read()
        try:
            data = json.loads(text)
        except ValueError as error:
            raise ModlError(f"`{os.fspath(file)}` is no plan file: {error}") from None
        # The command reads it as a whole, and tells what is not sound.
        call(["plan", os.fspath(file)])
        return cls(file, data)

    def verify(self) -> Verdict:
        """Judge the plan again. A plan that fails has a verdict, too: ``plan.verify().ok`` is false then.

        Raises:
            ModlError: if the file is no plan.
        """
        answer = call(["verify", self.file], raises=False)
        plans = answer.report.get("plans") or []
        if not plans:
            raise failure(answer)
        return Verdict(plans[0]["ok"], plans[0]["verdict"])

    def sample(self, rate: float = 100.0, series: str = "joints") -> Series:
        """Sample the plan ``rate`` times a second. ``series`` is one of those of ``modl plan --series``, such as ``joints``.

        Raises:
            ModlError: if the plan has no such series.
        """
        printed = data(["plan", self.file, "--series", series, "--rate", f"{rate!r}Hz", "--npy"])
        records = np.load(io.BytesIO(printed), allow_pickle=False, max_header_size=len(printed))
        names = list(records.dtype.names)
        return Series(names, np.column_stack([records[name].astype(float) for name in names]))

    def show(self, height: int = 480):
        """Draw the plan as a page that plays it; in a notebook it is shown inline."""
        from ._program import show

        return show(self, height=height)

    def simulate(self, **settings: Any) -> dict[str, Any]:
        """Play the plan on rigid bodies; see :func:`modl.simulate`."""
        from ._program import simulate

        return simulate(self, **settings)[0]

    def __repr__(self) -> str:
        return f"Plan({self.file!r})"
