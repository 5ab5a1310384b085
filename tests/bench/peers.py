"""One call to a pose, beside every Python package that has one: python tests/bench/peers.py

    python tests/bench/peers.py [--problems N] [--markdown]

Every peer gets the same bodies, starts, targets and tolerance, in turns of a few problems, in one
process on one BLAS thread; process time is counted. Each is called through its documented
interface, with targets that are positions only; the poses that it gives are judged by our forward
kinematics. Who stops by itself (ikpy, tinyik) stops where its own defaults say, as nothing in its
interface says how near is enough. Two hand-written loops around compiled Jacobians (pinocchio,
MuJoCo), with the damping that ours has, show what compiled code leaves to be gained. A peer that is
not installed is skipped by name: the extra `peers` has them all.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy starts its threads
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import contextlib
import io
import platform
import tempfile
import warnings
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from time import process_time_ns
from typing import NamedTuple

import numpy as np

from ikteach import Effectors, Joint, Tree, figures, forward, locate, solve
from ikteach.body.tree import GROUND

MOST = 200  # iterations, for those whose iterations can be bounded
BLOCK = 10  # problems, after which the next peer has its turn
SEARCHES = 7  # of roboticstoolbox, each of its default of 30 iterations


class Case(NamedTuple):
    """A body with problems: poses `starts` (b, n) and `targets` (b, k, 3) to be met to `within`."""

    name: str
    tree: Tree
    effectors: Effectors
    within: float
    starts: np.ndarray
    targets: np.ndarray


Solve = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, float]]
"""From a start (n,) and targets (k, 3) to a pose (n,) and the iterations that it took, or NaN."""


def arm7():
    """A made-up arm of seven hinges, 1.3 m long, with axes along x, y and z as tinyik wants."""
    axes = [(0, 0, 1), (0, 1, 0), (0, 0, 1), (0, 1, 0), (0, 0, 1), (0, 1, 0), (1, 0, 0)]
    rises = [0.0, 0.333, 0.0, 0.316, 0.0, 0.384, 0.088]
    tree = Tree.of(
        Joint(f"a{i + 1}", f"a{i}" if i else None, (0, 0, rise), axis, lower=-2.8, upper=2.8)
        for i, (rise, axis) in enumerate(zip(rises, axes, strict=True))
    )
    return figures.Figure(tree, Effectors.of(tree, {"tool": ("a7", (0, 0.05, 0.207))}))


def case(name, figure, within, near, problems, seed=0):
    """Problems whose targets are met by a pose `near` [rad] the start, joint by joint."""
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    lower, upper = np.maximum(tree.lower, -np.pi), np.minimum(tree.upper, np.pi)
    middle, half = (lower + upper) / 2, (upper - lower) / 2
    starts = middle + rng.uniform(-0.7, 0.7, (problems, len(tree))) * half
    goals = np.clip(starts + rng.uniform(-near, near, starts.shape), lower, upper)
    return Case(name, tree, effectors, within, starts, locate(forward(tree, goals), effectors))


# The peers. Each takes a case and gives a `Solve`, or raises ImportError, or gives None where it
# cannot do the case: most know one effector.


def ours(c):
    def one(start, targets):
        found = solve(c.tree, c.effectors, targets, theta=start, tolerance=c.within, most=MOST)
        return found.theta, float(found.iterations)

    return one


def damped_step(J, e):
    """The step of `dls_following`, as short as numpy has it, for the loops by hand."""
    A = J @ J.T
    A.flat[:: len(A) + 1] += 0.25 * (e @ e) + 1.6e-7 * np.vdot(J, J)
    return J.T @ np.linalg.solve(A, e)


def pinocchio_model(c):
    """The body as a model of pinocchio, its effectors as frames."""
    import pinocchio as pin

    model, ids = pin.Model(), []
    for j, name in enumerate(c.tree.names):
        parent = 0 if c.tree.parents[j] == GROUND else ids[c.tree.parents[j]]
        place = pin.SE3(np.eye(3), c.tree.offsets[j])
        kind = pin.JointModelRevoluteUnaligned(c.tree.axes[j])
        one = np.ones(1)
        lower, upper = c.tree.lower[j : j + 1], c.tree.upper[j : j + 1]
        ids.append(model.addJoint(parent, kind, place, name, 1e3 * one, 1e3 * one, lower, upper))
    for name, joint, offset in zip(
        c.effectors.names, c.effectors.joints, c.effectors.offsets, strict=True
    ):
        place = pin.SE3(np.eye(3), offset)
        model.addFrame(pin.Frame(f"at {name}", ids[joint], 0, place, pin.FrameType.OP_FRAME))
    return model


def pinocchio_loop(c):
    """Damped least squares by hand around pinocchio's compiled frames and Jacobians."""
    import pinocchio as pin

    model = pinocchio_model(c)
    data = model.createData()
    frames = [model.getFrameId(f"at {name}") for name in c.effectors.names]
    m = 3 * len(frames)
    around = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    lower, upper = c.tree.lower, c.tree.upper

    def one(start, targets):
        q, J = start.copy(), np.empty((m, len(start)))
        for n in range(MOST + 1):
            pin.computeJointJacobians(model, data, q)
            pin.updateFramePlacements(model, data)
            e = targets - np.array([data.oMf[f].translation for f in frames])
            if n == MOST or np.sqrt((e * e).sum(axis=-1)).max() <= c.within:
                return q, n
            for i, f in enumerate(frames):
                J[3 * i : 3 * i + 3] = pin.getFrameJacobian(model, data, f, around)[:3]
            q = q + damped_step(J, e.ravel())
            q = np.minimum(np.maximum(q, lower), upper)

    return one


