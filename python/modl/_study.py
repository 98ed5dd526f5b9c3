"""Studies: computed, and their tables as NumPy arrays."""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path
from typing import Any, Iterator

import numpy as np

from ._command import ModlError, PathLike, call, options


class Study:
    """The table of a study: a mapping from the names of columns to NumPy arrays, in SI units and radians.

    A number that is missing is ``nan``. ``study["code"]`` is empty for rows that have values; ``study.ok`` are these.
    """

    def __init__(self, file: PathLike, about: dict[str, Any], cells: list[list[str]]):
        self.file = Path(file)
        self.about = about
        names = ["row", *(column["name"] for column in about["columns"]), "code", "message"]
        self._columns = {name: [row[i] for row in cells] for i, name in enumerate(names)}
        self._types = {column["name"]: column["type"] for column in about["columns"]}
        self._units = {column["name"]: column.get("unit", "") for column in about["columns"]}

    @classmethod
    def load(cls, file: PathLike) -> "Study":
        """Read a table that ``modl study`` wrote, by the path of its CSV file.

        Raises:
            OSError: if it, or the description beside it, can't be read.
        """
        about = json.loads(Path(file).with_suffix(".json").read_text(encoding="utf-8"))
        with open(file, encoding="utf-8", newline="") as stream:
            cells = list(csv.reader(stream))[1:]
        return cls(file, about, cells)

    @property
    def names(self) -> list[str]:
        """The names of the columns."""
        return list(self._columns)

    @property
    def ok(self) -> np.ndarray:
        """For each row true if it has values."""
        return np.array([code == "" for code in self._columns["code"]])

    def unit(self, name: str) -> str:
        """Return the unit of a column, such as ``m/s``; empty for numbers and other values."""
        return self._units.get(name, "")

    def __getitem__(self, name: str) -> np.ndarray:
        cells = self._columns[name]
        ty = self._type(name)
        if ty == "Bool":
            known = {"true": True, "false": False}
            plain = all(cell in known for cell in cells)
            return np.array([known.get(cell) for cell in cells], dtype=bool if plain else object)
        if ty == "Int" and all(cells):
            return np.array([int(cell) for cell in cells])
        if ty == "Text" or (self.unit(name) == "" and ty not in ("Int", "Number")):
            return np.array(cells, dtype=object)
        return np.array([float(cell) if cell else np.nan for cell in cells])

    def __len__(self) -> int:
        return len(self._columns["row"])

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def to_pandas(self):
        """Return the table as a pandas ``DataFrame``."""
        import pandas

        return pandas.DataFrame({name: self[name] for name in self.names})

    def to_parquet(self, file: PathLike) -> None:
        """Write the table as a Parquet file, by the library pyarrow (``pip install 'modl[parquet]'``).

        Columns have the types of the study's record, and a missing value is null. The description of the table (the version
        of modl, the digests of the sources, the units) is in the file's metadata under ``modl``.
        """
        import pyarrow
        import pyarrow.parquet

        columns = {name: pyarrow.array(self._typed(name)) for name in self.names}
        described = {b"modl": json.dumps(self.about, sort_keys=True).encode()}
        pyarrow.parquet.write_table(pyarrow.table(columns).replace_schema_metadata(described), file)

    def _typed(self, name: str) -> list[Any]:
        """Return the cells of a column as values of Python; a missing number or truth value is ``None``."""
        column = self[name]
        if column.dtype.kind == "O":
            return list(column)
        convert = {"Bool": "true".__eq__, "Int": int}.get(self._type(name), float)
        return [convert(cell) if cell else None for cell in self._columns[name]]

    def _type(self, name: str) -> str:
        """Return the type of a column in the language, without the mark of an optional one."""
        return self._types.get(name, "Int" if name == "row" else "Text").rstrip("?")

    def best(self) -> dict[str, Any]:
        """Return the best row of a search.

        Raises:
            ModlError: if the study is no search, or no row has a value.
        """
        row = self.about.get("best")
        if row is None:
            raise ModlError("the study seeks nothing: only one by `cmaes` has a best row")
        return {name: self[name][row] for name in self.names}

    def __repr__(self) -> str:
        return f"Study({str(self.file)!r}, {len(self)} rows)"


def study(
    program: PathLike,
    name: str | None = None,
    *,
    out: PathLike = "out",
    shard: tuple[int, int] | None = None,
    seed: int = 0,
    threads: int | None = None,
    root: PathLike | None = None,
) -> Study | None:
    """Compute a study, or what of it is missing, and return its table; ``None`` where other drivers are still at some rows.

    ``shard`` is one part of several, ``(17, 64)``, of which none returns a table but the last.

    Raises:
        ModlError: if the program or the call is wrong, or a file can't be written.
    """
    words = ["study", os.fspath(program)] + ([name] if name else [])
    part = f"{shard[0]}/{shard[1]}" if shard else None
    words += options(out=out, shard=part, seed=seed, threads=threads, root=root)
    table = call(words).report["study"]["table"]
    return Study.load(table) if table else None
