"""The case: what the user asked for, checked, with every default resolved.

All numbers are nondimensional as in the paper. A `Case` is built from keywords (``Case(p=3.8, t_end=2.5)``),
by `Case.model_validate` from plain values, or from a file by `rodloop_cli.case.load_case`.
"""

from __future__ import annotations

from hashlib import sha256
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, ValidationError, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from rodloop_cli.case import rules
from rodloop_cli.case.dump import dump
from rodloop_cli.case.fault import Fault
from rodloop_cli.case.scales import Scales

#: Shorter segments than this are lost in the round-off of positions.
SHORTEST = 1e-6
#: The widest contrast of stiffness or density, and the largest load, that leave digits to compute with.
HUGE = 1e9
HIGHEST_MODE = 1000

Ratio = Annotated[float, Field(ge=1 / HUGE, le=HUGE)]
Mode = Annotated[int, Field(ge=2, le=HIGHEST_MODE)]
Event = Literal["crossing", "settled"]
# A list in the file becomes a tuple here; "strict" would refuse the list.
_FROM_LIST = Field(strict=False)


class _Value(BaseModel):
    # Hidden input: our own report prints values, and a long one must not fill the screen.
    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        strict=True,
        allow_inf_nan=False,
        hide_input_in_errors=True,
        use_attribute_docstrings=True,
    )


class Segment(_Value):
    """A stretch of the loop of one material; the first segment is the unit of the others."""

    fraction: float = Field(ge=SHORTEST, le=1)
    """Share of the arclength, in (0, 1]; all shares sum to 1."""
    stiffness: Ratio = 1.0
    """Bending stiffness B / B1 > 0."""
    density: Ratio = 1.0
    """Mass per length, rho / rho1 > 0."""


class ModePerturbation(_Value):
    """Radial displacement amplitude * cos(mode * phi - phase) of the unloaded equilibrium shape."""

    mode: Mode
    """Number of waves around the loop."""
    amplitude: float = Field(ge=-rules.AMPLITUDE_SUM_LIMIT, le=rules.AMPLITUDE_SUM_LIMIT)
    """Relative to the radius R; the amplitudes' sum stays below 0.5."""
    phase: float = Field(default=0.0, ge=-HUGE, le=HUGE)
    """Radians, counter-clockwise from the bottom (s = 0)."""


class RandomModes(_Value):
    """Normal coefficients and uniform phases over a range of modes, scaled to a largest displacement."""

    amplitude: float = Field(ge=0, le=rules.AMPLITUDE_SUM_LIMIT)
    """Largest displacement, relative to the radius R."""
    modes: Annotated[tuple[Mode, Mode], _FROM_LIST]
    """First and last mode, both included."""
    seed: int = Field(default=0, ge=0, lt=2**63)
    """Of numpy.random.default_rng."""


class RandomPerturbation(_Value):
    """A seeded random radial displacement."""

    random: RandomModes
    """The range of modes, their largest displacement and the seed."""


def _kind_of_perturbation(item: Any) -> str:
    is_random = "random" in item if isinstance(item, dict) else isinstance(item, RandomPerturbation)
    return "random" if is_random else "mode"


Perturbation = Annotated[
    Annotated[ModePerturbation, Tag("mode")] | Annotated[RandomPerturbation, Tag("random")],
    Discriminator(_kind_of_perturbation),
]


def _without_default(schema: dict[str, Any]) -> None:
    """For lists that replace other keys: empty stands for not given, but may not be written."""
    del schema["default"]


def _without_null(schema: dict[str, Any]) -> None:
    # None stands for a key that is left out; it may not be written.
    schema.update(next(kind for kind in schema.pop("anyOf") if kind != {"type": "null"}))
    del schema["default"]


def _depends(default: Any, key: str, value: Any, *, shown: bool = True) -> Any:
    """A field whose default holds where ``key`` has ``value``; elsewhere it is None.

    ``shown``: the default appears in the JSON Schema.
    """

    def without_null(schema: dict[str, Any]) -> None:
        # None means that another key takes this one's place; a file says so by leaving the key out.
        schema.update(next(kind for kind in schema.pop("anyOf") if kind != {"type": "null"}))
        if shown:
            schema["default"] = default

    def resolve(resolved: dict[str, Any]) -> Any:
        return default if resolved[key] == value else None

    return Field(default_factory=resolve, json_schema_extra=without_null)