def pink_loop(c):
    """pink: a task per effector, limits of the configuration, its default solver daqp."""
    import pink

    model = pinocchio_model(c)
    limits = [pink.limits.ConfigurationLimit(model)]
    tasks = [
        pink.FrameTask(f"at {name}", position_cost=1.0, orientation_cost=0.0, lm_damping=1.0)
        for name in c.effectors.names
    ]

    configuration = pink.Configuration(model, model.createData(), c.starts[0])

    def one(start, targets):
        configuration.update(start)
        for task, target in zip(tasks, targets, strict=True):
            place = configuration.get_transform_frame_to_world(task.frame).copy()
            place.translation = target
            task.set_target(place)
        for n in range(MOST + 1):
            e = [
                configuration.get_transform_frame_to_world(task.frame).translation - target
                for task, target in zip(tasks, targets, strict=True)
            ]
            if n == MOST or np.linalg.norm(e, axis=-1).max() <= c.within:
                return configuration.q, n
            velocity = pink.solve_ik(
                configuration, tasks, 1.0, solver="daqp", limits=limits, safety_break=False
            )
            configuration.integrate_inplace(velocity, 1.0)

    return one


def mjcf(c):
    """The body in MuJoCo's own format, its effectors as sites."""
    children = {j: [] for j in range(-1, len(c.tree))}
    for j, parent in enumerate(c.tree.parents):
        children[int(parent)].append(j)

    def numbers(values):
        return " ".join(f"{x:.17g}" for x in values)

    def body(j):
        sites = "".join(
            f'<site name="{name}" pos="{numbers(offset)}"/>'
            for name, at, offset in zip(
                c.effectors.names, c.effectors.joints, c.effectors.offsets, strict=True
            )
            if at == j
        )
        limits = numbers((c.tree.lower[j], c.tree.upper[j]))
        return (
            f'<body name="{c.tree.names[j]}" pos="{numbers(c.tree.offsets[j])}">'
            f'<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
            f'<joint name="{c.tree.names[j]}" axis="{numbers(c.tree.axes[j])}" limited="true" '
            f'range="{limits}"/>{sites}{"".join(map(body, children[j]))}</body>'
        )

    inside = "".join(map(body, children[GROUND]))
    return f'<mujoco><compiler angle="radian"/><worldbody>{inside}</worldbody></mujoco>'


