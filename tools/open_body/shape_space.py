"""Principal components of the drawn bodies, found in the space of the targets' coefficients.

Bodies are linear in some 336 coefficients, so the eigenproblem has that size, not the mesh's. With
S the coefficients' covariance and G the targets' inner products, the eigenvectors u of
S^1/2 G S^1/2 give directions S^1/2 u in coefficients: one unit of beta is one standard deviation.
The same directions shape the same person on a mesh of any resolution.
"""

from dataclasses import dataclass

import numpy as np

BETAS = 10
COMPONENTS = 40  # kept for the joint regressor


@dataclass
class ShapeSpace:
    mean: np.ndarray  # (targets,) coefficients of the template
    directions: np.ndarray  # (components, targets) coefficients of one standard deviation
    variance: np.ndarray  # (components,) of all vertex coordinates, m2
    total_variance: float
    to_betas: np.ndarray  # (targets, components)

    def betas(self, coefficients):
        return (coefficients - self.mean) @ self.to_betas[:, :BETAS]

    def turn(self, signs):
        """Multiplies the betas by signs (BETAS,)."""
        self.directions[:BETAS] *= signs[:, None]
        self.to_betas[:, :BETAS] *= signs


def fit(coefficients, body):
    mean = coefficients.mean(axis=0)
    centred = coefficients - mean
    flat = body.vertices[1:].reshape(len(body.vertices) - 1, -1)
    inner = flat @ flat.T
    values, vectors = np.linalg.eigh(centred.T @ centred / (len(centred) - 1))
    root = (vectors * np.sqrt(np.clip(values, 0, None))) @ vectors.T
    variance, components = np.linalg.eigh(root @ inner @ root)
    variance, components = variance[::-1], components[:, ::-1]
    directions = (root @ components[:, :COMPONENTS]).T
    kept = variance[:COMPONENTS]
    return ShapeSpace(mean, directions, kept, variance.sum(), inner @ directions.T / kept)
