"""The command: how it is found and called, and what it says is wrong."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import threading
import time
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Mapping, Sequence, Union

PathLike = Union[str, "os.PathLike[str]"]

# The time that the command has to end after Ctrl-C before it is killed, in seconds. Its files are whole or not there.
_GRACE = 0.05
# The time between two looks at whether the command has ended, in seconds; the first to come ends the wait.
_INTERVAL = 0.5


@dataclass(frozen=True)
class Label:
    """A place in a source text, with what is to be said of it."""

    file: str
    line: int
    column: int
    end_line: int
    end_column: int
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}: {self.text}"


@dataclass(frozen=True)
class Diagnostic:
    """A finding about a program: an error, a warning or a note."""

    code: str
    severity: str
    message: str
    labels: tuple[Label, ...] = ()
    hints: tuple[str, ...] = ()

    @classmethod
    def _of(cls, data: Mapping[str, Any]) -> "Diagnostic":
        names = Label.__dataclass_fields__
        labels = tuple(Label(**{name: label[name] for name in names}) for label in data["labels"])
        return cls(data["code"], data["severity"], data["message"], labels, tuple(data["hints"]))

    def __str__(self) -> str:
        lines = [f"{self.code} {self.message}"]
        lines += [f"  {label}" for label in self.labels]
        lines += [f"  help: {hint}" for hint in self.hints]
        return "\n".join(lines)


class ModlError(Exception):
    """A program, plan or call that is wrong.

    ``diagnostics`` are the findings, errors and others; of a wrong call there are none, and the message says why.
    ``report`` is the whole answer of the command.
    """

    def __init__(self, message: str, diagnostics: Sequence[Diagnostic] = (), report: Mapping[str, Any] | None = None):
        super().__init__(message)
        self.diagnostics = tuple(diagnostics)
        self.report = dict(report or {})

    @property
    def codes(self) -> tuple[str, ...]:
        """The codes of the errors, in order."""
        return tuple(d.code for d in self.diagnostics if d.severity == "error")


@lru_cache(maxsize=None)
def binary() -> str:
    """Return the path of the ``modl`` command: ``MODL_BINARY``, that of this package, or the first on the path.

    Raises:
        ModlError: if there is none.
    """
    name = "modl.exe" if sys.platform == "win32" else "modl"
    beside = [sysconfig.get_path("scripts"), str(Path(sys.executable).parent), os.path.expanduser("~/.local/bin")]
    candidates = [os.environ.get("MODL_BINARY")] + [os.path.join(folder, name) for folder in beside if folder]
    for path in candidates:
        if path and os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    found = shutil.which(name)
    if found is None:
        raise ModlError("the `modl` command is not there: `pip install .` in `python/` installs it")
    return found


@lru_cache(maxsize=None)
def version() -> str:
    """Return the version of the command, such as ``0.1.0``."""
    said = subprocess.run([binary(), "--version"], check=True, capture_output=True, text=True).stdout
    return said.split()[-1]


@dataclass
class Answer:
    """The answer of the command: its exit code and its JSON object."""

    code: int
    report: dict[str, Any]
    diagnostics: tuple[Diagnostic, ...] = field(default=())


def options(**given: Any) -> list[str]:
    """Return options as words of a command line; ``None`` and ``False`` are left out."""
    words: list[str] = []
    for name, value in given.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(option)
        elif value is not None and value is not False:
            words += [option, os.fspath(value) if isinstance(value, os.PathLike) else str(value)]
    return words


def call(words: Sequence[str], text: str | None = None, raises: bool = True) -> Answer:
    """Call the command with ``--json`` and return its answer. ``text`` is its standard input.

    Ctrl-C ends the command, and raises :class:`KeyboardInterrupt` within a tenth of a second.

    Raises:
        ModlError: if the call is wrong, or if ``raises`` and something else is.
    """
    code, out, error = _output([binary(), "--json", *words], None if text is None else text.encode())
    try:
        report = json.loads(out)
    except ValueError:
        said = error.decode(errors="replace").strip() or f"it ended with {code}"
        raise ModlError(f"the `modl` command gave no answer: {said}") from None
    if "call_error" in report:
        raise ModlError(report["call_error"], report=report)
    found = tuple(Diagnostic._of(d) for d in report.get("diagnostics", ()))
    answer = Answer(code, report, found)
    if raises and code != 0:
        raise failure(answer)
    return answer


def data(words: Sequence[str]) -> bytes:
    """Call the command and return the bytes that it prints.

    Raises:
        ModlError: if something is wrong.
    """
    code, out, _ = _output([binary(), *words], None)
    if code != 0:
        # The same call tells as JSON what is wrong.
        raise failure(call([word for word in words if word != "--npy"], raises=False))
    return out


def _output(arguments: list[str], given: bytes | None) -> tuple[int, bytes, bytes]:
    """Call a program; return its exit code and what it prints to its two outputs.

    Ctrl-C ends it, and raises :class:`KeyboardInterrupt` within a tenth of a second.
    """
    # Its own group: Ctrl-C is handed on here, once, and not by the terminal as well.
    apart: dict[str, Any] = {"start_new_session": True} if os.name == "posix" else {}
    process = subprocess.Popen(
        arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **apart
    )
    ends: list[bytes] = []
    # `communicate` itself would wait for a quarter of a second after Ctrl-C.
    waiting = threading.Thread(target=lambda: ends.extend(process.communicate(given)), daemon=True)
    try:
        waiting.start()
        while waiting.is_alive():
            waiting.join(_INTERVAL)
    except BaseException:
        _end(process)
        raise
    out, error = ends
    if process.returncode == 130:
        raise KeyboardInterrupt
    return process.returncode, out, error


def failure(answer: Answer) -> ModlError:
    """Return the exception for an answer that says that something is wrong."""
    errors = [str(d) for d in answer.diagnostics if d.severity == "error"]
    return ModlError("\n".join(errors) or "something is wrong; `report` says what", answer.diagnostics, answer.report)


def _end(process: "subprocess.Popen[bytes]") -> None:
    """End the command: by Ctrl-C, and where it does not listen, at once."""
    process.send_signal(signal.SIGINT if os.name == "posix" else signal.SIGTERM)
    limit = time.monotonic() + _GRACE
    while process.poll() is None and time.monotonic() < limit:
        time.sleep(0.002)
    if process.poll() is None:
        process.kill()