def mujoco_model(c):
    """The model, and where MuJoCo keeps each of our joints."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(mjcf(c))
    return model, np.array([model.joint(name).qposadr[0] for name in c.tree.names])


def mujoco_loop(c):
    """Damped least squares by hand around MuJoCo's compiled Jacobians."""
    import mujoco

    model, order = mujoco_model(c)
    data = mujoco.MjData(model)
    sites = [model.site(name).id for name in c.effectors.names]
    m = 3 * len(sites)
    lower, upper = model.jnt_range.T

    def one(start, targets):
        q, J = np.empty(model.nq), np.empty((m, model.nv))
        q[order] = start
        for n in range(MOST + 1):
            data.qpos[:] = q
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            e = targets - data.site_xpos[sites]
            if n == MOST or np.sqrt((e * e).sum(axis=-1)).max() <= c.within:
                return q[order], n
            for i, site in enumerate(sites):
                mujoco.mj_jacSite(model, data, J[3 * i : 3 * i + 3], None, site)
            q = q + damped_step(J, e.ravel())
            q = np.minimum(np.maximum(q, lower), upper)

    return one


def mink_loop(c):
    """mink: a task per effector, limits of the configuration, daqp as in its examples."""
    import mink

    model, order = mujoco_model(c)
    configuration = mink.Configuration(model)
    limits = [mink.ConfigurationLimit(model)]
    tasks = [
        mink.FrameTask(name, "site", position_cost=1.0, orientation_cost=0.0, lm_damping=1.0)
        for name in c.effectors.names
    ]

    def one(start, targets):
        q = np.empty(model.nq)
        q[order] = start
        configuration.update(q)
        for task, target in zip(tasks, targets, strict=True):
            task.set_target(mink.SE3.from_translation(target))
        for n in range(MOST + 1):
            e = [
                configuration.get_transform_frame_to_world(task.frame_name, "site").translation()
                - target
                for task, target in zip(tasks, targets, strict=True)
            ]
            if n == MOST or np.linalg.norm(e, axis=-1).max() <= c.within:
                return configuration.q[order], n
            velocity = mink.solve_ik(configuration, tasks, 1.0, "daqp", limits=limits)
            configuration.integrate_inplace(velocity, 1.0)

    return one


def ikpy_chain(c):
    """ikpy: `Chain.inverse_kinematics`, which asks scipy's least squares."""
    if len(c.effectors) > 1:
        return None
    from ikpy.chain import Chain
    from ikpy.link import OriginLink, URDFLink

    links = [OriginLink()]
    for j, name in enumerate(c.tree.names):
        bounds = (c.tree.lower[j], c.tree.upper[j])
        links.append(URDFLink(name, c.tree.offsets[j], [0, 0, 0], c.tree.axes[j], bounds=bounds))
    links.append(
        URDFLink("end", c.effectors.offsets[0], [0, 0, 0], joint_type="fixed", rotation=None)
    )
    chain = Chain(links, active_links_mask=[False, *[True] * len(c.tree), False])

    def one(start, targets):
        q = chain.inverse_kinematics(targets[0], initial_position=[0, *start, 0])
        return q[1:-1], np.nan

    return one


def tinyik_actuator(c):
    """tinyik: `Actuator.ee = target`, which asks scipy's optimiser; it knows no limits."""
    if len(c.effectors) > 1 or (c.tree.axes.max(axis=1) < 1).any():
        return None
    import tinyik

    tokens = []
    for j in range(len(c.tree)):
        tokens += [list(c.tree.offsets[j]), "xyz"[int(c.tree.axes[j].argmax())]]
    actuator = tinyik.Actuator([*tokens, list(c.effectors.offsets[0])])

    def one(start, targets):
        actuator.angles = start
        actuator.ee = targets[0]
        return np.asarray(actuator.angles), np.nan

    return one


