"""Vehicles of rigid and flexible bodies from Python: reducing designs, runs, responses, modes.

    import sprung

    sprung.build(["meshes/truck/chassis.toml", "meshes/truck/long_arm.toml"], "build/truck")
    results = sprung.run("dynamics/models/truck/bump.toml", superelements="build/truck", overrides={"speed": 4.0})
    results.time                                            # [n] s
    results["points/chassis.seat/acceleration.y"]           # [n]
    results.unit("points/chassis.seat/acceleration.y")      # "m/s^2"
    results.measures()["points/chassis.seat/wk_rms"].value

Nothing is computed here: `build` starts sprung-reduce as a process, and the other functions have the commands of
sprung-dynamics done in this process, by a module that is built with the program; without it they start the program,
with the same results. explain_calls() says which. The programs are those of the environment variables SPRUNG_REDUCE and
SPRUNG_DYNAMICS, else those of the installation or of build/release, else those in the PATH.

Bad input is an InputError, whose text is that of the program, `path:line:column: error: …`. A NumericalError says that
a computation did not come to its end.
"""

from sprung.commands import NumericalError, build, equilibrium, explain_calls, modes, response, run
from sprung.results import Mode, Response, Results
from sprung_tools.files.errors import InputError
from sprung_tools.runs.measures import Measure

__all__ = [
    "InputError", "Measure", "Mode", "NumericalError", "Response", "Results", "build", "equilibrium",
    "explain_calls", "modes", "response", "run",
]  # fmt: skip
