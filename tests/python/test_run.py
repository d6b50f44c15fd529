"""`fontana run` into a folder: what it leaves, how it continues, and that nothing finished is lost."""

from __future__ import annotations

import contextlib
import json
import os
import pty
import re
import resource
import signal
import subprocess
import termios
import time
from pathlib import Path

import pytest
from command_line import error_line, fontana_command

import fontana as package
from fontana.runs import stop
from fontana.runs.reporters import Reporter
from fontana.runs.runner import RunOptions, run_scene
from fontana.runs.stop import StoppedError
from fontana.scene import load_scene


def frames_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob("*.bgeo")}


def manifest_of(folder: Path) -> dict:
    return json.loads((folder / "run.json").read_text())


@pytest.fixture
def whole(fontana, drop_file: Path, tmp_path: Path) -> dict[str, bytes]:
    """The frames of an undisturbed run of six."""
    fontana("run", drop_file, "--out", "whole", "--no-picture", "--quiet")
    frames = frames_of(tmp_path / "whole")
    assert len(frames) == 6
    return frames


def test_a_run_leaves_frames_a_picture_and_a_report(fontana, drop_file: Path, tmp_path: Path) -> None:
    done = fontana("run", drop_file, "--format", "bgeo", "--format", "ply", "--profile")
    out = tmp_path / "out" / "drop"
    names = {path.name for path in out.iterdir()}
    expected = {f"drop.{frame:04d}.{kind}" for frame in range(1, 7) for kind in ("bgeo", "ply")}
    assert names == expected | {"drop.checkpoint", "drop.png", "run.json"}
    data = manifest_of(out)
    assert data["state"] == "finished"
    assert [frame["frame"] for frame in data["frames"]] == [1, 2, 3, 4, 5, 6]
    assert data["derived"]["kinematic_viscosity"] == pytest.approx(5 / 1000)
    assert data["device"]["backend"] == "cpu"
    assert data["profile"]["rows"][0]["launches"] > 0
    last = data["frames"][-1]
    assert {"time", "particles", "substeps", "dt_min", "dt_max", "limit", "max_speed", "seconds"} <= last.keys()
    for file in last["files"]:
        content = (out / file["file"]).read_bytes()
        assert file["bytes"] == len(content)
        assert int(file["hash"], 16) == package._core.hash(content)
    assert (out / "drop.png").read_bytes().startswith(b"\x89PNG")
    for word in (
        "viscosity 5 Pa.s (kinematic 0.005 m^2/s)",
        "frame 6/6",
        "done: 6 frames",
        "drop.png",
        "next: fontana",
    ):
        assert word in done.stdout


def test_json_lines_tell_each_frame(fontana, drop_file: Path) -> None:
    lines = fontana("run", drop_file, "--json", "--no-picture").stdout.splitlines()
    events = [json.loads(line) for line in lines]
    assert [event["event"] for event in events] == ["start", *["frame"] * 6, "finish"]
    assert events[3]["frame"] == 3


def show_on_terminal(drop_file: Path, folder: Path, columns: int) -> str:
    """What `fontana run` writes to a terminal of so many columns."""
    master, slave = pty.openpty()
    termios.tcsetwinsize(slave, (24, columns))
    command = fontana_command("run", drop_file, "--no-picture")
    # readline, where something imported it, tells child processes its own COLUMNS; os.environ does not have them.
    ends = {"stdin": slave, "stdout": slave, "stderr": slave, "env": dict(os.environ)}
    with subprocess.Popen(command, cwd=folder, close_fds=True, **ends) as process:
        os.close(slave)
        shown = b""
        with contextlib.suppress(OSError):  # how Linux says that the other end is closed
            while part := os.read(master, 4096):
                shown += part
        os.close(master)
    assert process.returncode == 0
    return shown.decode()


def test_a_terminal_gets_a_bar(drop_file: Path, tmp_path: Path) -> None:
    shown = show_on_terminal(drop_file, tmp_path, columns=120)
    for word in ("frame 6/6", "\u2501\u2501", "216 particles", "done: 6 frames"):
        assert word in shown


def test_a_narrow_terminal_gets_the_whole_of_a_frame(drop_file: Path, tmp_path: Path) -> None:
    shown = show_on_terminal(drop_file, tmp_path, columns=60)
    words = " ".join(re.sub(r"\x1b\[[\d;?]*[a-zA-Z]", "", shown).split())
    assert re.search(r"density \+[\d.]+% \(max [\d.]+%\) in [\d.]+ iterations", words)


