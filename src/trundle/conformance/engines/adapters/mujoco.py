"""MuJoCo: a model written in MJCF, stepped by mj_step."""

from __future__ import annotations

from typing import Any

from .serving import CannotError, Task, backwards, changes, cross, march, pieces, refuse, rotation, serve, times, turned

# What MuJoCo does where nothing is said; a setting names what differs.
SHIPPED = {
    "cone": "pyramidal",
    "integrator": "Euler",
    "impratio": 1,
    "noslip_iterations": 0,
    "iterations": 100,
    "tolerance": 1e-8,
    "solref": [0.02, 1.0],
    "solimp": [0.9, 0.95, 0.001],
}
_ALONE = 'contype="0" conaffinity="0"'  # what meets something is named as a pair with it
DIFFERENCES = (1e-6, 1e-8)  # by which mjd_transitionFD moves the state
_BY_NUMBERS = "mjd_transitionFD has derivatives by the state, and none by numbers of the model"


def model(task: Task, *, moving: bool = True) -> str:
    """Write the task as MJCF; not moving, it is what the bodies settle on: no forces, gravity along the normal."""
    chosen = SHIPPED | {key: value for key, value in task["setting"].items() if key in SHIPPED}
    if "solref_steps" in task["setting"]:  # a time constant tied to the step
        chosen["solref"] = [task["setting"]["solref_steps"] * task["dt"], 1.0]
    soft = f'solref="{_row(chosen["solref"])}" solimp="{_row(chosen["solimp"])}" condim="3"'
    along = task["setting"].get("solreffriction")  # its own for the directions of friction
    if along and "mesh" in task["support"]:
        raise CannotError("solreffriction is of named pairs, and pieces of a mesh are none here")
    slow = f' solreffriction="{_row(along)}"' if along else ""
    support, motion = task["support"], task["support"]["motion"]
    assets = ""
    if "mesh" in support:  # one that is not convex is taken for its convex hull: it is told as convex pieces
        assets, ground = _pieces(support)
    elif support["kind"] == "dome":
        radius = support["radius"]
        ground = f'<geom name="ground" type="sphere" size="{radius!r}" pos="0 0 {-radius!r}" {_ALONE}/>'
    else:
        ground = f'<geom name="ground" type="plane" size="100 100 1" {_ALONE}/>'
    if motion["kind"] == "hinge" and moving:  # a plane may not move here: a disc of 50 m does
        ground = (
            '<body><joint name="hinge" type="hinge" axis="0 0 1"/>'
            f'<inertial pos="0 0 0" mass="1" diaginertia="1 1 {motion["inertia"]!r}"/>'
            f'<geom name="ground" type="cylinder" size="50 0.5" pos="0 0 -0.5" {_ALONE}/></body>'
        )
    # What meets pieces cannot name each as a pair: it says itself how it meets them.
    meets = f'contype="1" priority="1" friction="{task["friction"]!r} 0 0" {soft}' if assets else _ALONE
    bodies = "".join(_body(i, body, meets) for i, body in enumerate(task["bodies"]))
    ground_pair = f'<pair geom1="g0" geom2="ground" friction="{_friction(task["friction"])}" {soft}{slow}/>'
    pairs = ("" if assets else ground_pair) + "".join(
        f'<pair geom1="g{i}" geom2="g0" friction="{_friction(task["friction_between"])}" {soft}{slow}/>'
        for i in range(1, len(task["bodies"]))
    )
    gravity = task["gravity"] if moving else [0.0, 0.0, task["gravity"][2]]
    option = (
        f'<option timestep="{task["dt"]!r}" gravity="{_row(gravity)}" cone="{chosen["cone"]}" '
        f'impratio="{chosen["impratio"]!r}" integrator="{chosen["integrator"]}" tolerance="{chosen["tolerance"]!r}" '
        f'iterations="{chosen["iterations"]}" noslip_iterations="{chosen["noslip_iterations"]}"/>'
    )
    exact = '<compiler balanceinertia="false" boundmass="0" boundinertia="0"/>'
    return f"<mujoco>{exact}{option}{assets}<worldbody>{ground}{bodies}</worldbody><contact>{pairs}</contact></mujoco>"


def run(task: Task) -> Task:
    """Answer one task."""
    import mujoco

    refuse(
        task,
        {
            "restitution": "it has no coefficient of restitution: contacts are damped springs",
            "driven": "it has no body of prescribed velocity that contacts know of",
        },
    )
    world = mujoco.MjModel.from_xml_string(model(task))
    data = mujoco.MjData(world)
    heights = settled(mujoco, task)
    hinged = task["support"]["motion"]["kind"] == "hinge"
    if hinged:
        data.joint("hinge").qvel = task["support"]["motion"]["rate"]
    names = [f"b{i}" for i in range(len(task["bodies"]))]
    for i, (name, body) in enumerate(zip(names, task["bodies"], strict=True)):
        joint = data.joint(name)
        x, y, z = body["position"]
        joint.qpos = [x, y, z if heights is None else heights[i], *body["orientation"]]
        back = [list(column) for column in zip(*rotation(body["orientation"]), strict=True)]  # Ω in body axes
        spin = [sum(a * b for a, b in zip(row, body["angular_velocity"], strict=True)) for row in back]
        joint.qvel = [*body["velocity"], *spin]
        data.xfrc_applied[world.body(name).id, :3] = body["force"]
    joints = [data.joint(name) for name in names]
    hinge = data.joint("hinge") if hinged else None

    def read() -> list[Any]:
        """Return the state of each body, the angular velocity turned to space axes."""
        return [(j.qpos[:3], j.qpos[3:], j.qvel[:3], turned(j.qpos[3:], j.qvel[3:])) for j in joints]

    if "derivatives" in task:
        return chained(mujoco, task, world, data, read)
    return march(
        task,
        f"MuJoCo {mujoco.__version__}",
        lambda count: mujoco.mj_step(world, data, count),
        read,
        None if hinge is None else lambda: (hinge.qpos[0], hinge.qvel[0]),
    )


