"""``python -m rodloop_cli`` is ``rodloop``."""

import sys

from rodloop_cli.cli import main

if __name__ == "__main__":
    sys.exit(main())