def test_two_runs_give_the_same_bytes(fontana, whole, drop_file: Path, tmp_path: Path) -> None:
    fontana("run", drop_file, "--out", "again", "--no-picture", "--quiet", "--threads", 1)
    assert frames_of(tmp_path / "again") == whole


def test_the_same_command_continues_and_resume_adds_frames(fontana, whole, drop_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "parts"
    common = ["run", drop_file, "--out", out, "--no-picture"]
    fontana(*common, "--frames", 2, "--checkpoint-every", 1)
    done = fontana(*common, "--frames", 4, "--checkpoint-every", 1)
    assert "continues after frame 2" in done.stdout
    assert "frame 2/4" not in done.stdout
    fontana("resume", out, "--frames", 6)
    assert frames_of(out) == whole
    assert "all 6 frames are there" in fontana("resume", out, "--frames", 6).stdout


@pytest.mark.parametrize("again", [(), ("--restart",)])
def test_a_device_that_refuses_leaves_the_frames_alone(fontana, whole, drop_file: Path, tmp_path: Path, again) -> None:
    out = tmp_path / "kept"
    common = ("run", drop_file, "--out", out, "--no-picture")
    fontana(*common)
    absent = {"FONTANA_OPENCL_LIBRARY": "/nowhere/libOpenCL.so"}
    done = fontana(*common, "--backend", "opencl", *again, env=absent, code=5)
    assert "/nowhere/libOpenCL.so" in error_line(done) and done.stdout == ""
    assert frames_of(out) == whole


def test_resume_goes_on_without_the_scene_file(fontana, whole, drop_file: Path, tmp_path: Path) -> None:
    fontana("run", drop_file, "--out", "moved", "--frames", 3, "--no-picture")
    drop_file.unlink()
    fontana("resume", "moved", "--frames", 6)
    assert frames_of(tmp_path / "moved") == whole
    assert not (tmp_path / "moved" / "drop.png").exists()


def test_an_old_frame_that_was_cut_is_simulated_again(fontana, whole, drop_file: Path, tmp_path: Path) -> None:
    """Of frames further back than the last few, only the size is looked at."""
    out = tmp_path / "harmed"
    fontana("run", drop_file, "--out", out, "--frames", 5, "--no-picture")
    victim = out / "drop.0001.bgeo"
    victim.write_bytes(victim.read_bytes()[:-9])
    done = fontana("run", drop_file, "--out", out, "--no-picture")
    assert "frame 1 on disk is damaged or missing" in done.stdout
    assert "starting at frame 1 again" in done.stdout
    assert frames_of(out) == whole


@pytest.mark.parametrize("harm", ["cut", "changed", "gone"])
def test_a_damaged_frame_is_simulated_again(fontana, whole, drop_file: Path, tmp_path: Path, harm: str) -> None:
    out = tmp_path / "harmed"
    fontana("run", drop_file, "--out", out, "--frames", 5, "--checkpoint-every", 3, "--no-picture")
    victim = out / "drop.0004.bgeo"
    content = victim.read_bytes()
    if harm == "gone":
        victim.unlink()
    else:
        victim.write_bytes(content[:-9] if harm == "cut" else content[:-9] + b"\x00" + content[-8:])
    done = fontana("run", drop_file, "--out", out, "--no-picture")
    assert "frame 4 on disk is damaged or missing" in done.stdout
    assert "continues after frame 3" in done.stdout
    assert frames_of(out) == whole


def test_a_damaged_checkpoint_falls_back_to_the_one_before(fontana, whole, drop_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    fontana("run", drop_file, "--out", out, "--frames", 4, "--checkpoint-every", 2, "--no-picture")
    checkpoint = out / "drop.checkpoint"
    content = bytearray(checkpoint.read_bytes())
    content[len(content) // 2] ^= 1
    checkpoint.write_bytes(content)
    done = fontana("run", drop_file, "--out", out, "--no-picture")
    assert "drop.checkpoint cannot be used" in done.stdout
    assert "continues after frame 2" in done.stdout
    assert frames_of(out) == whole
    for path in out.glob("*checkpoint*"):
        path.write_bytes(b"nothing")
    (out / "drop.0006.bgeo").unlink()
    assert "starting at frame 1 again" in fontana("run", drop_file, "--out", out, "--no-picture").stdout
    assert frames_of(out) == whole


def test_a_changed_scene_is_refused_with_the_keys(fontana, drop_file: Path, tmp_path: Path) -> None:
    common = ["run", drop_file, "--out", "out", "--no-picture"]
    fontana(*common, "--frames", 2)
    changed = [*common, "--set", "fluid.viscosity=6", "--set", "colliders[1].radius=0.12"]
    line = error_line(fontana(*changed, code=2))
    assert "fluid.viscosity, colliders[1].radius" in line
    assert "--accept-changed" in line
    assert "use the same --format" in error_line(fontana(*common, "--format", "ply", code=2))
    assert "all 2 frames are there" in fontana(*changed, "--accept-changed", "--frames", 2).stdout
    assert "continues after frame 2" in fontana(*changed, "--frames", 3).stdout
    fontana(*changed, "--restart", "--format", "npz", "--frames", 2)
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "drop.0001.npz",
        "drop.0002.npz",
        "drop.checkpoint",
        "run.json",
    ]


def test_a_checkpoint_of_another_scene_is_not_used(fontana, whole, drop_file: Path, tmp_path: Path) -> None:
    fontana("run", drop_file, "--out", "other", "--frames", 2, "--set", "fluid.viscosity=6", "--no-picture")
    fontana("run", drop_file, "--out", "out", "--frames", 2, "--no-picture")
    os.replace(tmp_path / "other" / "drop.checkpoint", tmp_path / "out" / "drop.checkpoint")
    done = fontana("run", drop_file, "--out", "out", "--no-picture")
    assert "drop.checkpoint belongs to another scene" in done.stdout
    assert frames_of(tmp_path / "out") == whole


def test_where_it_runs_may_change(fontana, drop_file: Path) -> None:
    fontana("run", drop_file, "--out", "out", "--frames", 2, "--no-picture")
    done = fontana(
        "run", drop_file, "--out", "out", "--frames", 3, "--neighbors", "all-pairs", "--threads", 1, "--no-picture"
    )
    assert "continues after frame 2" in done.stdout


def test_frames_of_others_are_not_replaced(fontana, drop_file: Path, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "drop.0003.bgeo").write_text("precious")
    line = error_line(fontana("run", drop_file, "--out", "out", code=2))
    assert "drop.0003.bgeo" in line
    assert (tmp_path / "out" / "drop.0003.bgeo").read_text() == "precious"


@pytest.mark.parametrize(
    "content",
    ["", "[]", '{"state": "running"}', '{"frames": [{"frame": 1, "files": [{"file": "../../x"}]}]}', "\x00"],
)
def test_a_run_json_that_is_not_ours_is_refused(fontana, drop_file: Path, tmp_path: Path, content: str) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "run.json").write_text(content)
    assert "--restart" in error_line(fontana("run", drop_file, "--out", "out", code=2))
    fontana("run", drop_file, "--out", "out", "--restart", "--frames", 1, "--no-picture")


@pytest.mark.parametrize("change", [{"files": []}, {"time": None}, {"particles": "many"}])
def test_a_run_json_whose_frames_were_edited_is_refused(fontana, drop_cache: Path, change: dict) -> None:
    data = manifest_of(drop_cache)
    data["frames"][0] |= change
    (drop_cache / "run.json").write_text(json.dumps(data))
    assert "--restart begins anew" in error_line(fontana("resume", drop_cache, code=2))


def test_names_need_not_be_utf_8(fontana, drop_file: Path, tmp_path: Path) -> None:
    """A folder off an old disk, before and behind a stop; and a terminal that cannot show its name."""
    out = Path(os.fsdecode(os.fsencode(tmp_path) + b"/lat\xedn"))
    strict = {"PYTHONIOENCODING": "utf-8:strict"}
    fontana("run", drop_file, "--out", out, "--frames", 2, env=strict)
    resumed = fontana("resume", out, "--frames", 3, env=strict)
    assert "continues after frame 2" in resumed.stdout
    assert r"lat\udcedn" in resumed.stdout
    assert (out / "drop.0003.bgeo").exists()
    (out / "drop.checkpoint").write_bytes(b"cut")
    (out / "drop.checkpoint.previous").unlink()
    assert "drop.checkpoint cannot be used" in fontana("resume", out, "--frames", 4, env=strict).stdout


@pytest.mark.parametrize("style", [(), ("--json",)])
def test_a_log_that_nobody_reads_stops_the_run_and_the_same_command_continues(
    fontana, drop_file: Path, tmp_path: Path, style: tuple[str, ...]
) -> None:
    read, write = os.pipe()
    os.close(read)
    run = subprocess.run(
        fontana_command("run", drop_file, *style), cwd=tmp_path, stdout=write, stderr=subprocess.PIPE, text=True
    )
    os.close(write)
    assert run.returncode == 6
    sentence = "cannot write to standard output: its reader is gone; the same command continues"
    assert error_line(run) == f"fontana: {sentence}"
    fontana("run", drop_file)
    with open("/dev/full", "w") as full:
        run = subprocess.run(
            fontana_command("run", drop_file, *style), cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert "cannot write to standard output: No space left on device" in error_line(run)


def test_closed_streams_harm_nothing(whole, drop_file: Path, tmp_path: Path) -> None:
    command = " ".join(fontana_command("run", drop_file, "--out", "run", "--backend", "cpu"))
    assert subprocess.run(["sh", "-c", f"{command} >&- 2>&-"], cwd=tmp_path).returncode == 0
    assert frames_of(tmp_path / "run") == whole


def test_an_output_that_cannot_be_written_is_exit_code_6(fontana, drop_file: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert "cannot write to" in error_line(fontana("run", drop_file, "--out", "file/out", code=6))
    assert "it is a file, not a folder" in error_line(fontana("run", drop_file, "--out", "file", code=6))


def test_a_full_disk_keeps_the_frames_so_far(fontana, whole, drop_file: Path, tmp_path: Path) -> None:
    """A limit on the size of a file stops run.json, which grows, in mid-run."""
    size = len(next(iter(whole.values())))

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (size + 3000, size + 3000))

    out = tmp_path / "out"
    arguments = ["run", drop_file, "--out", out, "--frames", 60, "--checkpoint-every", 100, "--no-picture", "--quiet"]
    line = error_line(fontana(*arguments, preexec_fn=limit, code=6))
    assert "run.json" in line
    frames = frames_of(out)
    assert 6 < len(frames) < 60
    assert {name: frames[name] for name in whole} == whole
    assert not list(out.glob("*.tmp*"))
    fontana("run", drop_file, "--out", out, "--frames", len(frames), "--no-picture", "--quiet")
    assert frames_of(out) == frames


def test_an_unstable_run_is_exit_code_4_and_keeps_its_frames(fontana, drop: dict, tmp_path: Path) -> None:
    """A jet of extreme speed comes late and needs more substeps than the scene allows."""
    drop["emitters"].append(
        {"type": "disc", "radius": 0.1, "centre": [0, 2, 0], "speed": 1e5, "rate": 1e3, "first_frame": 4}
    )
    (tmp_path / "drop.json").write_text(json.dumps(drop))
    line = error_line(fontana("run", "drop.json", "--out", "out", "--quiet", code=4))
    assert "substeps" in line
    assert len(frames_of(tmp_path / "out")) == 3
    data = manifest_of(tmp_path / "out")
    assert data["state"] == "failed"
    assert data["message"] == line.removeprefix("fontana: ")


def test_too_little_memory_is_exit_code_3_before_anything_starts(fontana, drop: dict, tmp_path: Path) -> None:
    """A jet of a billion particles, in the end: some 170 GB."""
    if max(device.memory_bytes for device in package.devices()) > 200e9:
        pytest.skip("this machine could hold them")
    drop["fluid"]["particle_spacing"] = 1e-3
    drop["emitters"] = [{"type": "disc", "radius": 0.1, "speed": 10}]
    (tmp_path / "drop.json").write_text(json.dumps(drop | {"output": {"frames": 80}}))
    for arguments in ([], ["--dry-run"]):
        line = error_line(fontana("run", "drop.json", "--set", "time.max_substeps=100000", *arguments, code=3))
        assert "larger fluid.particle_spacing" in line


@pytest.fixture
def start(tmp_path: Path):
    """Starts the command line and gives the process; what still runs at the end is killed."""
    processes = []

    def call(*arguments: object) -> subprocess.Popen:
        process = subprocess.Popen(
            fontana_command(*arguments), cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        processes.append(process)
        return process

    yield call
    for process in processes:
        process.kill()
        process.communicate()


def wait_for(process: subprocess.Popen, word: str) -> None:
    for line in process.stdout:
        if word in line:
            return
    raise AssertionError(f"{word} never came: {process.stderr.read()}")


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_saves_and_the_same_command_continues(
    fontana, start, whole, drop_file: Path, tmp_path: Path, number: int, code: int
) -> None:
    out = tmp_path / "out"
    process = start("run", drop_file, "--out", out, "--frames", 100000, "--checkpoint-every", 100000, "--no-picture")
    wait_for(process, "frame      3/")
    process.send_signal(number)
    _, stderr = process.communicate(timeout=60)
    assert process.returncode == code
    assert "stopping after this frame" in stderr
    assert re.search(r"stopped after frame \d+ of \d+; fontana resume \S+ goes on", stderr)
    done = len(frames_of(out))
    assert manifest_of(out)["state"] == "interrupted"
    assert len(manifest_of(out)["frames"]) == done >= 3
    result = fontana("run", drop_file, "--out", out, "--frames", done + 3, "--no-picture")
    assert f"continues after frame {done}" in result.stdout
    frames = frames_of(out)
    assert len(frames) == done + 3
    assert {name: frames[name] for name in whole if name in frames} == {n: whole[n] for n in whole if n in frames}
    assert not (out / "run.lock").exists()


def test_a_kill_costs_at_most_the_frames_since_the_checkpoint(
    fontana, start, whole, drop_file: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    process = start("run", drop_file, "--out", out, "--frames", 100000, "--checkpoint-every", 2, "--no-picture")
    wait_for(process, "frame      5/")
    process.kill()
    process.wait()
    kept = len(manifest_of(out)["frames"])
    done = fontana("run", drop_file, "--out", out, "--frames", kept + 2, "--no-picture")
    assert f"took over from process {process.pid}, which is gone" in done.stdout
    assert any(f"continues after frame {frame}" in done.stdout for frame in (kept - 2, kept - 1, kept))
    frames = frames_of(out)
    assert len(frames) >= kept + 2
    assert {name: frames[name] for name in whole} == whole


def test_a_frame_that_takes_too_long_is_stopped_inside_and_continued(
    monkeypatch, drop: dict, whole, tmp_path: Path
) -> None:
    """The signal comes from within the third frame, with no patience for its end; the rest goes on from there."""
    monkeypatch.setattr(stop, "PATIENCE", 0.0)

    class Interrupting(Reporter):
        frames = 0

        def frame(self, record: dict, frame_count: int) -> None:
            self.frames += 1

        def substep(self, fraction: float) -> None:
            if self.frames == 2 and fraction > 0.5:
                self.frames = 100
                os.kill(os.getpid(), signal.SIGINT)

    class Listening(Reporter):
        def __init__(self) -> None:
            self.fractions: list[float] = []

        def substep(self, fraction: float) -> None:
            self.fractions.append(fraction)

    scene, options = load_scene(drop), RunOptions(out=tmp_path / "inside", checkpoint_every=2, picture=False)
    with pytest.raises(StoppedError, match="stopped after frame 2 of 6"):
        run_scene(scene, options, Interrupting())
    assert len(frames_of(options.out)) == 2
    rest = Listening()
    run_scene(scene, options, rest)
    assert rest.fractions[0] > 0.5
    assert frames_of(options.out) == whole


def test_a_second_signal_stops_at_once(start, fontana, drop_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    long = ["--set", "time.substeps=100000", "--set", "time.timestep=1"]
    process = start("run", drop_file, "--out", out, *long, "--neighbors", "all-pairs", "--no-picture")
    wait_for(process, "device:")
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    assert "once more stops at once" in process.stderr.readline()
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=4) == -signal.SIGINT
    assert len(frames_of(out)) == 0


def test_a_folder_in_use_is_refused_and_its_owner_named(fontana, start, drop_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    process = start("run", drop_file, "--out", out, "--frames", 100000, "--no-picture")
    wait_for(process, "frame      1/")
    line = error_line(fontana("run", drop_file, "--out", out, code=2))
    assert f"in use by process {process.pid}" in line
    assert process.poll() is None


def test_a_lock_of_another_host_or_of_nobody_is_not_broken(fontana, drop_file: Path, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    lock = tmp_path / "out" / "run.lock"
    lock.write_text(json.dumps({"host": "elsewhere", "pid": 1, "started": "1", "since": "yesterday"}))
    assert "process 1 on elsewhere, since yesterday" in error_line(fontana("run", drop_file, "--out", "out", code=2))
    lock.write_text("not a lock")
    assert "is not a lock of Fontana" in error_line(fontana("run", drop_file, "--out", "out", code=2))
