"""The time loop and its schemes; no input or output.

`loop.march` yields accepted steps; `state` holds what passes between them; `radau` and `bdf2` make one step; `stages`
solves the equations of one; `dense` evaluates the motion between steps; `refine` adapts the mesh.
"""
