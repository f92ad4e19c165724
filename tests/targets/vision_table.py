"""Targets of the table plane: rendered balls all over the work area, our own calibration, Table 4.8 beside it."""

import numpy as np

from ir50p_lab.modelling import IR50P
from ir50p_lab.vision import BallLocator, render_scene
from ir50p_lab.vision.rendering import SceneBall, bench_scene
from tests.support.places import places_in, work_area
from tests.targets.rows import Row
from tests.targets.vision_setup import own_calibration, own_plane

# Table 4.8: where the ball was laid and where the thesis' camera put it, mm
TABLE_4_8 = (((400, -100), (406, -101)), ((300, 300), (300, 302)), ((500, 0), (492, -6)), ((400, 200), (402, 199)))


def found(place, seed):
    """Position (2,) m of a rendered ball that lies at `place`, NaN if it is not found."""
    image, _ = render_scene(bench_scene(SceneBall(position=(*place, 0.03))), seed=seed)
    seen = BallLocator(None, own_plane()).seen_in(image, simulated=True)
    return seen.position[:2] if seen else np.full(2, np.nan)


def rows(quick):
    """The table of targets."""
    n = 25 if quick else 300
    places = places_in(work_area(IR50P), np.random.default_rng(2), n)[:, :2]
    error = np.linalg.norm([found(place, k) - place for k, place in enumerate(places)], axis=1)
    missed = int(np.isnan(error).sum())
    median, p95 = np.nanmedian(error), np.nanpercentile(error, 95)
    ours = np.array([1e3 * (found(np.array(real) / 1e3, 1000 + k)) for k, (real, _) in enumerate(TABLE_4_8)])
    rms = own_calibration().rms
    result = [
        Row("own calibration, rms of the corners", "-", f"{rms:.3f} px", "0.15 px"),
        Row(f"position on the table, median of {n}", "< 1 mm", f"{1e3 * median:.2f} mm", "mean 5.1 mm", median < 1e-3),
        Row("position on the table, p95", "< 3 mm", f"{1e3 * p95:.2f} mm", "max 10.0 mm", p95 < 3e-3),
        Row("balls not found", "-", f"{missed} of {n}"),
    ]
    for (real, thesis), place in zip(TABLE_4_8, ours, strict=True):
        off, theirs = np.linalg.norm(place - real), np.linalg.norm(np.subtract(thesis, real))
        text = f"({place[0]:.1f}, {place[1]:.1f}): {off:.1f} mm"
        result.append(Row(f"Table 4.8, ball at {real} mm", "-", text, f"{thesis}: {theirs:.1f} mm"))
    return result
