"""Runs commands one by one and tells what each took."""
import dataclasses
import os
import subprocess
import tempfile


@dataclasses.dataclass(frozen=True)
class Usage:
    seconds: float  # processor time, user and system
    megabytes: float  # largest resident memory, never below what an empty process of this caller has
    output: str  # standard output


class CommandFailed(Exception):
    """A command that ended with an error; the text is its last line of standard error."""


def run(command, **environment):
    """Runs a command (a list of words) to its end, `environment` added to its own. Several threads may."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                 env={**os.environ, **environment})
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        for stream in (out, err):
            stream.seek(0)
        if child.returncode != 0:
            lines = err.read().decode(errors="replace").strip().splitlines()
            raise CommandFailed(lines[-1] if lines else f"{command[0]} ended with {child.returncode}")
        return Usage(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, out.read().decode())
