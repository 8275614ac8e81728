"""The time loop and its schemes; no input or output.

`loop` yields accepted steps; `state` holds what passes between them; `radau` and `bdf2` make one step; `predictor`
guesses and `stages` solves the equations of one, `newton` those of one step after the other; `dense` evaluates the
motion between steps; `refine` adapts the mesh; `memory` holds all that a continued march needs; `work` counts what it
cost.
"""
