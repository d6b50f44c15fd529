"""Commands that only tell: devices, scenes, schema, explain, fluids."""

from __future__ import annotations

import json
import math
import textwrap

import click
from rich.console import Console
from rich.table import Table

from fontana import _core
from fontana.errors import SceneError, clean
from fontana.fluid_table import fluids as fluid_table
from fontana.reader import read_json
from fontana.runs.text import data_size
from fontana.scene import bundled_scenes
from fontana.schema import scene_schema
from fontana.tables import COLLIDERS, EMITTERS, KEY_FIELDS, VIEW_FIELDS, groups, nearest, parameters, suggestion
from fontana.units import readable, show

_as_json = click.option("--json", "as_json", is_flag=True, help="As JSON.")


def print_table(columns: list[str], rows: list[list[str]]) -> None:
    """A table without lines, cut by nothing: a pipe gets whole rows."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for column in columns:
        table.add_column(column, overflow="fold")
    for row in rows:
        table.add_row(*row)
    console = Console(highlight=False, markup=False)
    if not console.is_terminal:
        console = Console(highlight=False, markup=False, width=200)
    with console.capture() as lines:
        console.print(table)
    click.echo("\n".join(line.rstrip() for line in lines.get().splitlines()))


@click.command(short_help="What can compute here, and what cannot and why.")
@_as_json
def devices(as_json: bool) -> None:
    """List what can compute here, and what cannot and why.

    \b
    Examples:
      fontana devices
      fontana run box --backend opencl
    """
    found = _core.devices()
    if as_json:
        names = ("backend", "name", "driver", "memory_bytes", "compute_units", "is_gpu", "neighbors")
        names += ("available", "reason")
        click.echo(json.dumps([{name: getattr(device, name) for name in names} for device in found], indent=1))
        return
    print_table(
        ["backend", "device", "kind", "units", "memory", "neighbours", "driver"],
        [
            [
                device.backend,
                device.name,
                "GPU" if device.is_gpu else "CPU",
                str(device.compute_units),
                data_size(device.memory_bytes),
                ", ".join(device.neighbors),
                device.driver,
            ]
            for device in found
            if device.available
        ],
    )
    for device in found:
        if not device.available:
            click.echo(f"not available: {device.backend}{f' ({device.name})' if device.name else ''}: {device.reason}")
    chosen = _core.choose_device("auto")
    why = "the first GPU" if chosen.is_gpu else "there is no GPU"
    click.echo(f"--backend auto takes {chosen.backend} ({chosen.name}): {why}")


@click.command()
@_as_json
def scenes(as_json: bool) -> None:
    """List the scenes that come with Fontana.

    \b
    Examples:
      fontana scenes
      fontana run fountain
    """
    listed = {name: read_json(path) for name, path in bundled_scenes().items()}
    if as_json:
        paths = bundled_scenes()
        entries = [
            {"name": name, "path": str(paths[name]), "description": scene.get("description", "")}
            for name, scene in listed.items()
        ]
        click.echo(json.dumps(entries, indent=1))
        return
    print_table(["scene", "what it shows"], [[name, scene.get("description", "")] for name, scene in listed.items()])
    click.echo(f"files: {next(iter(bundled_scenes().values())).parent}" if listed else "none found")


@click.command()
def schema() -> None:
    """Print the JSON Schema of scene files.

    \b
    Examples:
      fontana schema > scene.schema.json
    """
    click.echo(json.dumps(scene_schema(), indent=2))


@click.command(short_help="What a parameter, an emitter or a collider means.")
@click.argument("name", required=False)
def explain(name: str | None) -> None:
    """Say what a parameter, an emitter or a collider means; without NAME, list them.

    \b
    Examples:
      fontana explain
      fontana explain fluid.viscosity
      fontana explain viscosity
      fontana explain cylinder_inside
    """
    if name is None:
        _list_parameters()
        return
    key = name.strip()
    short = {path.split(".")[1]: path for path in parameters()}
    path = key if key in parameters() else short.get(key)
    if path:
        _explain_parameter(parameters()[path])
        return
    shapes = EMITTERS | COLLIDERS | {"keys": KEY_FIELDS, "view": VIEW_FIELDS}
    if key in shapes:
        _explain_fields(key, shapes[key])
        return
    near = nearest(key, [*parameters(), *short, *shapes])
    hint = f"; did you mean {short.get(near, near)}?" if near else "; `fontana explain` lists them all"
    raise SceneError(f'there is no "{clean(key)}" to explain{hint}')


def _list_parameters() -> None:
    rows = []
    for table in groups().values():
        rows += [[item.name, _default(item), item.label] for item in table.values()]
    print_table(["parameter", "default", "what it is"], rows)
    click.echo(f"emitters: {', '.join(EMITTERS)}")
    click.echo(f"colliders: {', '.join(COLLIDERS)}")
    click.echo("more: fontana explain NAME")


def _explain_parameter(item: object) -> None:
    click.echo(f"{item.name}: {item.label}")
    click.echo(textwrap.fill(item.doc, 100, initial_indent="  ", subsequent_indent="  "))
    click.echo(f"  default  {_default(item)}")
    if item.choices:
        click.echo(f"  choices  {', '.join(item.choices)}")
    elif item.type in ("float", "int"):
        click.echo(f"  range    {show(item.minimum)} to {show(item.maximum, item.unit)}")
    if item.unit:
        click.echo(f"  unit     {readable(item.unit)}; other units of that kind are converted")
    click.echo(f"  try      fontana run box --set {item.name}={_example(item)}")


def _default(item: object) -> str:
    if item.type == "vector":
        return f"[{', '.join(show(part) for part in item.default)}] {readable(item.unit)}".strip()
    if item.type in ("float", "int"):
        return show(item.default, item.unit)
    return str(item.default).lower()


def _example(item: object) -> str:
    if item.type == "vector":
        return ",".join(show(part) for part in item.default)
    return show(item.default) if item.type in ("float", "int") else str(item.default).lower()


def _explain_fields(name: str, fields: tuple) -> None:
    click.echo(f"{name}:")
    rows = []
    for field in fields:
        bounds = [show(bound) if math.isfinite(bound) else "" for bound in (field.minimum, field.maximum)]
        span = f"{bounds[0]} to {bounds[1]}" if all(bounds) else f"from {bounds[0]}" if bounds[0] else ""
        rows.append(
            [f"  {field.name}", readable(field.unit), span, field.doc + (" Required." if field.required else "")]
        )
    print_table(["  field", "unit", "range", "what it is"], rows)


@click.command(short_help="The named fluids and their measured values.")
@click.argument("name", required=False)
@_as_json
def fluids(name: str | None, as_json: bool) -> None:
    """List the named fluids with their measured values; with NAME, ranges and sources too.

    \b
    Examples:
      fontana fluids
      fontana fluids honey
      fontana run box --set fluid=honey
    """
    table = fluid_table()
    if name is not None and name not in table:
        raise SceneError(f'there is no fluid "{clean(name)}"{suggestion(name, table)}')
    shown = {name: table[name]} if name else table
    if as_json:
        click.echo(json.dumps([vars(fluid) for fluid in shown.values()], indent=1))
    elif name:
        _print_fluid(table[name])
    else:
        _print_fluids(list(table.values()))


def _print_fluids(table: list) -> None:
    print_table(
        [
            "fluid",
            "at C",
            "density kg/m^3",
            "viscosity Pa.s",
            "kinematic m^2/s",
            "tension N/m",
            "confidence",
            "not Newtonian",
        ],
        [
            [
                fluid.key,
                show(fluid.temperature),
                show(fluid.density),
                show(fluid.viscosity),
                f"{fluid.kinematic_viscosity:.3g}",
                show(fluid.surface_tension),
                fluid.confidence,
                fluid.rheology,
            ]
            for fluid in table
        ],
    )
    click.echo("ranges and sources: fontana fluids NAME")


def _print_fluid(fluid: object) -> None:
    def span(bounds: tuple[float, float] | None, unit: str) -> str:
        return f" ({bounds[0]:g} to {bounds[1]:g} {unit})" if bounds else ""

    click.echo(f"{fluid.key}: {fluid.name}, at {fluid.temperature:g} C")
    click.echo(f"  density          {show(fluid.density, 'kg/m**3')}")
    click.echo(f"  viscosity        {show(fluid.viscosity, 'Pa*s')}{span(fluid.viscosity_range, 'Pa.s')}")
    click.echo(f"  kinematic        {fluid.kinematic_viscosity:.4g} m^2/s")
    click.echo(f"  surface tension  {show(fluid.surface_tension, 'N/m')}{span(fluid.surface_tension_range, 'N/m')}")
    click.echo(f"  confidence       {fluid.confidence}")
    if not fluid.newtonian:
        click.echo(f"  not Newtonian    {fluid.rheology}: one viscosity stands for it")
    if fluid.note:
        click.echo(f"  note             {fluid.note}")
    if fluid.unverified:
        click.echo(f"  not in sources   {', '.join(fluid.unverified)}")
    for source in fluid.sources:
        click.echo(f"  source           {source}")
