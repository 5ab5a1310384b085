"""What Buss's C++ answers: `data/ik_reference.json`, and its figures as ours."""

import json
from functools import cache
from pathlib import Path

import numpy as np

from ikteach import Effectors, Joint, Tree

DATA = Path(__file__).parents[1] / "data"
REFERENCE = json.loads((DATA / "ik_reference.json").read_text())
CASES = {case["id"]: case for case in REFERENCE["cases"]}
EXPERIMENTS = REFERENCE["tracking"]["experiments"]


@cache
def model(name):
    """Tree and effectors of a model; its nodes are places in the world at θ = 0."""
    nodes = REFERENCE["models"][name]
    joints, ends = [], {}
    for i, node in enumerate(nodes):
        parent = node["parent"]
        place = np.array(nodes[parent]["attach"]) if parent >= 0 else np.zeros(3)
        offset = np.array(node["attach"]) - place
        hangs_from = f"{parent}" if parent >= 0 else None
        if node["kind"] == "E":
            ends[f"end {i}"] = (hangs_from, offset)
        else:
            limits = {"lower": node["min"], "upper": node["max"]}
            joints.append(Joint(f"{i}", hangs_from, offset, node["axis"], **limits))
    tree = Tree.of(joints)
    return tree, Effectors.of(tree, ends)


def mobility(case):
    """0 for the frozen joints, 1 for the others."""
    n = len(model(case["model"])[0])
    return np.where(np.isin(np.arange(n), case["frozen"]), 0.0, 1.0)
