"""Values that programs print, as Python objects."""

from __future__ import annotations

import math
from typing import Any, Mapping

import numpy as np


class Quantity(float):
    """A number in SI units that knows its unit: ``q``, ``q.unit`` and ``q.dimension``."""

    unit: str
    dimension: str

    def __new__(cls, number: float, unit: str = "", dimension: str = "") -> "Quantity":
        value = super().__new__(cls, number)
        value.unit = unit
        value.dimension = dimension
        return value

    def __repr__(self) -> str:
        return f"{float(self)!r} {self.unit}".rstrip()

    def __reduce__(self):
        return (Quantity, (float(self), self.unit, self.dimension))


def typed(value: Mapping[str, Any]) -> Any:
    """Return a value of ``modl run --json`` as a Python object.

    Quantities become :class:`Quantity` in SI units, vectors NumPy arrays, poses dictionaries of the position ``p`` and the
    quaternion ``q`` (w, x, y, z), ranges pairs, records dictionaries; of plans, robots and their like there is the text that
    is printed. What is missing or was left out is ``None``.
    """
    if "digits" in value:
        return int(value["digits"])
    if "number" in value or "infinite" in value:
        number = value["number"] if "number" in value else math.copysign(math.inf, value["infinite"])
        if number is None or isinstance(number, int) or "unit" not in value:
            return number
        return Quantity(number, value["unit"], value.get("dimension", ""))
    for plain in ("bool", "text", "word", "shown"):
        if plain in value:
            return value[plain]
    if "list" in value:
        return [typed(element) for element in value["list"]]
    if "vector" in value:
        return np.array(value["vector"], dtype=float)
    if "pose" in value:
        return {name: np.array(part, dtype=float) for name, part in value["pose"].items()}
    if "from" in value and "to" in value:
        return (typed(value["from"]), typed(value["to"]))
    if "fields" in value:
        return {name: typed(field) for name, field in value["fields"].items()}
    return None