class Case(_Value):
    """One run of rodloop: a rod, a load, a time span, a scheme and what to store."""

    title: str = Field(default="", max_length=300, pattern=r"^[^\x00-\x1f\x7f-\x9f\u2028\u2029]*$")
    """One line of text that is repeated in figures and files."""
    segment_list: Annotated[tuple[Segment, ...], _FROM_LIST] = Field(
        default=(), alias="segments", max_length=1000, json_schema_extra=_without_default
    )
    """Any number of segments, counter-clockwise from the bottom; replaces the two ratios and k."""
    stiffness_ratio: Ratio | None = _depends(1.0, "segment_list", ())
    """B2/B1 > 0: bending stiffness of segment 2 relative to segment 1."""
    density_ratio: Ratio | None = _depends(1.0, "segment_list", ())
    """rho2/rho1 > 0: mass per length of segment 2 relative to segment 1."""
    k: Annotated[float, Field(ge=SHORTEST, le=1 - SHORTEST)] | None = _depends(0.5, "segment_list", ())
    """Arclength fraction of segment 1, in (0, 1)."""
    p: float = Field(ge=-HUGE, le=HUGE)
    """Load p R^3/B1 of the soap film: > 0 outer film ruptured, < 0 inner film ruptured."""
    zeta_perp: float = Field(default=0.0, ge=0, le=HUGE)
    """Normal drag coefficient >= 0."""
    gamma: float = Field(default=0.5, ge=0, le=HUGE)
    """Drag anisotropy >= 0: tangential over normal drag coefficient."""
    rotary_inertia: float = Field(default=0.0, ge=0, le=1)
    """Rotary inertia I/(A R^2) >= 0 of a cross-section, Appendix A; a^2/(4 R^2) for a round rod of radius a."""
    perturbation: Annotated[tuple[Perturbation, ...], _FROM_LIST] = Field(default=(), max_length=100)
    """Radial perturbations of the unloaded equilibrium shape, added together."""
    t_end: float = Field(ge=1e-9, le=1e6)
    """End of the run."""
    scheme: Literal["radau", "bdf2"] = "radau"
    """radau: error-controlled (Gauss boxes, Radau IIA); bdf2: the paper's fixed-step scheme."""
    tol: Annotated[float, Field(ge=1e-12, le=0.1)] | None = _depends(1e-4, "scheme", "radau")
    """radau: the accuracy wanted in positions, relative to R."""
    N: Annotated[int, Field(ge=4, le=100_000)] | None = _depends(rules.DEFAULT_N, "scheme", "bdf2", shown=False)
    """bdf2: grid points (default 300); radau: number of cells (default: chosen from tol)."""
    dt: Annotated[float, Field(ge=1e-9, le=1e6)] | None = _depends(rules.DEFAULT_DT, "scheme", "bdf2", shown=False)
    """bdf2: fixed time step (default 1e-3); radau: upper bound on the step (default: none)."""
    stop_at: Annotated[tuple[Event, ...], _FROM_LIST] = ("crossing",)
    """Events that end the run; without crossing the run goes on and the frames are marked."""
    snapshot_times: Annotated[tuple[Annotated[float, Field(ge=0)], ...], _FROM_LIST] = Field(
        default=(), max_length=10_000, json_schema_extra=_without_default
    )
    """Stored times in [0, t_end], increasing; replaces snapshots."""
    snapshots: Annotated[int, Field(ge=2, le=100_000)] | None = _depends(rules.DEFAULT_SNAPSHOTS, "snapshot_times", ())
    """Number of stored times, uniform in [0, t_end], both ends included."""
    output_points: int = Field(default=rules.DEFAULT_POINTS, ge=8, le=100_000)
    """Number of stored arclength points."""
    scales: Scales | None = Field(default=None, json_schema_extra=_without_null)
    """Physical units for plots and the summary: R, B1 and rho_A1, each a text with its unit or a number in SI units."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        faults = list(rules.conflicts(self.model_dump(by_alias=True, exclude_unset=True)))
        if faults:
            raise _refused(faults)
        return self

    @property
    def segments(self) -> tuple[Segment, ...]:
        """The segments, whichever way they were given; a loop of one material is one segment."""
        if self.segment_list:
            return self.segment_list
        assert self.k is not None
        assert self.stiffness_ratio is not None
        assert self.density_ratio is not None
        if self.stiffness_ratio == self.density_ratio == 1:
            return (Segment(fraction=1.0),)
        second = Segment(fraction=1 - self.k, stiffness=self.stiffness_ratio, density=self.density_ratio)
        return (Segment(fraction=self.k), second)

    @property
    def times(self) -> tuple[float, ...]:
        """The stored times, increasing, within [0, t_end]."""
        if self.snapshots is None:
            return self.snapshot_times
        last = self.snapshots - 1
        return tuple(self.t_end * (i / last) for i in range(self.snapshots))

    def to_yaml(self) -> str:
        """The resolved case as text of a case file that loads as an equal case; the same for equal cases."""
        return dump(self.resolved())

    def resolved(self) -> dict[str, Any]:
        """Every key that has a value, in the order of the schema, as numbers, text, lists and mappings."""
        values = self.model_dump(mode="json", by_alias=True, exclude_none=True)
        replaced = {"segments": not self.segment_list, "snapshot_times": not self.snapshot_times}
        return {key: value for key, value in values.items() if not replaced.get(key, False)}

    @property
    def sha256(self) -> str:
        """Hexadecimal key of the resolved case."""
        return sha256(self.to_yaml().encode()).hexdigest()


def _refused(faults: list[Fault]) -> ValidationError:
    """Several faults as one pydantic error, each at its own location."""
    details = [
        InitErrorDetails(
            type=PydanticCustomError("rule", "{what}", {"what": fault.what}), loc=fault.loc, input=fault.got
        )
        for fault in faults
    ]
    return ValidationError.from_exception_data("Case", details)
