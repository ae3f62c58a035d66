"""PyBullet: Bullet's sequential impulses, by its Python module."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from .serving import CannotError, Task, march, principal_axes, refuse, serve, times


def run(task: Task) -> Task:
    """Answer one task."""
    import pybullet as pb

    refuse(
        task,
        {
            "ellipsoid": "it has no ellipsoid, only a mesh of one",
            "driven": "it has no body of prescribed velocity",
        },
    )
    if any(any(body["offset"]) for body in task["bodies"]) and task["bodies"][0]["shape"]["kind"] != "sphere":
        raise CannotError("this adapter moves the shape away from the centre of mass for balls only")
    pb.connect(pb.DIRECT)
    try:
        return _run(pb, task)
    finally:
        pb.disconnect()


def _run(pb: Any, task: Task) -> Task:
    setting, dt = task["setting"], task["dt"]
    pb.setGravity(*task["gravity"])
    pb.setTimeStep(dt)
    pb.setPhysicsEngineParameter(fixedTimeStep=dt, **setting.get("engine", {}))
    support = _support(pb, task)
    changes = dict(
        rollingFriction=0, spinningFriction=0, restitution=task["restitution"], **setting.get("dynamics", {})
    )
    # Coefficients of a pair are multiplied: 1 for the ground, and for balls what gives the pair its own.
    bodies, moments = [], []
    for i, body in enumerate(task["bodies"]):
        made, principal = _body(pb, body)
        friction = task["friction"] if i == 0 else task["friction_between"] / task["friction"]
        pb.changeDynamics(made, -1, lateralFriction=friction, **changes)
        bodies.append(made)
        moments.append(principal)
    link = -1 if task["support"]["motion"]["kind"] == "fixed" else 0
    pb.changeDynamics(support, link, lateralFriction=1.0, **changes | {"restitution": float(task["restitution"] > 0)})
    for made, principal, body in zip(bodies, moments, task["bodies"], strict=True):
        pb.resetBasePositionAndOrientation(made, body["position"], _xyzw(times(body["orientation"], principal)))
        pb.resetBaseVelocity(made, body["velocity"], body["angular_velocity"])
    pushed = [(made, body["force"]) for made, body in zip(bodies, task["bodies"], strict=True) if any(body["force"])]

    def step(count: int) -> None:
        """Take steps; a force lasts for one."""
        for _ in range(count):
            for made, force in pushed:
                place, _turn = pb.getBasePositionAndOrientation(made)
                pb.applyExternalForce(made, -1, force, place, pb.WORLD_FRAME)
            pb.stepSimulation()

    def read() -> list[Any]:
        """Return the state of each body, turned back from its principal axes."""
        seen = []
        for made, (w, x, y, z) in zip(bodies, moments, strict=True):
            place, turn = pb.getBasePositionAndOrientation(made)
            velocity, spin = pb.getBaseVelocity(made)
            seen.append((place, times([turn[3], *turn[:3]], [w, -x, -y, -z]), velocity, spin))
        return seen

    version = f"PyBullet {_version()}"
    return march(task, version, step, read, (lambda: pb.getJointState(support, 0)[:2]) if link == 0 else None)


def _version() -> str:
    """Return the version of the package: the module itself tells that of its interface."""
    from importlib.metadata import version

    return version("pybullet")


def _support(pb: Any, task: Task) -> int:
    """Make the ground: a plane, a large ball, or a box on a hinge."""
    support, motion = task["support"], task["support"]["motion"]
    if support["kind"] == "dome":
        shape = pb.createCollisionShape(pb.GEOM_SPHERE, radius=support["radius"])
        return int(pb.createMultiBody(0, shape, basePosition=[0, 0, -support["radius"]]))
    if "mesh" in support:
        mesh = support["mesh"]
        corners = [i for triangle in mesh["triangles"] for i in triangle]
        concave = pb.GEOM_FORCE_CONCAVE_TRIMESH
        shape = pb.createCollisionShape(pb.GEOM_MESH, vertices=mesh["vertices"], indices=corners, flags=concave)
        return int(pb.createMultiBody(0, shape))
    if motion["kind"] == "fixed":
        return int(pb.createMultiBody(0, pb.createCollisionShape(pb.GEOM_PLANE, planeNormal=[0, 0, 1])))
    inertia = f'<inertia ixx="1" iyy="1" izz="{motion["inertia"]!r}" ixy="0" ixz="0" iyz="0"/>'
    table = _load(
        pb,
        f'<link name="w"/><link name="t"><inertial><mass value="1"/>{inertia}</inertial><collision>'
        '<origin xyz="0 0 -0.5"/><geometry><box size="100 100 1"/></geometry></collision></link>'
        '<joint name="j" type="continuous"><parent link="w"/><child link="t"/><axis xyz="0 0 1"/></joint>',
        useFixedBase=1,
    )
    pb.setJointMotorControl2(table, 0, pb.VELOCITY_CONTROL, force=0)  # joints have a motor that holds them, else
    pb.resetJointState(table, 0, 0, motion["rate"])
    for link in (-1, 0):
        pb.changeDynamics(table, link, linearDamping=0, angularDamping=0, jointDamping=0)
    return table


def _body(pb: Any, body: Task) -> tuple[int, list[float]]:
    """Make a body, its frame along its principal axes; return it and the turn to them."""
    (xx, yy, zz), turn = principal_axes(body["inertia"])
    shape = body["shape"]
    if shape["kind"] == "disc":  # of a cylinder in a URDF file Bullet makes a prism
        made = pb.createMultiBody(body["mass"], pb.createCollisionShape(pb.GEOM_CYLINDER, shape["radius"], height=2e-4))
        pb.changeDynamics(made, -1, localInertiaDiagonal=[xx, yy, zz], collisionMargin=0)
        return made, turn
    kinds = {
        "sphere": lambda: f'<sphere radius="{shape["radius"]!r}"/>',
        "box": lambda: '<box size="{} {} {}"/>'.format(*(2 * half for half in shape["half_widths"])),
    }
    if shape["kind"] not in kinds:
        raise CannotError(f"this adapter has no {shape['kind']}")
    moments = f'<inertia ixx="{xx!r}" iyy="{yy!r}" izz="{zz!r}" ixy="0" ixz="0" iyz="0"/>'
    place = " ".join(repr(float(x)) for x in body["offset"])
    made = _load(
        pb,
        f'<link name="b"><inertial><mass value="{body["mass"]!r}"/>{moments}</inertial><collision>'
        f'<origin xyz="{place}"/><geometry>{kinds[shape["kind"]]()}</geometry></collision></link>',
    )
    return made, turn


def _load(pb: Any, content: str, **options: Any) -> int:
    """Load a robot from URDF, whose inertia is taken as it is written."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.urdf"
        path.write_text(f'<robot name="r">{content}</robot>')
        return int(pb.loadURDF(str(path), flags=pb.URDF_USE_INERTIA_FROM_FILE, **options))


def _xyzw(q: Any) -> list[float]:
    """Return a quaternion with its real part last."""
    return [*q[1:], q[0]]


if __name__ == "__main__":
    serve(run)
