import numpy as np


def whole(dtheta, max_step, chains):
    return dtheta * min(1, max_step / max(abs(dtheta).max(), 1e-12))


def each_joint(dtheta, max_step, chains):
    return np.clip(dtheta, -max_step, max_step)


def chains_by(peak, grow=False):
    def cap(dtheta, max_step, chains):
        shorter = dtheta.copy()
        for chain in np.unique(chains):
            share = max_step / max(peak(dtheta[chains == chain]), 1e-12)
            shorter[chains == chain] *= share if grow else min(1, share)
        return shorter

    return cap


WRONG = {
    "04.projector": [
        (lambda J: np.eye(J.shape[1]) - J.T @ J, "JP is not zero"),
        (lambda J: np.linalg.pinv(J) @ J, "JP is not zero"),
        (lambda J: np.zeros((J.shape[1],) * 2), "the trace of P"),
        (
            lambda J: np.eye(J.shape[1]) - J.T @ np.linalg.inv(J @ J.T + 1e-3 * np.eye(len(J))) @ J,
            "JP is not zero",
        ),
        (lambda J: np.linalg.pinv(J) @ J - np.eye(J.shape[1]), "P² is not P"),
    ],
    "04.cap": [
        (whole, "shortened too much"),
        (each_joint, "by the same share"),
        (chains_by(max), "further than max_step"),
        (chains_by(lambda part: abs(part).max(), grow=True), "made longer"),
        (chains_by(np.linalg.norm), "shortened too much"),
        (lambda dtheta, max_step, chains: dtheta, "further than max_step"),
    ],
}
