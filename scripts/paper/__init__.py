"""The figures of Fang et al. (2026) drawn from our own runs, and a table of the paper's numbers beside ours.

``python -m scripts.paper [fig11 ...]`` computes what is missing and draws;
``python -m scripts.paper.reproduction`` writes ``docs/reproduction.md``.
"""
