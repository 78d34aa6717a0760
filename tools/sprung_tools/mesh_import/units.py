"""A source's units in SI units: it gives lengths in one unit, forces in another, times in seconds; the unit of mass
follows from these."""

from typing import NamedTuple


class Units(NamedTuple):
    """The source's units of length [m] and force [N]; the properties are its units of other quantities, in SI units."""

    length: float = 1.0
    force: float = 1.0

    @property
    def stress(self) -> float:
        return self.force / self.length**2

    @property
    def mass(self) -> float:
        return self.force / self.length

    @property
    def density(self) -> float:
        return self.mass / self.length**3

    @property
    def mass_per_length(self) -> float:
        return self.mass / self.length

    @property
    def inertia(self) -> float:
        return self.mass * self.length**2

    def describe(self) -> str:
        """What was assumed, for people."""
        return (
            f"The source's unit of length was taken as {self.length:g} m, that of force as {self.force:g} N, "
            f"that of time as 1 s; then its unit of mass is {self.mass:g} kg."
        )
