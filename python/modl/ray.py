"""Studies on a Ray cluster: shards as tasks, tried again where a worker or a node is lost.

::

    import modl.ray
    table = modl.ray.study("snake.mod", "gait", out="/shared/sweep", shards=200)

The program and ``out`` are in a folder that all nodes see. Rows are the same whoever computes them, so a task that is
tried again changes nothing.
"""

from __future__ import annotations

import os
from typing import Any

import ray

from ._command import PathLike, call, options
from ._study import Study, study as _local


def _shard(program: str, name: str | None, words: list[str], index: int, count: int) -> int:
    named = [name] if name else []
    call(["study", program, *named, "--shard", f"{index}/{count}", "--threads", "1", *words])
    return index


def study(
    program: PathLike,
    name: str | None = None,
    *,
    out: PathLike = "out",
    shards: int = 64,
    retries: int = 5,
    seed: int = 0,
    root: PathLike | None = None,
    **remote: Any,
) -> Study:
    """Compute a study in so many shards on the Ray cluster that is initialised, and return its table.

    A task whose worker or node is lost is tried again up to ``retries`` times. Further arguments are those of ``ray.remote``,
    such as ``num_cpus``.

    Raises:
        ModlError: if the program or the call is wrong, or a file can't be written.
        ray.exceptions.RayError: if a task is lost more often.
    """
    program, out = os.path.abspath(program), os.path.abspath(out)
    words = options(out=out, seed=seed, root=None if root is None else os.path.abspath(root))
    task = ray.remote(max_retries=retries, **remote)(_shard)
    waiting = [task.remote(program, name, words, index, shards) for index in range(1, shards + 1)]
    while waiting:
        done, waiting = ray.wait(waiting)
        ray.get(done)
    # Shards that ended side by side may each have missed the other's rows.
    table = _local(program, name, out=out, seed=seed, root=root)
    assert table is not None
    return table
