"""Results of a run and of a response: arrays by the names that the files give them (dynamics/output/results.md,
dynamics/output/response.md), with units."""

import importlib
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.array_types import Floats
from sprung_tools.files.errors import InputError
from sprung_tools.files.hdf5_file import RESPONSE, open_hdf5, read_numbers
from sprung_tools.files.results_file import COMPONENTS, ResultsFile, list_components, open_results
from sprung_tools.runs import labelled_responses
from sprung_tools.runs.measures import (
    UNKNOWN,
    Measures,
    calc_measures,
    find_points,
    is_converged,
    list_linear_objects,
    list_objects,
)
from sprung_tools.runs.ride_assessment import find_weighting_gap, list_remarks
from sprung_tools.runs.ride_measures import read_window
from sprung_tools.runs.run_warnings import list_warnings
from sprung_tools.runs.section_stress import list_stress_remarks, list_stressed_bodies

Folder = tempfile.TemporaryDirectory[str]
Names = str | Sequence[str]  # one, or several
SERIES = ("bodies", "energy", "forces", "joints", "points", "recovery")  # the groups of histories
DEEPEST = 4  # parts of a dataset's name, at most


class Mode(NamedTuple):
    """A mode of the vehicle about its equilibrium. Frequencies in Hz; participants: which bodies move, in words."""

    undamped_frequency: float
    damped_frequency: float
    damping_ratio: float
    rigid_body: bool
    participants: str


class Results:
    """The results of a run. `results[QUANTITY]` is a history [n], such as `points/chassis.seat/acceleration.y`;
    `QUANTITY in results` says whether there is one, and a loop over the results gives names(). Every array is the
    caller's own: what is done to it changes neither the results nor their measures.

    path: the results file. Close it, or use it in a with block; a file without a name of its own is then removed.
    """

    def __init__(self, path: str | Path, folder: Folder | None = None) -> None:
        self.path = Path(path)
        self._folder = folder
        self._file: ResultsFile = open_results(path)
        self._is_closed = False

    def __repr__(self) -> str:
        if self._is_closed:
            return f"<Results, closed: {self.path}>"
        trust = "" if self.converged else "; do not trust it: a check failed"
        span = f"{self.time.size} samples from {self.time[0]:g} s to {self.time[-1]:g} s"
        return f"<Results of '{self.title}': {span}; {len(self.warnings)} warnings{trust}>"

    def __enter__(self) -> "Results":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file, and removes it if it has no name of its own. Reading is an InputError from then on."""
        self._file.file.close()
        self._is_closed = True
        if self._folder is not None:
            self._folder.cleanup()

    @property
    def title(self) -> str:
        """The vehicle's name."""
        return self._file.title

    @property
    def time(self) -> Floats:
        """The time of each sample [n] s."""
        return self._file.time.copy()

    @property
    def converged(self) -> bool:
        """Whether no check of the run failed: its energy balance closes, and its accelerations are converged."""
        return is_converged(self._file)

    @property
    def warnings(self) -> list[str]:
        """The warnings about the numbers of the run."""
        return list(dict.fromkeys(one.text for one in list_warnings(self._file)))

    def __getitem__(self, quantity: str) -> Floats:
        return self._read(quantity)[0]

    def __contains__(self, quantity: object) -> bool:
        return isinstance(quantity, str) and self._file.has_series(quantity)

    def __iter__(self) -> Iterator[str]:
        return iter(self.names())

    def unit(self, quantity: str) -> str:
        """The unit of a quantity. InputError, as for its values, if there is no such quantity."""
        return self._read(quantity)[1]

    def array(self, quantity: str) -> Any:
        """A quantity as an xarray.DataArray over `time`, units as attributes. InputError where the package xarray is
        not installed."""
        try:
            xarray = importlib.import_module("xarray")
        except ImportError as error:
            raise InputError("xarray: error: is not installed; the Debian package is python3-xarray") from error
        values, unit = self._read(quantity)
        time = ("time", self.time, {"units": "s"})
        return xarray.DataArray(values, {"time": time}, ["time"], name=quantity, attrs={"units": unit})

    def names(self) -> list[str]:
        """The quantities of the file, each component for itself."""
        found: list[str] = []
        for group in SERIES:
            self._collect(group, found)
        listed = {name.rpartition(".")[0] for name in found}
        for point in self._file.names("points"):
            for what in ("position", "velocity", "acceleration", "deflection"):
                path = f"points/{point}/{what}"
                if path not in listed and self._file.has(path):
                    found += [f"{path}.{component}" for component in COMPONENTS[:2]]
        return found

    def measures(
        self,
        points: Names = (),
        *,
        start: float | None = None,
        end: float | None = None,
        superelements: str | Path | None = None,
    ) -> Measures:
        """All measures of the run by name (tools/README.md, "Measures"), each with `value` and `unit`.

        points: BODY.POINT, or several, whose vibration is judged (default: seats and their bodies); start, end: span
        of time [s] (default: that of the run's statistics); superelements: folder, for the moments of bodies taken as
        rigid.
        """
        window = read_window(self._file, start, end)
        folder = None if superelements is None else str(superelements)
        return calc_measures(list_objects(self._file, window, list_names(points), folder))

    def remarks(self, points: Names = (), *, start: float | None = None, end: float | None = None) -> list[str]:
        """What makes measures over a span doubtful, as a span that is too short for the MTVV, beside `warnings`.
        points, start, end: as of measures()."""
        window = read_window(self._file, start, end)
        judged = find_points(self._file, list_names(points))
        return [*list_remarks(self._file, judged, window),
                *list_stress_remarks(self._file, list_stressed_bodies(self._file))]  # fmt: skip

    def measure(self, name: str) -> float:
        """One measure over the span of the run's statistics; only its object is computed. InputError if there is no
        such measure."""
        wanted, _, _ = name.rpartition("/")
        points = [wanted.partition("/")[2]] if wanted.startswith(("points/", "bands/")) else []
        objects = list_objects(self._file, read_window(self._file), points)
        # The measures of points in the summary are among those of the object `summary`.
        calc = objects.get("summary" if wanted.startswith("summary") else wanted)
        measures = calc() if calc is not None else {}
        found = measures.get(name)
        if found is None:
            there = f"there are: {', '.join(measures)}" if measures else f"there are measures of: {', '.join(objects)}"
            raise InputError(f"{self.path}: error: no measure '{name}'; {there}")
        if found.value is None:
            judged = find_points(self._file, points) if points else []
            gaps = filter(None, (find_weighting_gap(self._file, point) for point in judged))
            raise InputError(f"{self.path}: error: {name}: {'; '.join((UNKNOWN, *gaps))}")
        return found.value

    def _read(self, quantity: object) -> tuple[Floats, str]:
        if not isinstance(quantity, str):
            what = f"{type(quantity).__name__} {quantity!r}"
            raise TypeError(f"a quantity is its name, such as 'points/chassis.seat/acceleration.y', got {what}")
        return self._file.series(quantity)

    def _collect(self, path: str, found: list[str]) -> None:
        file = self._file.file
        shape = file.shape(path)
        if shape is None:
            for name in file.names(path) if path.count("/") < DEEPEST else ():
                self._collect(f"{path}/{name}", found)
            return
        if shape[:1] != (file.count_rows(path, file.every(path), self.time.size),):
            return
        if len(shape) == 1:
            found.append(path)
        elif len(shape) == 2:
            columns = list_components(path, shape[1]) or [str(k + 1) for k in range(shape[1])]
            found += [f"{path}.{column}" for column in columns]


