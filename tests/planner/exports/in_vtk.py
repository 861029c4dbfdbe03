"""Reads collections (*.pvd) and their grids with VTK and says what is in them, one line for each collection.

Usage: in_vtk.py FOLDER...   Exit status: 0 all could be read, 1 something is wrong, 77 there is no VTK.
"""
import math
import os
import sys
import xml.etree.ElementTree as tree

try:
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError:
    sys.exit(77)

KINDS = {1: "vertex", 3: "line", 4: "polyline", 5: "triangle", 7: "polygon", 9: "quad"}
faults = []


def fields_of(data):
    return [(data.GetArrayName(k), data.GetArray(k).GetNumberOfComponents(), data.GetArray(k).GetNumberOfTuples())
            for k in range(data.GetNumberOfArrays())]


def read(file):
    """Fields of points and cells, numbers of both, kinds of cells, and limits in space."""
    reader = vtkXMLUnstructuredGridReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(file))
    reader.SetFileName(file)
    reader.Update()
    grid = reader.GetOutput()
    faults.extend(errors)
    points, cells = fields_of(grid.GetPointData()), fields_of(grid.GetCellData())
    for names, count in ((points, grid.GetNumberOfPoints()), (cells, grid.GetNumberOfCells())):
        faults.extend(f"{file}: {name} has {tuples} values of {count}" for name, _, tuples in names if tuples != count)
    if grid.GetNumberOfPoints() == 0 or not all(map(math.isfinite, grid.GetBounds())):
        faults.append(f"{file}: no points, or not finite")
    kinds = sorted({KINDS.get(grid.GetCellType(k), "other") for k in range(grid.GetNumberOfCells())})
    signature = ([(name, width) for name, width, _ in points], [(name, width) for name, width, _ in cells])
    return signature, kinds


for folder in sys.argv[1:]:
    collections = sorted(name for name in os.listdir(folder) if name.endswith(".pvd"))
    if not collections:
        faults.append(f"{folder}: no collection")
    for name in collections:
        entries = tree.parse(os.path.join(folder, name)).getroot().findall("Collection/DataSet")
        times = [float(entry.get("timestep")) for entry in entries]
        if not entries or times != sorted(set(times)):
            faults.append(f"{name}: times do not increase: {times}")
        grids = [read(os.path.join(folder, entry.get("file"))) for entry in entries]
        if any(signature != grids[0][0] for signature, _ in grids):
            faults.append(f"{name}: fields differ between its files")
        points, cells = grids[0][0]
        print(f"{name}: {len(entries)} times, {' '.join(grids[0][1])}; points:",
              " ".join(f"{field}*{width}" for field, width in points), "; cells:",
              " ".join(f"{field}*{width}" for field, width in cells))
for fault in faults:
    print("FAILED:", fault, file=sys.stderr)
sys.exit(1 if faults else 0)
