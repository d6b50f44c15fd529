"""Every kernel compiles for GPUs that are not here, and none needs scratch memory there. Nothing is run."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import compile_table  # noqa: E402
from compile_tables import amd, nvidia, source, spirv  # noqa: E402

# A private array with an index that is known only at run time cannot live in registers.
NEEDS_SCRATCH = """
__kernel void needs_scratch(const uint count, __global uint* value) {
    uint table[64];
    for (uint k = 0u; k < 64u; ++k) table[k] = value[k] * k;
    value[get_global_id(0)] = table[value[count] & 63u] + table[value[count + 1u] & 63u];
}
__kernel void needs_none(__global uint* value) { value[get_global_id(0)] = 1u; }
"""


@pytest.fixture(params=[amd, nvidia, spirv], ids=["amd", "nvidia", "spirv"])
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


# Per thread 64 values, all of them alive at once, in the 32 registers that a block of 1024 leaves twice to a unit.
SPILLS = """
extern "C" __global__ __launch_bounds__(1024, 2) void spills(float* value) {
    float kept[64];
    #pragma unroll
    for (int k = 0; k < 64; ++k) kept[k] = value[threadIdx.x + 1024 * k];
    __syncthreads();
    #pragma unroll
    for (int k = 0; k < 64; ++k) value[threadIdx.x + 1024 * k] = kept[63 - k];
}
"""


def test_nvidia_registers_and_work_group_memory_are_read():
    require(nvidia)
    rows = {row["kernel"]: row for row in nvidia.rows(source.kernel_text(), ["sm_89"])}
    assert all(1 <= row["registers"] <= 255 for row in rows.values())
    assert rows["fluid_force"]["registers"] > rows["assign_cells"]["registers"]
    assert rows["sort_scan_blocks"]["shared_bytes"] == 128 * 4
    assert rows["density"]["shared_bytes"] == 0


def test_nvidia_spills_are_noticed():
    require(nvidia)
    (row,) = nvidia.rows(SPILLS, ["sm_80"])
    assert row["spill_bytes"] > 0
    assert row["scratch_bytes"] > 0


def test_nvidia_registers_are_what_the_makers_tool_reads_out_of_the_machine_code(tmp_path):
    require(nvidia)
    wheels = sorted(Path(sys.prefix).glob("lib/*/*/nvidia/*/bin/cuobjdump"))
    place = shutil.which("cuobjdump") or next(iter(wheels), None)
    if place is None:
        reason = "cuobjdump is not installed (pip install nvidia-cuda-cuobjdump)"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    text = source.kernel_text()
    image = tmp_path / "kernels.cubin"
    image.write_bytes(nvidia.machine_code(text, "sm_80"))
    listing = subprocess.run([place, "-res-usage", image], capture_output=True, text=True, check=True).stdout
    pattern = r"Function (\w+):\s+REG:(\d+) STACK:(\d+) SHARED:(\d+)"
    read = {name: tuple(map(int, numbers)) for name, *numbers in re.findall(pattern, listing)}
    assert read == {
        row["kernel"]: (row["registers"], row["scratch_bytes"], row["shared_bytes"])
        for row in nvidia.rows(text, ["sm_80"])
    }


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
