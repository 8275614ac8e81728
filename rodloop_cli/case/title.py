"""The title of a result: the case's own, or one made of what sets the case apart."""

from __future__ import annotations

from collections.abc import Iterator

from rodloop_cli.case.model import Case


def title_of(case: Case) -> str:
    """``Elastic loop, p = 3.8, stiffness ratio 5`` where the case has no title; never empty, as CF wants it."""
    return case.title if case.title.strip() else ", ".join(("Elastic loop", f"p = {case.p:g}", *_apart(case)))


def _apart(case: Case) -> Iterator[str]:
    """What differs from a uniform loop without drag."""
    if len(case.segments) == 2:
        first, second = case.segments
        if second.stiffness != first.stiffness:
            yield f"stiffness ratio {second.stiffness / first.stiffness:g}"
        if second.density != first.density:
            yield f"density ratio {second.density / first.density:g}"
        if abs(first.fraction - second.fraction) > 1e-9:
            yield f"k = {first.fraction:g}"
    elif len(case.segments) > 2:
        yield f"{len(case.segments)} segments"
    if case.zeta_perp:
        yield f"drag {case.zeta_perp:g}"
