"""Flexible bodies read from files for other programs, and their motion in the plane by equations that are written here
from the file's integrals alone."""

import re

import h5py
import numpy as np
from scipy.integrate import solve_ivp


class PlaneBody:
    """A body by its integrals: m, S (2), J, P (2×n), c, d (n), E = ∫φ·φ dm and B = ∫φ×φ dm (n×n), modal matrices
    M, K, C (n×n), places (N×2) and shapes (N×2×n) of its nodes. Coordinates x, y, angle, then the modes."""

    def __init__(self, **values):
        self.__dict__.update(values)

    def take(self, n):
        """The same with its first n modes."""
        cut = {"P": self.P[:, :n], "c": self.c[:n], "d": self.d[:n], "shapes": self.shapes[:, :, :n]}
        cut.update({name: getattr(self, name)[:n, :n] for name in "EBMKC"})
        return PlaneBody(**{**self.__dict__, **cut})

    def make_equations(self, q, v, gravity):
        """(mass matrix, forces) with the terms that are quadratic in velocities."""
        angle, eta, rate, eta_dot = q[2], q[3:], v[2], v[3:]
        A = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        turn = np.array([[0.0, -1.0], [1.0, 0.0]])
        S = self.S + self.P @ eta
        n = len(eta)
        mass = np.zeros((3 + n, 3 + n))
        mass[:2, :2] = self.m * np.eye(2)
        mass[:2, 2] = mass[2, :2] = A @ turn @ S
        mass[2, 2] = self.J + 2 * self.d @ eta + eta @ self.E @ eta
        mass[:2, 3:] = A @ self.P
        mass[2, 3:] = self.c + eta @ self.B
        mass[3:, :3] = mass[:3, 3:].T
        mass[3:, 3:] = self.M
        g = np.array([0.0, -gravity])
        force = np.concatenate([
            self.m * g + A @ (rate**2 * S - 2 * rate * turn @ self.P @ eta_dot),
            [g @ A @ turn @ S - 2 * rate * (self.d @ eta_dot + eta @ self.E @ eta_dot)],
            self.P.T @ A.T @ g + rate**2 * (self.d + self.E @ eta) + 2 * rate * self.B @ eta_dot
            - self.K @ eta - self.C @ eta_dot,
        ])  # fmt: skip
        return mass, force

    def find_point(self, place, q):
        """(position, its derivatives) of the node at a place of the undeformed body."""
        node = int(np.argmin(np.linalg.norm(self.places - place, axis=1)))
        assert np.linalg.norm(self.places[node] - place) < 1e-9
        A = np.array([[np.cos(q[2]), -np.sin(q[2])], [np.sin(q[2]), np.cos(q[2])]])
        r = self.places[node] + self.shapes[node] @ q[3:]
        return q[:2] + A @ r, np.column_stack([np.eye(2), A @ [-r[1], r[0]], A @ self.shapes[node]])


