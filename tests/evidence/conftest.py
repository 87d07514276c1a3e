"""The evidence's own modules can be imported by its tests, as by ``campaign.py``."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
