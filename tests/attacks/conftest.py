"""The attacks and the rooms in which they are run can be imported by the tests, as by ``table.py``."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
