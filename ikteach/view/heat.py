"""A table of numbers as a picture of coloured squares."""

import io

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ikteach.markup import as_label
from ikteach.view.widgets.picture import Still

FEW = 1e-12  # an entry below it counts as zero


def heat(table: pd.DataFrame, *, title: str, unit: str) -> Still:
    """The numbers of a table as squares: orange above 0, blue below, a dot where it is 0."""
    values = table.to_numpy(dtype=float)
    rows, columns = values.shape
    figure = Figure(figsize=(2.2 + 0.36 * columns, 1.9 + 0.26 * rows), dpi=90, layout="constrained")
    axes = figure.subplots()
    most = max(float(abs(values).max()), FEW)
    image = axes.imshow(values, cmap="PuOr_r", vmin=-most, vmax=most, aspect="auto")
    down, across = np.nonzero(abs(values) < FEW)
    axes.plot(across, down, ".", color="0.6", ms=3)
    axes.set_xticks(range(columns), list(map(as_label, table.columns)), rotation=90, fontsize=8)
    axes.set_yticks(range(rows), list(map(as_label, table.index)), fontsize=8)
    axes.set_title(title)
    figure.colorbar(image, ax=axes, label=unit, shrink=0.9)
    out = io.BytesIO()
    figure.savefig(out, format="png")
    row, column = (int(i) for i in np.unravel_index(abs(values).argmax(), values.shape))
    words = (
        f"{title}: {rows} rows by {columns} columns, {len(down)} of {values.size} entries are 0. "
        f"The largest is {values[row, column]:.2f} {unit}, in row {table.index[row]}, column "
        f"{table.columns[column]}."
    )
    return Still(out.getvalue(), words)