def roboticstoolbox_ets(c):
    """The elementary transforms of a chain, as roboticstoolbox has them."""
    import roboticstoolbox as rtb

    ets = rtb.ETS()
    for j in range(len(c.tree)):
        ets *= rtb.ET.SE3(_moved(c.tree.offsets[j]))
        axis = "xyz"[int(abs(c.tree.axes[j]).argmax())]
        turn = {"x": rtb.ET.Rx, "y": rtb.ET.Ry, "z": rtb.ET.Rz}[axis]
        ets *= turn(flip=bool(c.tree.axes[j].sum() < 0), qlim=(c.tree.lower[j], c.tree.upper[j]))
    return ets * rtb.ET.SE3(_moved(c.effectors.offsets[0]))


def _moved(offset):
    T = np.eye(4)
    T[:3, 3] = offset
    return T


def roboticstoolbox_python(c):
    """roboticstoolbox: its Levenberg–Marquardt in Python, `IK_LM`."""
    if len(c.effectors) > 1:
        return None
    import roboticstoolbox as rtb

    ets = roboticstoolbox_ets(c)
    solver = rtb.IK_LM(
        tol=0.5 * c.within**2, mask=[1, 1, 1, 0, 0, 0], joint_limits=True, slimit=SEARCHES
    )

    def one(start, targets):
        found = solver.solve(ets, _moved(targets[0]), start)
        return found.q, found.iterations

    return one


def roboticstoolbox_compiled(c):
    """roboticstoolbox: its Levenberg–Marquardt in C++, `ETS.ik_LM`."""
    if len(c.effectors) > 1:
        return None
    ets = roboticstoolbox_ets(c)

    def one(start, targets):
        found = ets.ik_LM(
            _moved(targets[0]), q0=start, tol=0.5 * c.within**2, mask=[1, 1, 1, 0, 0, 0],
            joint_limits=True, slimit=SEARCHES,
        )  # fmt: skip
        return found.q, found.iterations

    return one


def pybullet_solver(c):
    """pybullet: `calculateInverseKinematics(2)`, compiled damped least squares."""
    import pybullet

    if not pybullet.isConnected():
        pybullet.connect(pybullet.DIRECT)
    pybullet.resetSimulation()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "body.urdf")
        file.write_text(urdf(c), encoding="utf-8")
        with _quiet():
            body = pybullet.loadURDF(str(file), useFixedBase=True)
    names = [pybullet.getJointInfo(body, i)[1].decode() for i in range(pybullet.getNumJoints(body))]
    moving = [name for name in names if name in c.tree.names]
    order = np.array([moving.index(name) for name in c.tree.names])
    ends = [names.index(f"to {name}") for name in c.effectors.names]
    of_moving = np.array([c.tree.index(name) for name in moving])
    places = [names.index(name) for name in c.tree.names]
    limits = {
        "lowerLimits": [c.tree.lower[c.tree.index(name)] for name in moving],
        "upperLimits": [c.tree.upper[c.tree.index(name)] for name in moving],
        "jointRanges": [float(np.ptp([c.tree.lower[i], c.tree.upper[i]])) for i in
                        map(c.tree.index, moving)],
    }  # fmt: skip

    def one(start, targets):
        for place, angle in zip(places, start, strict=True):
            pybullet.resetJointState(body, place, angle)
        if len(ends) > 1:
            q = pybullet.calculateInverseKinematics2(
                body, ends, targets.tolist(), maxNumIterations=MOST, residualThreshold=c.within
            )
        else:
            rest = {"restPoses": start[of_moving].tolist()}
            q = pybullet.calculateInverseKinematics(
                body, ends[0], targets[0].tolist(), maxNumIterations=MOST,
                residualThreshold=c.within, **limits, **rest,
            )  # fmt: skip
        return np.asarray(q)[order], np.nan

    return one


