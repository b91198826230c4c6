"""Prints what VTK reads of a VTKHDF file, state by state, as JSON: times, points, cells with their edges, and values at points.

Real numbers are texts, which have all their digits.
"""
import json
import sys

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader


def points_of(cell):
    return [cell.GetPointId(point) for point in range(cell.GetNumberOfPoints())]


def state(grid):
    """One state; the edges of a cell are those that VTK takes its points for."""
    cells, data = [], grid.GetPointData()
    for at in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(at)
        edges = [points_of(cell.GetEdge(edge)) for edge in range(cell.GetNumberOfEdges())]
        cells.append({"kind": cell.GetCellType(), "points": points_of(cell), "edges": edges})
    texts = lambda array: [repr(float(value)) for value in vtk_to_numpy(array).ravel()]
    arrays = {data.GetArrayName(at): texts(data.GetArray(at)) for at in range(data.GetNumberOfArrays())}
    return {"points": texts(grid.GetPoints().GetData()), "cells": cells, "arrays": arrays}


reader, faults = vtkHDFReader(), []
reader.AddObserver("ErrorEvent", lambda *_: faults.append("VTK reports an error"))
reader.SetFileName(sys.argv[1])
reader.UpdateInformation()
times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
states = []
for time in times or [None]:
    if time is None:
        reader.Update()
    else:
        reader.UpdateTimeStep(time)
    states.append({"time": None if time is None else repr(time), **state(reader.GetOutputDataObject(0))})
if faults:
    sys.exit("\n".join(faults))
print(json.dumps(states))
