# SPDX-License-Identifier: GPL-3.0-or-later
# What the frames of a run must hold: by summary.json, and by the lists of fields.
import json
import os

FIELDS = {
    "grains": {"grain": 1, "facet": 1, "neighbour": 1, "fragment": 1, "fragment_volume": 1,
               "displacement": 3, "velocity": 3, "spin": 3},
    "bonds": {"facet": 1, "a": 1, "b": 1, "status": 1, "mode": 1, "tension": 1, "shear": 1,
              "torsion": 1, "first_break": 1, "opening": 3, "force": 3},
    "contacts": {"a": 1, "b": 1, "is_platen": 1, "status": 1, "force": 3, "compression": 1,
                 "gap": 1},
}
failures = 0


def check(what, got, wanted):
    global failures
    if got != wanted:
        print(f"FAILED: {what}: got {got}, expected {wanted}")
        failures += 1


class Run:
    def __init__(self, folder):
        with open(os.path.join(folder, "summary.json")) as file:
            self.summary = json.load(file)
        self.folder = os.path.join(folder, "frames")

    def series(self, kind):
        return os.path.join(self.folder, f"{kind}.hdf.series")

    def files(self, kind):
        with open(self.series(kind)) as file:
            entries = json.load(file)["files"]
        return [os.path.join(self.folder, entry["name"]) for entry in entries], \
               [entry["time"] for entry in entries]
