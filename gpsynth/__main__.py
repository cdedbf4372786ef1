"""`python -m gpsynth` is the command `gpsynth`."""

import sys

from gpsynth.cli import main

sys.exit(main())
