"""A run of several cases: each writes its results as it ends, so that what is finished survives whatever comes."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from fontana.bench import describe_conditions, note_end, publish_json, significant
from fontana.validate._case import Case, Stage
from fontana.validate._plots import publish_picture
from fontana.validate._registry import find_case


@dataclass(frozen=True)
class Session:
    """Which cases, how large, with what parameters, and where their results go.

    size       "small" or "full"
    overrides  parameters by path that win over the cases' scenes
    command    the command line, for the record
    """

    names: Sequence[str]
    size: str
    overrides: dict[str, object]
    out: Path
    command: list[str]

    def run(self, tell: Callable[[str, str, float], None], resume: bool = False) -> Iterator[dict]:
        """Runs the cases in turn and yields what is written of each; with `resume`, finished ones are read instead.

        `tell` gets the case, what it is at, and the finished share of that. Raises the library's errors.
        """
        cases = {name: find_case(name) for name in dict.fromkeys(self.names)}
        for name, case in cases.items():
            earlier = self._finished(name, case) if resume else None
            yield earlier or self._run_case(name, case, tell)

    def _settings(self, case: Case) -> dict:
        resolution = case.resolutions[self.size]
        return {"size": self.size, "resolution": resolution, "overrides": self.overrides}

    def _run_case(self, name: str, case: Case, tell: Callable[[str, str, float], None]) -> dict:
        results = {"case": name, "title": case.title, **describe_conditions(self.command)}
        results["settings"] = self._settings(case)
        stage = Stage(self.overrides, lambda label, share: tell(name, label, share))
        begin = time.perf_counter()
        outcome = case.measure(stage, case.resolutions[self.size])
        results["wall_seconds"] = significant(time.perf_counter() - begin)
        results |= outcome.as_json() | {"runs": stage.runs}
        note_end(results)
        publish_json(self._path(name), results)
        publish_picture(case, results, self._path(name).with_suffix(".png"))
        return results

    def _finished(self, name: str, case: Case) -> dict | None:
        """The results that lie there already, if they are of this commit and these settings."""
        try:
            earlier = json.loads(self._path(name).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        now = describe_conditions(self.command)
        same = ("commit", "versions")
        is_same = all(earlier.get(key) == now[key] for key in same) and earlier.get("settings") == self._settings(case)
        return earlier if is_same and self._path(name).with_suffix(".png").exists() else None

    def _path(self, name: str) -> Path:
        return self.out / f"{name}.json"