def urdf(c):
    """The body as URDF, a link per joint and one per effector."""
    links, joints = [_link("ground")], []
    for j, name in enumerate(c.tree.names):
        parent = "ground" if c.tree.parents[j] == GROUND else c.tree.names[c.tree.parents[j]]
        x, axis = (
            " ".join(f"{v:.17g}" for v in row) for row in (c.tree.offsets[j], c.tree.axes[j])
        )
        links.append(_link(f"link {name}"))
        parent = parent if parent == "ground" else f"link {parent}"
        joints.append(
            f'<joint name="{name}" type="revolute"><parent link="{parent}"/>'
            f'<child link="link {name}"/><origin xyz="{x}"/><axis xyz="{axis}"/>'
            f'<limit lower="{c.tree.lower[j]}" upper="{c.tree.upper[j]}" effort="1" velocity="9"/>'
            "</joint>"
        )
    for i, name in enumerate(c.effectors.names):
        x = " ".join(f"{v:.17g}" for v in c.effectors.offsets[i])
        links.append(_link(f"at {name}"))
        joints.append(
            f'<joint name="to {name}" type="fixed">'
            f'<parent link="link {c.tree.names[c.effectors.joints[i]]}"/>'
            f'<child link="at {name}"/><origin xyz="{x}"/></joint>'
        )
    return f'<robot name="body">{"".join(links + joints)}</robot>'


def _link(name):
    return (
        f'<link name="{name}"><inertial><mass value="1"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )


@contextlib.contextmanager
def _quiet():
    """Keep what compiled code prints off the table."""
    keep = os.dup(1)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        try:
            yield
        finally:
            os.dup2(keep, 1)
            os.close(keep)


PEERS = {  # name: (the package it comes from, how it is asked)
    "ikteach.solve": ("ikteach", ours),
    "pinocchio, loop by hand": ("pin", pinocchio_loop),
    "MuJoCo, loop by hand": ("mujoco", mujoco_loop),
    "pink with limits": ("pin-pink", pink_loop),
    "mink with limits": ("mink", mink_loop),
    "ikpy": ("ikpy", ikpy_chain),
    "tinyik (no limits)": ("tinyik", tinyik_actuator),
    "roboticstoolbox, Python": ("roboticstoolbox-python", roboticstoolbox_python),
    "roboticstoolbox, compiled": ("roboticstoolbox-python", roboticstoolbox_compiled),
    "pybullet, compiled": ("pybullet", pybullet_solver),
}


class Result(NamedTuple):
    """How a peer did on a case: share solved within limits, iterations and µs (medians)."""

    peer: str
    solved: float
    iterations: float
    micros: float

    def row(self, base):
        """Its row of the table; `base` is what ours takes [µs]."""
        steps = "–" if np.isnan(self.iterations) else f"{self.iterations:.0f}"
        ratio = f"{self.micros / base:.2f}"
        return [self.peer, f"{self.solved:.1%}", steps, f"{self.micros:.0f}", ratio]


def race(c, peers):
    """Every peer on every problem of the case; they take turns after every BLOCK problems."""
    taken = {name: [] for name in peers}
    found = {name: [] for name in peers}
    for first in range(0, len(c.starts), BLOCK):
        block = list(
            zip(c.starts[first : first + BLOCK], c.targets[first : first + BLOCK], strict=True)
        )
        for name, one in peers.items():
            began = process_time_ns()
            answers = [one(start, targets) for start, targets in block]
            taken[name].append((process_time_ns() - began) / 1000 / len(block))
            found[name] += answers
    return [judged(c, name, found[name], np.median(taken[name])) for name in peers]


def judged(c, name, found, micros):
    """The poses that a peer gave, held against the targets and the limits."""
    theta = np.array([pose for pose, _ in found])
    off = np.linalg.norm(locate(forward(c.tree, theta), c.effectors) - c.targets, axis=-1)
    inside = (theta >= c.tree.lower - 1e-6) & (theta <= c.tree.upper + 1e-6)
    solved = (off <= 1.001 * c.within).all(axis=-1) & inside.all(axis=-1)
    return Result(name, solved.mean(), np.median([steps for _, steps in found]), micros)


def batches(c, peers, rounds=3):
    """All problems at once by `solve`, beside loops over them: µs a solve, in turns."""
    taken = {name: [] for name in ("ikteach.solve", *peers)}
    for _ in range(rounds):
        began = process_time_ns()
        found = solve(c.tree, c.effectors, c.targets, theta=c.starts, tolerance=c.within, most=MOST)
        taken["ikteach.solve"].append((process_time_ns() - began) / 1000 / len(c.starts))
        for name, one in peers.items():
            began = process_time_ns()
            for start, targets in zip(c.starts, c.targets, strict=True):
                one(start, targets)
            taken[name].append((process_time_ns() - began) / 1000 / len(c.starts))
    return found.converged.mean(), {name: min(times) for name, times in taken.items()}


def ready(c):
    """The peers that are here and can do the case; the others are named."""
    found = {}
    for name, (package, make) in PEERS.items():
        try:
            with warnings.catch_warnings(), contextlib.redirect_stderr(io.StringIO()):
                warnings.simplefilter("ignore")
                one = make(c)
        except ImportError as error:
            print(f"skipped: {name}, {package} is not here ({error})")
            continue
        if one is not None:
            one(c.starts[0].copy(), c.targets[0].copy())  # warm
            found[name] = one
    return found


def processor():
    """What the machine calls its processor."""
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":")[1].strip()
    return platform.processor() or platform.machine()