class TaylorBody:
    """A body by standard input data: mass m, Taylor series in the modal coordinates by name, as (M⁰, M¹) with the mode
    as the first index of M¹, and those of each node. Indices of Gr and Ge are row, mode, axis. Coordinates as those of
    PlaneBody."""

    def __init__(self, m, series, nodes):
        self.m, self.series, self.nodes = m, series, nodes
        self.c = series["Cr"][0][:, 2]

    def take(self, n):
        """The same with its first n modes."""
        axes = {"Ct": [0], "Cr": [0], "Oe": [0], "ksigma": [0], "Me": [0, 1], "Ke": [0, 1], "De": [0, 1], "Gr": [1],
                "Ge": [0, 1], "phi": [1], "psi": [1]}  # fmt: skip

        def cut(name, zero, first):
            for axis in axes.get(name, []):
                zero, first = zero.take(range(n), axis), first.take(range(n), axis + 1)
            return zero, first[:n]

        return TaylorBody(self.m, {name: cut(name, *pair) for name, pair in self.series.items()},
                          [{name: cut(name, *pair) for name, pair in node.items()} for node in self.nodes])

    def make_equations(self, q, v, gravity):
        """(mass matrix, forces) by [Wallrapp 1994] in the body's axes and in space; of them the motion in the plane."""
        angle, eta, eta_dot, omega = q[2], q[3:], v[3:], np.array([0.0, 0.0, v[2]])
        value = {name: zero + np.tensordot(eta, first, 1) for name, (zero, first) in self.series.items()}
        xx, yy, zz, xy, xz, yz = value["J"][:, 0]
        J = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        moment, Ct, Cr = value["mdCM"][:, 0], value["Ct"], value["Cr"]
        mass = np.block([[self.m * np.eye(3), -cross_matrix(moment), Ct.T], [cross_matrix(moment), J, Cr.T],
                         [Ct, Cr, value["Me"]]])  # fmt: skip
        A = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
        g = A.T @ [0.0, -gravity, 0.0]
        products = omega[[0, 1, 2, 0, 1, 0]] * omega[[0, 1, 2, 1, 2, 2]]
        force = np.concatenate([
            self.m * g - np.cross(omega, 2.0 * Ct.T @ eta_dot + np.cross(omega, moment)),
            np.cross(moment, g) - np.einsum("ika,k,a", value["Gr"], eta_dot, omega) - np.cross(omega, J @ omega),
            Ct @ g - np.einsum("jka,k,a", value["Ge"], eta_dot, omega) - value["Oe"] @ products
            - value["Ke"] @ eta - value["De"] @ eta_dot,
        ])  # fmt: skip
        motion = np.zeros((len(force), len(q)))
        motion[:3, :2], motion[5, 2], motion[6:, 3:] = A.T[:, :2], 1.0, np.eye(len(eta))
        return motion.T @ mass @ motion, motion.T @ force

    def find_point(self, place, q):
        """(position, directions in which a force acts) of the node at a place of the undeformed body."""
        distances = [np.linalg.norm(node["origin"][0][:2, 0] - place) for node in self.nodes]
        assert min(distances) < 1e-9
        node = self.nodes[int(np.argmin(distances))]
        origin, phi = (node[name][0] + np.tensordot(q[3:], node[name][1], 1) for name in ("origin", "phi"))
        A = np.array([[np.cos(q[2]), -np.sin(q[2])], [np.sin(q[2]), np.cos(q[2])]])
        r = origin[:2, 0]
        return q[:2] + A @ r, np.column_stack([np.eye(2), A @ [-r[1], r[0]], A @ phi[:2]])


def cross_matrix(r):
    return np.cross(np.eye(3), r)


class PlaneSystem:
    """A body on springs (place on the body, place on the ground, free length, stiffness), of which some coordinates are
    held at 0."""

    def __init__(self, body, springs=(), held=(), gravity=0.0):
        self.body, self.springs, self.gravity = body, springs, gravity
        self.size = 3 + len(body.c)
        self.free = [i for i in range(self.size) if i not in held]

    def make_equations(self, q, v):
        mass, force = self.body.make_equations(q, v, self.gravity)
        for place, ground, free_length, stiffness in self.springs:
            position, derivatives = self.body.find_point(place, q)
            line = position - ground
            length = np.linalg.norm(line)
            force = force - derivatives.T @ line / length * stiffness * (length - free_length)
        return mass[np.ix_(self.free, self.free)], force[self.free]

    def fill(self, values):
        full = np.zeros(self.size)
        full[self.free] = values
        return full

    def move(self, times):
        """Coordinates at these times [s], from rest at 0."""
        n = len(self.free)

        def rates(_, state):
            mass, force = self.make_equations(self.fill(state[:n]), self.fill(state[n:]))
            return np.concatenate([state[n:], np.linalg.solve(mass, force)])

        found = solve_ivp(rates, (0.0, times[-1]), np.zeros(2 * n), "DOP853", times, rtol=1e-9, atol=1e-12)
        return np.array([self.fill(state) for state in found.y[:n].T])

    def frequencies(self):
        """Damped ones [Hz] at rest in the origin, without those at 0; force derivatives by central differences."""
        n, step = len(self.free), 1e-6
        mass, _ = self.make_equations(np.zeros(self.size), np.zeros(self.size))

        def derivatives(at):
            columns = [self.make_equations(*at(self.fill(step * unit)))[1]
                       - self.make_equations(*at(self.fill(-step * unit)))[1] for unit in np.eye(n)]  # fmt: skip
            return np.linalg.solve(mass, np.array(columns).T / (2 * step))

        rest = np.zeros(self.size)
        system = np.block([[np.zeros((n, n)), np.eye(n)],
                           [derivatives(lambda q: (q, rest)), derivatives(lambda v: (rest, v))]])  # fmt: skip
        omega = np.linalg.eigvals(system).imag
        return np.sort(omega[omega > 1.0]) / (2.0 * np.pi)


