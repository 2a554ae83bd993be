"""Draw folds without and with contact side by side: python contact.py WITHOUT WITH contact.png STATE...

WITHOUT and WITH are run directories; each state becomes a row with two sections of the wall.
"""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

runs, out, states = [Path(name) for name in sys.argv[1:3]], sys.argv[3], [int(n) for n in sys.argv[4:]]

figure, axes = plt.subplots(len(states), 2, figsize=(9, 2.9 * len(states)), sharex=True, sharey=True, squeeze=False)
for column, (run, title) in enumerate(zip(runs, ["without contact", "with contact"])):
    history = list(csv.DictReader((run / "history.csv").open()))
    for row, state in enumerate(states):
        wall = list(csv.DictReader((run / f"profiles/state-{state:04}.csv").open()))
        outer, inner = ([[float(point[f"{face}_{x}"]) for point in wall] for x in "zr"] for face in ["outer", "inner"])
        axis = axes[row][column]
        axis.fill(outer[0] + inner[0][::-1], outer[1] + inner[1][::-1], color="#e8d9b5", lw=0)
        axis.plot(*outer, color="#0072b2", lw=1.4)
        axis.plot(*inner, color="#d55e00", lw=1.0)
        ratio = float(history[state]["length_ratio"])
        energy = 1e3 * float(history[state]["energy"])
        axis.set_title(rf"{title}, $L_\mathrm{{max}}/L$ = {ratio:.2f}, $W$ = {energy:.3f}e-3 $E D^3$", fontsize=9)
        axis.set_aspect("equal")
        axis.set_xlim(0.1, 1.15)
        axis.set_ylim(0.0, 0.56)
for axis in axes[-1]:
    axis.set_xlabel("$z/D$")
for line in axes:
    line[0].set_ylabel("$r/D$")
figure.tight_layout()
figure.savefig(out, dpi=110)
