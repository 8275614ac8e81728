"""Everything a march needs to go on as if it had never been stopped, as named arrays, and back.

The factored linearisation is rebuilt from the instant it was made at, so that Newton's iterates are the same to the
last bit.
"""

import numpy as np

from rodloop_cli.march.bdf2 import FixedMarcher
from rodloop_cli.march.loop import Marcher
from rodloop_cli.march.newton import Newton
from rodloop_cli.march.predictor import Past
from rodloop_cli.march.stages import Equations
from rodloop_cli.march.state import State
from rodloop_cli.numerics.control import Controller
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import Instant
from rodloop_cli.physics.rod import Mesh

Arrays = dict[str, Array]

STATE = ("unknowns", "rates", "position", "velocity", "acceleration", "force")
PAST = ("nodes", "unknowns", "force")


def pack(marcher: Marcher | FixedMarcher) -> Arrays:
    """The march as arrays."""
    arrays = _pack_state("state", marcher.state) | _pack_mesh(marcher.state.equations.mesh)
    if marcher.last is not None:
        arrays |= {f"last.{name}": getattr(marcher.last, name) for name in PAST}
        arrays["last.size"] = np.array([marcher.last.size])
    if isinstance(marcher, FixedMarcher):
        arrays["march"] = np.array([marcher.proposal])
        if marcher.before is not None and marcher.moment is not None:
            arrays |= _pack_state("before", marcher.before) | {"moment": marcher.moment}
        return arrays | _pack_newton(marcher.newton)
    control = marcher.controller
    stages = marcher.stepper.method.stages
    arrays["march"] = np.array([marcher.proposal, control.last_size, control.last_error, stages])
    return arrays | {"base": marcher.base} | _pack_newton(marcher.stepper.newton)


def unpack(marcher: Marcher | FixedMarcher, arrays: Arrays) -> None:
    """Put a fresh march where the packed one was."""
    present = marcher.state.equations
    equations = BoxEquations(_unpack_mesh(arrays), present.rule, present.load)
    marcher.state = _unpack_state("state", arrays, equations)
    if "last.size" in arrays:
        marcher.last = Past(float(arrays["last.size"][0]), *(arrays[f"last.{name}"] for name in PAST))
    if isinstance(marcher, FixedMarcher):
        marcher.proposal = float(arrays["march"][0])
        if "moment" in arrays:
            marcher.before, marcher.moment = _unpack_state("before", arrays, equations), arrays["moment"]
        _unpack_newton(marcher.newton, arrays, equations)
        return
    marcher.proposal, last_size, last_error, stages = map(float, arrays["march"])
    marcher.use_stages(int(stages))
    marcher.controller = Controller(marcher.controller.exponent, last_size, last_error)
    marcher.base = arrays["base"]
    _unpack_newton(marcher.stepper.newton, arrays, marcher.stepper.form(equations))


def _pack_state(name: str, state: State) -> Arrays:
    arrays = {f"{name}.{field}": getattr(state, field) for field in STATE}
    return arrays | {f"{name}.time": np.array([state.time])}


def _unpack_state(name: str, arrays: Arrays, equations: BoxEquations) -> State:
    fields = {field: arrays[f"{name}.{field}"] for field in STATE}
    return State(time=float(arrays[f"{name}.time"][0]), equations=equations, **fields)


def _pack_mesh(mesh: Mesh) -> Arrays:
    return {
        "mesh.edges": mesh.edges,
        "mesh.segment": mesh.segment.astype(float),
        "mesh.stiffness": mesh.stiffness,
        "mesh.density": mesh.density,
    }


def _unpack_mesh(arrays: Arrays) -> Mesh:
    segment = arrays["mesh.segment"].astype(int)
    return Mesh(arrays["mesh.edges"], segment, arrays["mesh.stiffness"], arrays["mesh.density"])


def _pack_newton(newton: Newton) -> Arrays:
    kept = newton.linearisation
    if kept is None:
        return {}
    instant = {f"instant.{name}": value for name, value in kept.instant._asdict().items()}
    return instant | {"newton": np.array([kept.length, newton.contraction])}


def _unpack_newton(newton: Newton, arrays: Arrays, equations: Equations) -> None:
    if "newton" not in arrays:
        return
    length, newton.contraction = map(float, arrays["newton"])
    instant = Instant(*(arrays[f"instant.{name}"] for name in Instant._fields))
    newton.linearisation = newton.linearised(equations, length, instant)