def read_mbdyn(path):
    """A file of MBDyn's modal joint, with the sums over its nodes that MBDyn takes as invariants."""
    groups = {}
    for line in path.read_text().splitlines():
        heading = re.match(r"\*\* RECORD GROUP (\d+),", line)
        if heading:
            words = groups.setdefault(int(heading[1]), [])
        elif not line.startswith("**"):
            words.extend(line.split())
    count, n = int(groups[1][1]), int(groups[1][2])
    number = {key: np.array(words, float) for key, words in groups.items() if key > 2}
    places = np.column_stack([number[5], number[6]])
    shapes = number[8].reshape(n, count, 6)[:, :, [0, 1, 5]].transpose(1, 2, 0)
    lumped = number[11].reshape(count, 6)
    m, inertia = lumped[:, 0], lumped[:, 5]
    x, y = places.T
    fx, fy, psi = (shapes[:, i] for i in range(3))
    frame = [label.isdigit() for label in groups[2]]
    M, K, C = (number[i].reshape(n, n) for i in (9, 10, 13))
    return PlaneBody(
        m=m.sum(), S=np.array([m @ x, m @ y]), J=m @ (x**2 + y**2) + inertia.sum(), P=np.array([m @ fx, m @ fy]),
        c=(m * x) @ fy - (m * y) @ fx + inertia @ psi, d=(m * x) @ fx + (m * y) @ fy,
        E=(fx.T * m) @ fx + (fy.T * m) @ fy, B=(fx.T * m) @ fy - (fy.T * m) @ fx, M=M, K=K, C=C,
        places=places[frame], shapes=shapes[frame][:, :2],
    )  # fmt: skip


def read_exudyn(path, damping_ratio):
    """A file of Exudyn's ObjectFFRFreducedOrderInterface, which has no damping."""
    with h5py.File(path) as file:
        data = {name: item[()] for name, item in file.items() if isinstance(item, h5py.Dataset)}
    M, K, m = (data[name] for name in ("massMatrixReduced", "stiffnessMatrixReduced", "totalMass"))
    n = len(M)
    linear = data["mXRefTildePsiTilde"]
    return PlaneBody(
        m=m, S=m * data["chiU"][:2], J=data["inertiaLocal"][2, 2], P=data["mPhitTPsi"][:2], c=-data["mXRefTildePsi"][2],
        d=linear[2, 2::3], E=data["mPsiTildePsiTilde"][2::3, 2::3], B=-data["mPsiTildePsi"][2::3], M=M, K=K,
        C=np.diag(2.0 * damping_ratio * np.sqrt(np.diag(K))),
        places=data["xRef"].reshape(-1, 3)[:, :2], shapes=data["modeBasis"].reshape(-1, 3, n)[:, :2],
    )  # fmt: skip


def read_mbsim(path):
    """A file of MBSim's ExternalFlexibleFfrBody."""
    with h5py.File(path) as file:
        data = {name: item[()] for name, item in file.items()}
    K = data["stiffness matrix"]
    n = len(K)
    linear = data["position shape function integral"].reshape(3, 3, n)
    xx, xy, _, yy, _, zz = data["shape function shape function integral"].reshape(6, n, n)
    return PlaneBody(
        m=data["mass"], S=data["position integral"][:2], J=np.trace(data["position position integral"]),
        P=data["shape function integral"][:2], c=linear[0, 1] - linear[1, 0], d=linear[0, 0] + linear[1, 1], E=xx + yy,
        B=xy - xy.T, M=xx + yy + zz, K=K, C=data["damping matrix"],
        places=data["nodal relative position"].reshape(-1, 3)[:, :2],
        shapes=data["nodal shape matrix of translation"].reshape(-1, 3, n)[:, :2],
    )  # fmt: skip


def read_sid(path):
    """Standard input data, with columns x, y, z of each mode in Gr and Ge."""
    mass, series, nodes, size = 0.0, {}, [], {}
    target, name = series, ""
    for line in path.read_text().splitlines():
        key, _, text = (word.strip() for word in line.partition("="))
        if key == "new node":
            nodes.append({})
            target = nodes[-1]
        elif key == "end node":
            target = series
        elif key == "mass":
            mass = float(text.replace("D", "E"))
        elif key in ("order", "nrow", "ncol", "nq"):
            size[key] = int(text)
        elif key == "structure":
            shape = (size["nrow"], size["ncol"])
            target[name] = (np.zeros(shape), np.zeros((size["nq"], *shape)))
        elif key.startswith("m0("):
            row, column = (int(word) - 1 for word in key[3:-1].split(","))
            target[name][0][row, column] = float(text.replace("D", "E"))
        elif key.startswith("m1("):
            row, mode, column = (int(word) - 1 for word in key[3:-1].split(","))
            target[name][1][mode, row, column] = float(text.replace("D", "E"))
        elif not text:
            name = key
    for name in ("Gr", "Ge"):
        series[name] = tuple(matrix.reshape(*matrix.shape[:-1], -1, 3) for matrix in series[name])
    return TaylorBody(mass, series, nodes)
