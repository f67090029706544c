"""Measures a lens on the bench: focal length and pupils, spots and MTF over the field.

    python examples/lens_report.py [LENS [FOLDER]]        (default: double-gauss-50mm-f2, out)

Shows: a lens as a value, its first-order data, and pencils of exact rays. LENS is a name of
the library or a file. `daguerre lens LENS --plot sheet.pdf` draws much more.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import daguerre as dg
from daguerre import analysis

F_STOPS, FREQUENCIES = (1.0, 2.0), (10, 30, 50)  # times the widest; cycles per mm


def main(lens: str = "double-gauss-50mm-f2", folder: str = "out") -> None:
    """Prints a table and saves it as JSON."""
    loaded = dg.lenses.load(lens)
    order = loaded.first_order()
    print(f"{loaded.name}: {order.efl:.2f} mm, f/{order.f_number:.2f}; spots (rms), and MTF at")
    print(f"{', '.join(map(str, FREQUENCIES))} cycles per mm, mean of sagittal and tangential")
    rows = []
    for factor in F_STOPS:
        bench = analysis.set_up(loaded, f_stop=factor * order.f_number)
        for share in (0.0, 0.5, 0.9):  # of the field
            light = analysis.pencil(bench, share * bench.field_mm)  # that comes to this film point
            spot = 1000 * float(analysis.spot(light).rms)
            mtf = analysis.diffraction_mtf(light, FREQUENCIES).mean(axis=1).round(3).tolist()
            rows.append({"f_stop": bench.f_stop, "field": share, "spot_um": spot, "mtf": mtf})
            print(f"f/{bench.f_stop:.3g}, {share:.0%} of the field: {spot:.1f} um, MTF {mtf}")
    report = {"lens": loaded.name, "efl_mm": order.efl, "f_number": order.f_number, "rows": rows}
    Path(folder).mkdir(parents=True, exist_ok=True)
    Path(folder, "lens_report.json").write_text(json.dumps(report, indent=1))


if __name__ == "__main__":
    main(*sys.argv[1:3])
