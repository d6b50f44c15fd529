"""Every kernel compiles for GPUs that are not here, and none needs scratch memory there. Nothing is run."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import compile_table  # noqa: E402
from compile_tables import amd, source, spirv  # noqa: E402

# A private array with an index that is known only at run time cannot live in registers.
NEEDS_SCRATCH = """
__kernel void needs_scratch(const uint count, __global uint* value) {
    uint table[64];
    for (uint k = 0u; k < 64u; ++k) table[k] = value[k] * k;
    value[get_global_id(0)] = table[value[count] & 63u] + table[value[count + 1u] & 63u];
}
__kernel void needs_none(__global uint* value) { value[get_global_id(0)] = 1u; }
"""


@pytest.fixture(params=[amd, spirv], ids=["amd", "spirv"])
def vendor(request):
    require(request.param)
    return request.param


def require(module):
    reason = module.missing()
    if reason and os.environ.get("CI") == "true":
        pytest.fail(reason)
    if reason:
        pytest.skip(reason)


def test_every_kernel_compiles_for_every_target_without_scratch(vendor):
    text = source.kernel_text()
    listed = re.findall(r"^KERNEL_ENTRY\((\w+)", (ROOT / "src/fontana/kernels/kernel_list.def").read_text(), re.M)
    kernels = source.kernel_names(text)
    assert {*listed, "sort_histogram", "sort_order_ties"} <= set(kernels)
    rows = vendor.rows(text, vendor.TARGETS)
    assert sorted((row["kernel"], row["target"]) for row in rows) == sorted(
        (kernel, target) for kernel in kernels for target in vendor.TARGETS
    )
    assert [row["kernel"] for row in rows if row["scratch_bytes"] or row["spill_bytes"]] == []


def test_amd_registers_and_work_group_memory_are_read():
    require(amd)
    rows = {row["kernel"]: row for row in amd.rows(source.kernel_text(), ["gfx1030"])}
    assert all(1 <= row["registers"] <= 256 and 1 <= row["occupancy"] <= 16 for row in rows.values())
    assert rows["fluid_force"]["registers"] > rows["assign_cells"]["registers"]
    assert rows["sort_scan_blocks"]["shared_bytes"] == 128 * 4


def test_scratch_memory_is_noticed():
    require(amd)
    rows = {row["kernel"]: row for row in amd.rows(NEEDS_SCRATCH, ["gfx90a"])}
    assert rows["needs_scratch"]["scratch_bytes"] >= 64 * 4
    assert rows["needs_none"]["scratch_bytes"] == 0
    results = {"rows": list(rows.values()), "kernels": ["needs_scratch", "needs_none", "lost"], "missing": {}}
    scratch, lost = compile_table.complaints(results, strict=True)
    assert "needs_scratch on gfx90a" in scratch
    assert lost == "gfx90a lacks lost"


def test_a_kernel_that_does_not_compile_is_a_sentence(vendor):
    with pytest.raises(source.CompilerError, match="no_such_type"):
        vendor.rows("__kernel void broken(no_such_type a) {}", vendor.TARGETS[:1])


def test_the_tool_writes_one_table(tmp_path):
    command = [sys.executable, ROOT / "tools/compile_table.py", "--out", tmp_path]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    results = json.loads((tmp_path / "compile_table.json").read_text())
    table = (tmp_path / "compile_table.md").read_text()
    assert len(re.findall(r"^\| \w+ \|", table, re.M)) == len(results["kernels"]) + 1
    assert "MISSING" not in table
    for name, reason in results["missing"].items():
        assert f"- no {name}: {reason}" in table
