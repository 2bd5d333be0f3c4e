"""``python -m exactacq``."""

import sys

from exactacq.cli import main

sys.exit(main())
