# SPDX-License-Identifier: GPL-3.0-or-later
# Opens the series of a run as ParaView's File > Open does.
import sys

from paraview.simple import GetParaViewVersion, OpenDataFile, UpdatePipeline

import expected
from expected import check

run = expected.Run(sys.argv[1])
for kind, fields in expected.FIELDS.items():
    reader = OpenDataFile(run.series(kind))
    check(f"{kind}: reader", type(reader).__name__, "VTKHDFReader")
    reader.UpdatePipelineInformation()
    files, times = run.files(kind)
    check(f"{kind}: times", list(reader.TimestepValues), [float(t) for t in times])
    UpdatePipeline(time=times[-1], proxy=reader)
    found = reader.GetDataInformation()
    last = run.summary["last_frame"][kind]
    check(f"{kind}: points", found.GetNumberOfPoints(), last["n_points"])
    check(f"{kind}: cells", found.GetNumberOfCells(), last["n_cells"])
    names = {array.Name: array.GetNumberOfComponents() for array in reader.CellData}
    check(f"{kind}: fields", names, fields)
    print(f"  {kind}: {len(times)} frames, last {found.GetNumberOfPoints()} points, "
          f"{found.GetNumberOfCells()} cells, {len(names)} fields")
print(f"  ParaView {GetParaViewVersion()}, {expected.failures} failures")
sys.exit(expected.failures > 0)