def versions():
    """The packages that took part, with their versions."""
    for package in dict.fromkeys(["numpy", *(package for package, _ in PEERS.values())]):
        with contextlib.suppress(PackageNotFoundError):
            yield f"{package} {version(package)}"


def table(header, rows, markdown):
    """Print a table, plain or in Markdown."""
    if markdown:
        print("| " + " | ".join(header) + " |\n|" + "---|" * len(header))
        for row in rows:
            print("| " + " | ".join(row) + " |")
        return
    for row in [header, *rows]:
        print(f"{row[0]:28}" + "".join(f"{cell:>18}" for cell in row[1:]))


def main():
    """Print what every peer does with every case."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--problems", type=int, default=200, help="of each case (200)")
    parser.add_argument("--markdown", action="store_true", help="tables for the documentation")
    options = parser.parse_args()
    human = figures.human()
    warnings.simplefilter("ignore")  # of the peers
    print(f"{processor()}, Python {platform.python_version()}, {', '.join(versions())}\n")
    cases = [
        case("human, 4 effectors, near (± 0.1 rad)", human, 1.8e-3, 0.1, options.problems),
        case("human, 4 effectors, far (± 0.5 rad)", human, 1.8e-3, 0.5, options.problems),
        case("arm of 7 hinges, near (± 0.1 rad)", arm7(), 1.3e-3, 0.1, options.problems),
        case("arm of 7 hinges, far (± 0.5 rad)", arm7(), 1.3e-3, 0.5, options.problems),
    ]
    for c in cases:
        results = race(c, ready(c))
        base = results[0].micros
        print(f"\n{c.name}: {len(c.starts)} problems, one at a time\n")
        rows = [result.row(base) for result in results]
        table(["", "solved", "iterations", "µs a solve", "of ours"], rows, options.markdown)
    loops = {"MuJoCo, loop by hand", "pinocchio, loop by hand"}
    for near, sizes in ((0.1, (1000,)), (0.5, (100, 1000))):
        for size in sizes:
            c = case("", human, 1.8e-3, near, size, seed=1)
            share, taken = batches(c, {k: v for k, v in ready(c).items() if k in loops})
            base = taken["ikteach.solve"]
            print(f"\nhuman, {size} at once (± {near} rad), {share:.1%} solved by ours\n")
            rows = [[name, f"{t:.0f}", f"{t / base:.2f}"] for name, t in taken.items()]
            table(["", "µs a solve", "of ours"], rows, options.markdown)


if __name__ == "__main__":
    main()
