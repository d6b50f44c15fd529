"""The kernel cache: used the second time, refused where it is not safe, harmless where it is damaged."""

import os
import stat
import struct

import pytest

from fontana import _core

MAGIC = b"FONTKRN1"


def source_builds(small_run, **environment):
    return small_run.calls(small_run.compiling, **environment)


def only_entry(small_run):
    (entry,) = small_run.cache.glob("*")
    assert entry.suffix == ".bin"
    return entry


def test_the_second_run_compiles_nothing(small_run):
    assert only_entry(small_run).read_bytes().startswith(MAGIC)
    assert source_builds(small_run) == 0
    assert small_run.calls(small_run.loading) == 1


def test_an_empty_cache_is_filled(small_run):
    only_entry(small_run).unlink()
    assert source_builds(small_run) == 1
    only_entry(small_run)


def test_the_cache_belongs_to_its_owner_alone(small_run):
    assert stat.S_IMODE(small_run.cache.stat().st_mode) == 0o700
    assert stat.S_IMODE(only_entry(small_run).stat().st_mode) == 0o600


def test_a_cached_program_gives_the_same_results(small_run):
    cached = small_run.lines()
    assert cached == small_run.lines(FONTANA_KERNEL_CACHE="off")


def test_strict_and_fast_programs_have_different_entries(small_run):
    first = only_entry(small_run).name
    small_run.lines("solver.precision=strict")
    assert len({entry.name for entry in small_run.cache.glob("*.bin")} - {first}) == 1


def test_off_neither_reads_nor_writes(small_run):
    only_entry(small_run).unlink()
    assert source_builds(small_run, FONTANA_KERNEL_CACHE="off") == 1
    assert list(small_run.cache.iterdir()) == []


def test_an_unknown_setting_is_refused(small_run):
    run = small_run.lines(FONTANA_KERNEL_CACHE="of")[-1]
    assert run["error"] == "BadInput"
    assert run["sentence"] == "the environment variable FONTANA_KERNEL_CACHE is 'of': expected on or off"


def assert_unused(small_run, reason):
    """The run works, compiles its kernels, says why, and leaves no file."""
    before = {entry.name: entry.read_bytes() for entry in small_run.cache.iterdir()}
    result = small_run.start("calls", small_run.layer, small_run.compiling)
    assert result.returncode == 0
    assert '"calls": 1' in result.stdout
    assert f"{small_run.cache} is not used, because {reason}" in result.stderr
    assert {entry.name: entry.read_bytes() for entry in small_run.cache.iterdir()} == before


@pytest.mark.parametrize("mode", [0o777, 0o770, 0o702])
def test_a_folder_that_others_may_write_to_is_refused(small_run, mode):
    small_run.cache.chmod(mode)
    assert_unused(small_run, "others may write to it")


def test_a_symbolic_link_is_refused(small_run, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    small_run.cache.rename(elsewhere)
    small_run.cache.symlink_to(elsewhere)
    assert_unused(small_run, "it is a symbolic link")


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a folder away")
def test_the_folder_of_another_user_is_refused(small_run):
    os.chown(small_run.cache, 65534, 65534)
    assert_unused(small_run, "it belongs to another user")


def test_an_entry_that_is_a_symbolic_link_is_not_followed(small_run, tmp_path):
    entry = only_entry(small_run)
    entry.rename(tmp_path / "elsewhere.bin")
    entry.symlink_to(tmp_path / "elsewhere.bin")
    assert source_builds(small_run) == 1
    assert not entry.is_symlink()


def flip_a_bit(content):
    damaged = bytearray(content)
    damaged[len(damaged) // 2] ^= 1
    return bytes(damaged)


def whole_but_no_program(content):
    """What only the driver can find out."""
    nonsense = bytes(range(256)) * 16
    return MAGIC + struct.pack("<QQ", len(nonsense), _core.hash(nonsense)) + nonsense


DAMAGES = {
    "a bit flipped": flip_a_bit,
    "cut off": lambda content: content[: len(content) // 2],
    "no header": lambda content: content[:10],
    "empty": lambda content: b"",
    "absurd size": lambda content: MAGIC + struct.pack("<QQ", 1 << 60, 0) + content[24:],
    "not a program": whole_but_no_program,
}


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES.keys())
def test_a_damaged_entry_is_compiled_anew_and_replaced(small_run, damage):
    entry = only_entry(small_run)
    expected = small_run.lines()
    entry.write_bytes(damage(entry.read_bytes()))
    assert source_builds(small_run) == 1
    assert source_builds(small_run) == 0
    assert small_run.lines() == expected


@pytest.mark.parametrize("variables", [{"XDG_CACHE_HOME": "/proc/none"}, {"XDG_CACHE_HOME": "", "HOME": "/proc/none"}])
def test_without_a_place_for_the_cache_it_works_all_the_same(small_run, variables):
    assert small_run.lines(**variables) == small_run.lines()
