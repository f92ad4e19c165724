"""Numbers of the thesis' three models, to compare with: mass matrix, velocity torques and gravity in five states.

Source: computed from the corrected equations of thesis 1.5.3 and checked there against SymPy's Lagrangian to 1e-12;
g = 9.81, no friction, no rotors. They do not come from this package. The numbers
lie in data/thesis_models.csv.

A: thesis 2.1.1, l = 1 m, m = (3, 1, 1) kg, lc = 0.5 m, no inertias (m1 lc1^2 in M11).  THESIS_A
B: the same links as slender uniform rods.                                              THESIS_RODS
C: thesis 2.1.2, l = 0.2 m, lc = 0.5 m, Izz = Iyy = Iyz2 = 0.05 kg m^2.                  THESIS_C
"""

import numpy as np
import pandas as pd

from ir50p_lab.home import PROJECT

STATES = (  # q rad, qd rad/s
    ((0.3, 0.5, -0.7), (0.4, -0.6, 0.8)),
    ((-1.1, 1.2, 0.9), (1.5, 0.7, -1.3)),
    ((2.0, -0.4, -1.6), (-0.9, 1.1, 2.2)),
    ((0.0, 2.3, -2.0), (0.5, -1.4, 0.3)),
    ((1.57, 0.9, 1.4), (-2.1, 0.2, -0.5)),
)
COLUMNS = ("M11", "M12", "M22", "M23", "M33", "h1", "h2", "h3", "g2", "g3")  # M13 = g1 = 0; h = C qd
# Model C as numbers for the formulas of derive(links="thesis").
C_NUMBERS = {
    **dict.fromkeys(("l1", "l2", "l3"), 0.2),
    **dict.fromkeys(("lc1", "lc2", "lc3"), 0.5),
    **dict.fromkeys(("Izz1", "Izz2", "Izz3", "Iyy2", "Iyy3", "Iyz2"), 0.05),
    **{"m1": 3.0, "m2": 1.0, "m3": 1.0, "g": 9.81},
}


def reference(model):
    """The numbers of model "A", "B" or "C": (5, 10), a row per state, in the order of COLUMNS."""
    table = pd.read_csv(PROJECT / "data" / "thesis_models.csv", comment="#", index_col=["model", "state"])
    return table.loc[model, list(COLUMNS)].to_numpy()


def same_quantities(M, h, g):
    """The ten numbers of COLUMNS from a mass matrix (3, 3), h = C qd (3,) and gravity torques (3,)."""
    return np.array([M[0, 0], M[0, 1], M[1, 1], M[1, 2], M[2, 2], *h, *g[1:]])
