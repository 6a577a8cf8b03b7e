"""A plugin of pytest that collects suites of `whit check`: each *.whit file, a test a case.

    PYTHONPATH=$(pkg-config --variable=pythondir whit) pytest -p pytest_whit
    PYTHONPATH=... pytest -p pytest_whit looks.whit::room --whit-options="--device llvmpipe"

A case passes where `whit check SUITE --only CASE` ends with 0, and fails otherwise, without a device (3) and without a
golden (4) too; what whit said is shown, and the command to repeat it. The program is --whit or $WHIT, or that of the
prefix which this file is installed in, or else the one in PATH.
"""

import os
import shlex
import signal
import subprocess

import pytest

MEANINGS = {1: "something differs, or an expectation fails", 2: "a bad suite or scene", 3: "no device",
            4: "no golden", 5: "time limit"}


class Failure(pytest.Collector.CollectError):
    """What whit said of a case, or of a suite that it cannot read."""


def _program():
    prefix = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")
    beside = os.path.normpath(os.path.join(prefix, "bin", "whit"))
    return os.environ.get("WHIT") or (beside if os.access(beside, os.X_OK) else "whit")


def pytest_addoption(parser):
    group = parser.getgroup("whit", "pictures held by `whit check`")
    group.addoption("--whit", metavar="PROGRAM", default=_program(), help="whit itself (%(default)s)")
    group.addoption("--whit-options", metavar="OPTIONS", default="", help="further options of `whit check`")


def pytest_collect_file(file_path, parent):
    return Suite.from_parent(parent, path=file_path) if file_path.suffix == ".whit" else None


def _run(config, suite, *options):
    """The command, and how it ended."""
    command = [config.getoption("--whit"), "check", str(suite), *options,
               *shlex.split(config.getoption("--whit-options"))]
    try:
        return command, subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    except OSError as why:
        raise Failure(f"{command[0]} cannot be run: {why.strerror}; --whit names whit") from None


class Suite(pytest.File):
    """A file of cases."""

    def collect(self):
        command, ended = _run(self.config, self.path, "--list")
        if ended.returncode != 0:
            raise Failure(f"{shlex.join(command)}\n{ended.stderr.strip()}")
        for name in ended.stdout.split("\n")[:-1]:
            yield Case.from_parent(self, name=name)


class Case(pytest.Item):
    """One case."""

    def runtest(self):
        command, ended = _run(self.config, self.path, "--only", self.name)
        if ended.returncode in (130, -signal.SIGINT):
            raise KeyboardInterrupt
        if ended.returncode != 0:
            said = (ended.stdout + ended.stderr).strip()
            meaning = MEANINGS.get(ended.returncode, "whit did not end by itself")
            raise Failure(f"{said}\nexit code {ended.returncode}: {meaning}\nagain: {shlex.join(command)}")

    def repr_failure(self, excinfo, style=None):
        if isinstance(excinfo.value, Failure):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self):
        return self.path, None, self.name
