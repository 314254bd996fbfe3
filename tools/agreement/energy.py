"""The energy of SR-ARAP, written down anew: nothing here comes from the programs that are compared.

    E(p', R) = sum over i and its neighbors j of  w |e' - R_i e|^2 + alpha A v_i |R_i - R_j|^2

e = p_i - p_j at rest, e' now; w = max(0, (cot a + cot b) / 2); A the area at rest; v_i = 1 / number of neighbors of i.
For given positions the rotations are found that make it least, since those of the programs are not told.
"""

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

# Rotations are the best ones when a step lowers E by no more than this part; the table tells a hundredth of a percent.
ENOUGH = 1e-8
# Steps at most; usually some dozen are taken.
MOST_STEPS = 500


class Energy:
    """The formula on one mesh."""

    def __init__(self, points, faces, alpha):
        n, ends, weights = len(points), [], []
        corners = points[faces]
        cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        doubled = np.linalg.norm(cross, axis=1)
        for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            u, v = corners[:, b] - corners[:, a], corners[:, c] - corners[:, a]
            weights.append(0.5 * np.einsum("ij,ij->i", u, v) / doubled)
            ends.append(np.sort(faces[:, [b, c]], axis=1))
        edges, edge = np.unique(np.concatenate(ends), axis=0, return_inverse=True)
        self.i, self.j = edges[:, 0], edges[:, 1]
        raw = np.bincount(edge.ravel(), np.concatenate(weights))
        self.negative = np.count_nonzero(raw < 0.0) / len(raw)
        self.weight = np.maximum(raw, 0.0)
        self.rest = points[self.i] - points[self.j]
        degree = np.bincount(edges.ravel(), minlength=n)
        share = alpha * 0.5 * doubled.sum() / np.maximum(degree, 1)
        # What couples R_i and R_j: alpha A (v_i + v_j).
        pair = share[self.i] + share[self.j]
        both = lambda values: sparse.coo_matrix((np.tile(values, 2), (np.r_[self.i, self.j], np.r_[self.j, self.i])), (n, n))
        self.coupling = both(pair).tocsr()
        sums = np.asarray(self.coupling.sum(1)).ravel()
        self.resting = 3.0 * sums.sum()
        # Half of the second derivative by a turn of each vertex, near rest.
        stiff = 2.0 / 3.0 * self.weight * (self.rest**2).sum(1)
        own = np.bincount(self.i, stiff, n) + np.bincount(self.j, stiff, n)
        least = 1e-9 * max(own.max(), sums.max())
        self.newton = sparse.linalg.splu((sparse.diags(own + 2.0 * sums + least) - 2.0 * self.coupling).tocsc())

    def wanted(self, now):
        """Sum over j of w e' e^T, for every vertex."""
        n = self.coupling.shape[0]
        terms = self.weight[:, None, None] * now[:, :, None] * self.rest[:, None, :]
        sums = np.empty((n, 3, 3))
        for a in range(3):
            for b in range(3):
                sums[:, a, b] = np.bincount(self.i, terms[:, a, b], n) + np.bincount(self.j, terms[:, a, b], n)
        return sums

    def coupled(self, turns):
        """Sum over j of alpha A (v_i + v_j) R_j, for every vertex."""
        return (self.coupling @ turns.reshape(-1, 9)).reshape(-1, 3, 3)

    def of(self, points):
        """The least energy of these positions."""
        now = points[self.i] - points[self.j]
        squares = 2.0 * self.weight @ ((now**2).sum(1) + (self.rest**2).sum(1)) + self.resting
        wanted = self.wanted(now)
        value = lambda turns: squares - (turns * (2.0 * wanted + self.coupled(turns))).sum()
        turns = best_rotations(wanted)
        energy = value(turns)
        for _ in range(MOST_STEPS):
            pull = (wanted + self.coupled(turns)) @ turns.transpose(0, 2, 1)
            torque = np.stack([pull[:, 2, 1] - pull[:, 1, 2], pull[:, 0, 2] - pull[:, 2, 0], pull[:, 1, 0] - pull[:, 0, 1]], 1)
            way, size = self.newton.solve(torque), 1.0
            lower = energy
            while size > 1e-3:
                tried = exponential(size * way) @ turns
                lower = value(tried)
                if lower < energy:
                    break
                size *= 0.5
            if lower >= energy:
                break
            done, turns, energy = energy - lower <= ENOUGH * energy, tried, lower
            if done:
                break
        return energy


def best_rotations(matrices):
    """The rotation nearest to each matrix."""
    u, _, v = np.linalg.svd(matrices)
    u[:, :, 2] *= np.sign(np.linalg.det(u @ v))[:, None]
    return u @ v


def exponential(ways):
    """Rotations about some axes, by angles that are their lengths."""
    angles = np.maximum(np.linalg.norm(ways, axis=1), 1e-30)
    x, y, z = (ways / angles[:, None]).T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], 1).reshape(-1, 3, 3)
    sine, cosine = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.eye(3) + sine * cross + (1.0 - cosine) * (cross @ cross)
