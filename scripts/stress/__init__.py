"""Stress of the numerics: random cases, maps over the parameters, long runs; `python -m scripts.stress --help`."""
