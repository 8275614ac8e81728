"""Equilibria of the loop on the same boxes as its motion: found by relaxation, and followed as the load changes.

`relaxation` minimises the energy from afar; `newton` solves for an equilibrium under one more condition (a load, an
area, a distance along the branch); `branch` follows equilibria by pseudo-arclength; `switching` leaves a branch where
another crosses it.
"""

from rodloop_cli.statics.relaxation import as_shape, laid_on, relax, unloaded

__all__ = ["as_shape", "laid_on", "relax", "unloaded"]
