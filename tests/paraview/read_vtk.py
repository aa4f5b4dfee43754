# SPDX-License-Identifier: GPL-3.0-or-later
# Reads the frames of a run by vtkHDFReader of VTK 9.1.
import sys

from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkIOHDF import vtkHDFReader

import expected
from expected import check


def read(path):
    reader = vtkHDFReader()
    check(f"{path} is a VTKHDF file", reader.CanReadFile(path), 1)
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def values(grid, name):
    array = grid.GetCellData().GetArray(name)
    return [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]


def check_grains(run, grid):
    """The fragments of the last frame, and that each grain's polygons close its surface."""
    fragments = {f[0] for f in values(grid, "fragment")}
    check("fragments", len(fragments), run.summary["n_fragments"])
    edges = {}
    for i in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(i)
        ids = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
        for a, b in zip(ids, ids[1:] + ids[:1]):
            edges[(a, b)] = edges.get((a, b), 0) + 1
    check("edges of grains that are not met once each way",
          sum(n != 1 or (b, a) not in edges for (a, b), n in edges.items()), 0)


def check_bonds(grid):
    for status, mode, first in zip(values(grid, "status"), values(grid, "mode"),
                                   values(grid, "first_break")):
        if (mode[0] >= 0) != (first[0] >= 0) or (status[0] == 2 and mode[0] < 0):
            check("a bond's status, mode and first break agree", (status, mode, first), True)


run = expected.Run(sys.argv[1])
for kind, fields in expected.FIELDS.items():
    files, times = run.files(kind)
    check(f"{kind}: frames", len(files), run.summary["n_frames"])
    for path, time in zip(files, times):
        grid = read(path)
        found = grid.GetCellData()
        names = {found.GetArrayName(i): found.GetArray(i).GetNumberOfComponents()
                 for i in range(found.GetNumberOfArrays())}
        if grid.GetNumberOfCells() > 0:
            check(f"{path}: fields", names, fields)
        whole = grid.GetFieldData()
        check(f"{path}: time", whole.GetArray("time").GetValue(0), time)
    last = run.summary["last_frame"][kind]
    check(f"{kind}: points", grid.GetNumberOfPoints(), last["n_points"])
    check(f"{kind}: cells", grid.GetNumberOfCells(), last["n_cells"])
    check(f"{kind}: step of the last frame", whole.GetArray("step").GetValue(0),
          run.summary["steps"])
    if kind == "grains":
        check_grains(run, grid)
    if kind == "bonds":
        check_bonds(grid)
    print(f"  {kind}: {len(files)} frames, last {grid.GetNumberOfPoints()} points, "
          f"{grid.GetNumberOfCells()} cells, {len(names)} fields")
print(f"  VTK {vtkVersion.GetVTKVersion()}, {expected.failures} failures")
sys.exit(expected.failures > 0)
