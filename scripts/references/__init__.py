"""Independent solutions of the rod-loop problem: they share no code and no discretisation with rodloop itself.

    problem      the loops and the stated times           shapes       initial shapes, exact to 1e-13
    fourier      uniform loop, constraint eliminated      galerkin     any segments and drag, polynomials for theta
    observables  what is compared, JSON in ``data``       pieces, ivp  quadrature and scipy's integrators

``python -m scripts.references`` writes ``data/<case>.json``: observables, their uncertainty (difference to a coarser
run) and the energy defect (largest change of bending + surface + kinetic + dissipated energy).
"""
