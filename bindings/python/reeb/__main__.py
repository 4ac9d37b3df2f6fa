"""`python -m reeb`: the command line that comes along."""

import os
import sys
from typing import NoReturn

from . import _core


def main() -> NoReturn:
    program = os.path.join(os.path.dirname(os.path.abspath(_core.__file__)), "bin", "reeb")
    if not os.path.exists(program):
        sys.exit("reeb: this installation has no command line")
    os.execv(program, ["reeb", *sys.argv[1:]])


if __name__ == "__main__":
    main()
