"""On PYTHONPATH, as if usd-core were not installed."""

import sys

sys.modules["pxr"] = None
