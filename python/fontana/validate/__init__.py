"""Held against nature: cases whose answer is known from an experiment, a closed form or another method.

Each module here without a leading underscore is a case: a scene, what is measured in it, the figure it must keep and
its plot. `fontana validate` runs them; tests/physics/test_validation.py runs them small. Figures are errors: smaller is
better, and one without a limit is reported only.
"""

from fontana.validate._case import SIZES, Case, Figure, Outcome, Stage
from fontana.validate._plots import publish_picture
from fontana.validate._registry import case_names, find_case
from fontana.validate._session import Session

__all__ = ["SIZES", "Case", "Figure", "Outcome", "Session", "Stage", "case_names", "find_case", "publish_picture"]