def chained(mujoco: Any, task: Task, world: Any, data: Any, read: Any) -> Task:
    """March, and carry the slopes of the state along by mjd_transitionFD of each step."""
    import numpy as np

    directions = task["derivatives"]
    able = [changes(direction) <= {"start"} for direction in directions]
    if not any(able):
        raise CannotError(_BY_NUMBERS)
    if len(task["bodies"]) > 1:
        raise CannotError("this adapter chains the derivatives of one body")
    begun = np.array([_tangent(task, direction) for direction in directions]).T
    slopes = dict.fromkeys(DIFFERENCES, begun)
    A = np.zeros((2 * world.nv, 2 * world.nv))

    def step(count: int) -> None:
        """Take steps; the derivatives of each are taken before it."""
        for _ in range(count):
            for by in DIFFERENCES:
                mujoco.mjd_transitionFD(world, data, by, 1, A, None, None, None)
                slopes[by] = A @ slopes[by]
            mujoco.mj_step(world, data)

    answer = march(task, f"MuJoCo {mujoco.__version__}", step, read)
    turn, spin = data.joint("b0").qpos[3:], data.joint("b0").qvel[3:]

    def end(column: Any) -> Task:
        """Return the slopes in the axes of space."""
        place, velocity = column[world.nv - 6 : world.nv], column[-6:]
        across = velocity[3:] + np.cross(place[3:], spin)
        parts = {"position": place[:3], "velocity": velocity[:3], "angular_velocity": turned(turn, across)}
        return {name: [[float(x) for x in part]] for name, part in parts.items()}

    answer["derivatives"] = {
        f"mjd_transitionFD by {by:g}": [end(slope) if able[j] else _BY_NUMBERS for j, slope in enumerate(slopes[by].T)]
        for by in DIFFERENCES
    }
    return answer


def _tangent(task: Task, direction: Task) -> list[float]:
    """Return a direction as mjd_transitionFD has it: turns and angular velocities in the axes of the body."""
    body, slope = task["bodies"][0], direction["bodies"][0]
    w, x, y, z = body["orientation"]
    _, *half = times([w, -x, -y, -z], slope["orientation"])
    turn, q = [2 * part for part in half], body["orientation"]
    across = cross(backwards(q, body["angular_velocity"]), turn)
    spin = [a + b for a, b in zip(backwards(q, slope["angular_velocity"]), across, strict=True)]
    hinge = [direction["support"]["motion"]["rate"]] if "rate" in direction["support"]["motion"] else []
    return [*(0.0 for _ in hinge), *slope["position"], *turn, *hinge, *slope["velocity"], *spin]


def settled(mujoco: Any, task: Task) -> list[float] | None:
    """Return the heights at which balls and boxes come to rest: contacts are springs, and start in balance."""
    shapes = {body["shape"]["kind"] for body in task["bodies"]} | {task["support"]["kind"]}
    if not shapes <= {"sphere", "box", "plane"} or any(any(body["offset"]) for body in task["bodies"]):
        return None
    world = mujoco.MjModel.from_xml_string(model(task, moving=False))
    data = mujoco.MjData(world)
    for i, body in enumerate(task["bodies"]):
        data.joint(f"b{i}").qpos = [*body["position"], 1.0, 0.0, 0.0, 0.0]
    mujoco.mj_step(world, data, round(1.0 / task["dt"]))
    return [float(data.joint(f"b{i}").qpos[2]) for i in range(len(task["bodies"]))]


def _pieces(support: Task) -> tuple[str, str]:
    """Write the pieces of a bowl as meshes, and as what is made of them."""
    corners = [" ".join(map(_row, piece)) for piece in pieces(support["mesh"])]
    meshes = "".join(f'<mesh name="m{i}" vertex="{piece}"/>' for i, piece in enumerate(corners))
    geoms = "".join(f'<geom type="mesh" mesh="m{i}" contype="0" conaffinity="1"/>' for i in range(len(corners)))
    return f"<asset>{meshes}</asset>", geoms


def _body(i: int, body: Task, meets: str) -> str:
    """Write one body that moves freely, its frame at the centre of mass."""
    shape = body["shape"]
    sizes = {
        "sphere": ("sphere", [shape.get("radius")]),
        "disc": ("cylinder", [shape.get("radius"), 1e-5]),
        "ellipsoid": ("ellipsoid", shape.get("semi_axes")),
        "box": ("box", shape.get("half_widths")),
    }
    if shape["kind"] not in sizes:
        raise CannotError(f"this adapter has no {shape['kind']}")
    kind, size = sizes[shape["kind"]]
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = body["inertia"]
    inertia = f'mass="{body["mass"]!r}" fullinertia="{_row([xx, yy, zz, xy, xz, yz])}"'
    if not (xy or xz or yz):
        inertia = f'mass="{body["mass"]!r}" diaginertia="{_row([xx, yy, zz])}"'
    return (
        f'<body name="b{i}"><freejoint name="b{i}"/><inertial pos="0 0 0" {inertia}/>'
        f'<geom name="g{i}" type="{kind}" size="{_row(size)}" pos="{_row(body["offset"])}" {meets}/></body>'
    )


def _row(numbers: Any) -> str:
    """Write numbers as MJCF does."""
    return " ".join(repr(float(number)) for number in numbers)


def _friction(mu: float) -> str:
    """Write a coefficient for the two directions of slipping, and none for spinning and rolling."""
    return f"{mu!r} {mu!r} 0 0 0"


if __name__ == "__main__":
    serve(run)
