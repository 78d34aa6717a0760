"""Ride-limiting speeds as in the NATO Reference Mobility Model [1]: the r.m.s. roughness of terrain at which the driver
absorbs 6 W at a speed, and the speed at which a half-round obstacle gives the driver 2.5 g.

[1] R. B. Ahlvin, P. W. Haley, NATO Reference Mobility Model, edition II, NRMM II user's guide, US Army Engineer
Waterways Experiment Station, technical report GL-92-19 (1992). The limits are those of absorbed power of
signals/absorbed_power.py, and of the largest vertical acceleration at the driver's seat.
"""

import math
from typing import NamedTuple

import numpy as np

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.limits.roads import make_obstacle, make_terrain
from sprung_tools.limits.root_finding import CallFailed, Root, find_root
from sprung_tools.limits.trials import AHEAD, Felt, Vehicle
from sprung_tools.signals.absorbed_power import calc_absorbed_power
from sprung_tools.signals.road_profile import Recipe

GRAVITY = 9.80665  # m/s², of the 2.5 g
SETTLING = 2.0  # s, after the last wheel is over the obstacle
TOLERANCE = 0.005  # relative, of roughness and speed
LARGEST_STEP = math.log(3.0)  # of the logarithm of the roughness
SPEED_STEP = math.log(1.25)  # of the logarithm of the speed
FILTER_ORDER = 4  # of the low-pass filter, forwards and backwards


class Terrain(NamedTuple):
    """Terrain: its recipe with any r.m.s.; the least and the greatest r.m.s. [m] that are tried; the limit [W]."""

    recipe: Recipe
    roughness: tuple[float, float]
    power: float


class Obstacles(NamedTuple):
    """Obstacles: the least and the greatest speed that are tried [m/s], the limit [m/s²], the low-pass filter's
    frequency [Hz] (None: no filter)."""

    speeds: tuple[float, float]
    acceleration: float
    low_pass: float | None


def calc_power(vehicle: Vehicle, terrain: Terrain, speed: float, roughness: float) -> float:
    """The mean absorbed power [W] while the leading wheel is on the terrain between its eased ends, where the roughness
    is its r.m.s. [m]. CallFailed for a run that one cannot use."""
    recipe = terrain.recipe
    begin, end = (AHEAD + place for place in (recipe.ease, recipe.length - recipe.ease))
    felt = vehicle.drive(speed, make_terrain(recipe, roughness), end / speed)
    felt.check_speed(speed, begin, end)
    power = calc_absorbed_power(felt.acceleration, felt.step)
    return float(np.mean(power[round(begin / speed / felt.step) :]))


def find_roughness(vehicle: Vehicle, terrain: Terrain, speed: float) -> Root:
    """The r.m.s. roughness [m] at which the driver absorbs the limit at a speed. Steps are those of a linear vehicle,
    whose power goes with the square of the roughness."""

    def excess(logarithm: float) -> float:
        power = calc_power(vehicle, terrain, speed, math.exp(logarithm))
        return 0.5 * math.log(max(power, 1e-12) / terrain.power)

    low, high = (math.log(one) for one in terrain.roughness)
    root = find_root(
        excess, 0.5 * (low + high), (low, high),
        lambda _, value: min(1.02 * abs(value) + TOLERANCE, LARGEST_STEP), TOLERANCE,
    )  # fmt: skip
    return root._replace(value=None if root.value is None else math.exp(root.value))


def calc_peak(vehicle: Vehicle, obstacles: Obstacles, height: float, speed: float) -> float:
    """The largest vertical acceleration [m/s²], of either sign, on the way over an obstacle. CallFailed for a run that
    one cannot use."""
    radius = vehicle.wheels.point_radius
    way = AHEAD + vehicle.wheels.base + 2.0 * math.sqrt(height**2 + 2.0 * (radius or 0.0) * height)
    felt = vehicle.drive(speed, make_obstacle(height, radius), way / speed + SETTLING)
    # A wheel that is not on a point loses speed on the obstacle, and meets it before its centre is there.
    felt.check_speed(speed, 0.0, 0.5 * AHEAD if vehicle.wheels.has_others else way)
    if felt.way[-1] < way:
        raise CallFailed(f"at {speed:.4g} m/s the vehicle did not get over: {felt.way[-1]:.3g} m far of {way:.3g} m")
    return float(np.max(np.abs(smooth(felt, obstacles.low_pass))))


def smooth(felt: Felt, low_pass: float | None) -> Floats:
    """The acceleration through a Butterworth filter without delay. InputError for a frequency that the outputs cannot
    hold."""
    if low_pass is None:
        return felt.acceleration
    highest = 0.5 / felt.step
    if not low_pass < highest:
        what = f"is {low_pass:g} Hz, expected less than {highest:g} Hz, half of the outputs' frequency"
        raise InputError(f"--low-pass: error: {what}")
    from scipy.signal import butter, sosfiltfilt  # here because it takes longer to load than all else

    sections = butter(FILTER_ORDER, low_pass, fs=1.0 / felt.step, output="sos")
    filtered: Floats = sosfiltfilt(sections, felt.acceleration)
    return filtered


def find_speed(vehicle: Vehicle, obstacles: Obstacles, height: float) -> Root:
    """The lowest speed [m/s] at which an obstacle gives the driver the limit, searched upwards in steps of 25 %."""

    def excess(logarithm: float) -> float:
        peak = calc_peak(vehicle, obstacles, height, math.exp(logarithm))
        return math.log(max(peak, 1e-12) / obstacles.acceleration)

    low, high = (math.log(one) for one in obstacles.speeds)
    root = find_root(excess, low, (low, high), lambda *_: SPEED_STEP, TOLERANCE)
    return root._replace(value=None if root.value is None else math.exp(root.value))


class Limits(NamedTuple):
    """The limits of a vehicle: the roughness at each speed, the speed at each obstacle's height."""

    vehicle: Vehicle
    roughness: dict[float, Root]
    speeds: dict[float, Root]
