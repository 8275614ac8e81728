"""Small motions about an equilibrium: which grow, how fast, and at what load the first one does.

`compliance` turns the linearised boxes into a symmetric matrix, `spectrum` into growth rates, with drag or without;
`modes` gives their shapes; `watch` follows a branch and keeps an eye on them; `threshold` finds where it loses
stability.
"""
