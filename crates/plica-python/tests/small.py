"""Cases that tests share."""

from __future__ import annotations

from typing import Any

import plica

RING: dict[str, Any] = dict(
    title="A ring contracts",
    tube={"length": 2.0, "thickness": 0.1},
    muscles={"ring": {"direction": "circular", "zone": [0.5, 1.5]}},
    mesh={"control_points": {"axial": 24, "around": 12, "thickness": 4}},
    output={"pictures": False, "stability_modes": 0},
    stages=[{"name": "contract", "steps": 3, "drive": {"ring": {"stretch": 0.7}}}],
)
"""A ring that contracts, in hundredths of a second a state."""

INVAGINATION: dict[str, Any] = dict(
    title="The tube invaginates",
    tube={"length": 3.0, "thickness": 0.06},
    material={"neo-hookean": {"poisson_ratio": 0.495}},
    muscles={
        "circular": {"direction": "circular", "zone": [0.5, 1.0]},
        "longitudinal": {"direction": "longitudinal", "zone": [0.5, 1.0]},
    },
    mesh={"control_points": {"axial": 100, "around": 60, "thickness": 5}},
    output={"stability_modes": 2},
    stages=[
        {"name": "contract", "steps": 15, "drive": {"circular": {"diameter_ratio": 0.25}}},
        {"name": "relax", "steps": 19, "drive": {"longitudinal": {"length_ratio": 1.19}}},
    ],
)
"""The tube of Okino et al. (2025) on a small mesh, up to a wall of 89.9 degrees: a second or two."""

FOLD: dict[str, Any] = dict(
    title="An end pushes the waist of a thin tube until it touches itself",
    contact=True,
    tube={"length": 1.5, "thickness": 0.02},
    material={"neo-hookean": {"poisson_ratio": 0.3}},
    muscles={"ring": {"direction": "circular", "zone": [0.5, 1.0]}},
    mesh={"control_points": {"axial": 50, "around": 12, "thickness": 4}},
    stages=[
        {"steps": 5, "drive": {"ring": {"diameter_ratio": 0.3}}},
        {"steps": 10, "drive": {"ileum": {"displacement": -0.7}}},
    ],
)
"""A fold whose walls touch, in a second or two."""


def energy_at(stretch: float) -> float:
    """Return the energy of the ring; a function that processes can import."""
    return float(plica.evaluate(plica.Case(**RING), {"stages[1].drive.ring.stretch": stretch})["energy"])
