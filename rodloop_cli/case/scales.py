"""Physical units: a length, a stiffness and a mass per length make nondimensional results seconds and newtons, Eq. (8).

Quantities are text with a unit (``45 mm``), read by pint, or plain numbers in SI units, which need no pint.
"""

from __future__ import annotations

from functools import cache, partial
from math import sqrt
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

LEAST, MOST = 1e-30, 1e30
"""In SI units: wide enough for a flagellum and for a pipeline."""


def in_si(value: Any, unit: str) -> Any:
    """A text like ``45 mm`` as a number in an SI unit; anything else as it is, for the model to judge."""
    if not isinstance(value, str):
        return value
    try:
        import pint  # noqa: PLC0415  an optional extra, half a second to import
    except ImportError:
        raise _refused(
            f"text with a unit needs pint (pip install 'rodloop[units]'); or write a number in {unit}"
        ) from None
    try:
        return float(_registry().Quantity(value).to(unit).magnitude)
    except pint.DimensionalityError:
        raise _refused(f"must have the dimension of {unit}") from None
    except Exception:  # noqa: BLE001  whatever pint's parser meets in a stranger's text
        raise _refused(f"must be a number and a unit, as in '1 {unit}'") from None


def _refused(what: str) -> PydanticCustomError:
    return PydanticCustomError("quantity", "{what}", {"what": what})


@cache
def _registry() -> Any:
    import pint  # noqa: PLC0415

    return pint.UnitRegistry()


def _read(unit: str) -> BeforeValidator:
    return BeforeValidator(partial(in_si, unit=unit))


def _shown(unit: str) -> WithJsonSchema:
    kinds: list[dict[str, Any]] = [{"type": "number", "exclusiveMinimum": 0}, {"type": "string"}]
    return WithJsonSchema({"anyOf": kinds, "description": f"Text with a unit, or a number in {unit}."})


_RANGE = Field(ge=LEAST, le=MOST)


class Scales(BaseModel):
    """What the units of the nondimensional numbers are worth; resolved to SI units."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False, hide_input_in_errors=True)

    R: Annotated[float, _read("m"), _RANGE, _shown("m")]
    """Radius of the loop when round, L / (2 pi)."""
    B1: Annotated[float, _read("N m^2"), _RANGE, _shown("N m^2")]
    """Bending stiffness of segment 1."""
    rho_A1: Annotated[float, _read("kg/m"), _RANGE, _shown("kg/m")]
    """Mass per length of segment 1."""

    @property
    def time(self) -> float:
        """Seconds in a unit of time, R² sqrt(ρ1 A/B1)."""
        return self.R**2 * sqrt(self.rho_A1 / self.B1)

    @property
    def force(self) -> float:
        """Newtons in a unit of force, B1/R²."""
        return self.B1 / self.R**2

    @property
    def pressure(self) -> float:
        """Newtons per metre in a unit of load, B1/R³: the surface tension of both sides of the film at p = 1."""
        return self.B1 / self.R**3
