"""Critical loads of a rod: the paper's area-controlled measure, its limit, and the loss of stability.

`measure` computes p(α) on the boxes and its limit α → 1; `fourier` computes it as Appendix D does; `loads` puts the
numbers of one rod side by side; `curves` does that for grids of rods.
"""