class Response:
    """The response of a linear vehicle to the road over the frequency. path: the response file, as in Results."""

    def __init__(self, path: str | Path, folder: Folder | None = None) -> None:
        self.path = Path(path)
        self._folder = folder
        file = open_hdf5(path, RESPONSE)
        self._response = labelled_responses.Response("", file, read_numbers(file, "frequency")[0])

    def __repr__(self) -> str:
        first, last = self.frequency[0], self.frequency[-1]
        return f"<Response at {self.frequency.size} frequencies from {first:g} Hz to {last:g} Hz>"

    def __enter__(self) -> "Response":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file, and removes it if it has no name of its own."""
        self._response.file.close()
        if self._folder is not None:
            self._folder.cleanup()

    @property
    def frequency(self) -> Floats:
        """The frequencies [m] Hz."""
        return self._response.frequency.copy()

    def names(self) -> list[str]:
        """The outputs."""
        return self._response.names()

    def magnitude(self, output: str) -> Floats:
        """The magnitude of an output on a road wave of 1 m [m]."""
        return self._response.values(output, is_spectrum=False)[0]

    def spectrum(self, output: str) -> Floats:
        """The one-sided spectral density of an output on the random road [m]."""
        return self._response.values(output, is_spectrum=True)[0]

    def rms(self, output: str) -> float:
        """The r.m.s. of an output on the random road."""
        return self._response.rms(output)

    def measures(self, points: Names = ()) -> Measures:
        """The measures of the points, and the r.m.s. of every output, by name, each with `value` and `unit`. points:
        as of Results.measures(); the default is all of the file."""
        return calc_measures(list_linear_objects(self._response, list_names(points)))


def list_names(names: Names) -> Sequence[str]:
    """Names that may be one alone."""
    return [names] if isinstance(names, str) else names
