"""Every file call fails once, and the process dies before each: no torn file, no lost checkpoint, no silent failure.

The first call fails in one run, the second in the next, and so on until a run has no call left to fail.
"""

import itertools
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="fail_write.c is for Linux with glibc")

FIRST_RUN = 1  # generations 1 and 2
SECOND_RUN = 3  # generations 3 and 4
EXIT_STATUS_OF_A_KILLED_RUN = 86
IO_ERROR = 7  # FONTANA_IO_ERROR
CALLS_AT_LEAST = 25  # of one run; fewer would mean that the library does not catch them


@dataclass
class Run:
    status: int
    published: list[str]
    stderr: str


class Target:
    """Runs `io_test sweep-target` in a folder, with faults."""

    def __init__(self, io_test: Path, fail_write: Path, folder: Path):
        self.io_test, self.fail_write, self.folder = io_test, fail_write, folder
        folder.mkdir()

    def run(self, number: int, faults: str = "") -> Run:
        environment = dict(os.environ, LD_PRELOAD=str(self.fail_write), FONTANA_FAIL_UNDER=str(self.folder))
        if faults:
            environment["FONTANA_FAIL_CALL"] = faults
        command = [self.io_test, "sweep-target", self.folder, str(number)]
        result = subprocess.run(command, env=environment, capture_output=True, text=True)
        return Run(result.returncode, result.stdout.split()[1::2], result.stderr)

    def files(self) -> list[str]:
        return sorted(path.name for path in self.folder.iterdir())

    def verify(self) -> tuple[list[str], list[str]]:
        """Names of the published files that read well, with what they hold, and the complaints about the others."""
        published = [self.folder / name for name in self.files() if ".tmp." not in name]
        result = subprocess.run([self.io_test, "verify", *published], capture_output=True, text=True)
        lines = result.stdout.splitlines()
        assert len(lines) == len(published)
        return [line for line in lines if line.startswith("good")], [line for line in lines if line.startswith("bad")]

    def newest_generation(self) -> int:
        good, _ = self.verify()
        return max((int(line.split()[-1]) for line in good if ".checkpoint" in line), default=0)

    def damage(self, name: str) -> None:
        path = self.folder / name
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 1
        path.write_bytes(content)


@pytest.fixture
def targets(io_test, fail_write, tmp_path):
    """As many targets as one asks for, each in a fresh folder."""
    return (Target(io_test, fail_write, tmp_path / str(number)) for number in itertools.count())


def sweep(targets, prepare, effect: str, more_faults: str = ""):
    """Yields (target, run) for each call that can fail; the run that nothing hit must be flawless and ends it."""
    for k in itertools.count(1):
        target = next(targets)
        prepare(target)
        run = target.run(SECOND_RUN, f"any:{k}:{effect}{more_faults}")
        if f"fail_write: call {k} (" in run.stderr:
            yield target, run
            continue
        assert k > CALLS_AT_LEAST, "most calls went past fail_write"
        assert run.status == 0, run.stderr
        assert run.published == ["checkpoint", "checkpoint", "bgeo"]
        assert target.newest_generation() == SECOND_RUN + 1
        return


def nothing_there(target: Target) -> None:
    pass


def two_generations_there(target: Target) -> None:
    assert target.run(FIRST_RUN).status == 0


def newest_damaged(target: Target) -> None:
    two_generations_there(target)
    target.damage("state.checkpoint")


# What is there when the run begins, and the generation that must survive it.
STARTS = {nothing_there: 0, two_generations_there: 2, newest_damaged: 1}


def assert_nothing_lost(target: Target, run: Run, start) -> None:
    _, bad = target.verify()
    if start is newest_damaged and not run.published:
        bad = [line for line in bad if "/state.checkpoint:" not in line]
    assert bad == []
    checkpoints = run.published.count("checkpoint")
    assert target.newest_generation() >= (SECOND_RUN - 1 + checkpoints if checkpoints else STARTS[start])


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("effect", ["ENOSPC", "EIO"])
def test_a_failed_call_is_reported_and_loses_nothing(targets, start, effect):
    for target, run in sweep(targets, start, effect):
        assert run.status == IO_ERROR, run.stderr
        assert str(target.folder) in run.stderr
        assert_nothing_lost(target, run, start)
        assert not [name for name in target.files() if ".tmp." in name]


def test_content_is_on_disk_before_its_name_is(targets):
    """A power cut cannot be tried here; this order of calls is what withstands it."""
    written, renamed, folder_synced = ["open", "write", "fdatasync", "close"], ["rename"], ["open", "fsync"]
    first_checkpoint = frame = written + renamed + folder_synced
    second_checkpoint = written + ["link", "rename"] + renamed + folder_synced
    run = next(targets).run(FIRST_RUN, "any:0:log")
    calls = re.findall(r"fail_write: call \d+ \((\w+)\)", run.stderr)
    assert [name for name, _ in itertools.groupby(calls)] == [
        name for name, _ in itertools.groupby(first_checkpoint + second_checkpoint + frame)
    ]


def test_a_full_disk_is_called_so(targets):
    target = next(targets)
    run = target.run(FIRST_RUN, "write:2:ENOSPC")
    assert run.status == IO_ERROR
    assert "cannot write" in run.stderr and "the disk is full" in run.stderr
    assert target.files() == []


@pytest.mark.parametrize("start", STARTS)
def test_a_process_killed_anywhere_loses_nothing(targets, start):
    for target, run in sweep(targets, start, "exit"):
        assert run.status == EXIT_STATUS_OF_A_KILLED_RUN
        assert_nothing_lost(target, run, start)
        assert target.run(SECOND_RUN).status == 0, "the next run must not stumble over what the killed one left"
        assert target.newest_generation() == SECOND_RUN + 1


@pytest.mark.parametrize("effect", ["exit", "EIO"])
def test_a_file_system_without_hard_links_loses_nothing(targets, effect):
    def keeps_both(target):
        assert target.run(FIRST_RUN, "link:0:EPERM").status == 0
        good, bad = target.verify()
        assert [line.split()[-1] for line in good if "checkpoint" in line] == ["2", "1"] and not bad

    for target, run in sweep(targets, keeps_both, effect, ",link:0:EPERM"):
        assert run.status != 0 or "(link)" in run.stderr
        assert_nothing_lost(target, run, two_generations_there)


@pytest.mark.parametrize("faults", ["write:0:short", "write:1:EINTR,fdatasync:1:EINTR,fsync:1:EINTR,close:1:EINTR"])
def test_short_and_interrupted_calls_are_no_failure(targets, faults):
    target = next(targets)
    run = target.run(FIRST_RUN, faults)
    assert "fail_write: call" in run.stderr and run.status == 0, run.stderr
    good, bad = target.verify()
    assert len(good) == 3 and not bad
