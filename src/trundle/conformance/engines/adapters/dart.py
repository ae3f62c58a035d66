"""DART: its Python module dartpy."""

from __future__ import annotations

from typing import Any

from .serving import CannotError, Task, march, plates, refuse, serve

_THICK = 0.02  # m, half of a plate


def run(task: Task) -> Task:
    """Answer one task."""
    import dartpy as dart
    import numpy as np

    refuse(
        task,
        {
            "driven": "this adapter found no joint of prescribed velocity that contacts feel",
        },
    )
    world = dart.simulation.World()
    world.setGravity(np.array(task["gravity"]))
    world.setTimeStep(task["dt"])
    if "friction" in task["setting"]:
        world.getConstraintSolver().setBoxedLcpSolver(_friction_solver(dart.constraint, **task["setting"]["friction"]))
    table = _support(dart, np, world, task)
    bodies = [_body(dart, np, world, task, body, i) for i, body in enumerate(task["bodies"])]
    forces = [(node, np.array(body["force"])) for node, body in zip(bodies, task["bodies"], strict=True)]
    pushed = [(node, force) for node, force in forces if force.any()]

    def step(count: int) -> None:
        """Take steps; a force lasts for one."""
        for _ in range(count):
            for node, force in pushed:
                node.addExtForce(force)
            world.step()

    def read() -> list[Any]:
        """Return the state of each body: its frame is at the centre of mass."""
        seen = []
        for node in bodies:
            pose = node.getWorldTransform()
            q = dart.math.Quaternion(pose.rotation())
            seen.append(
                (
                    np.ravel(pose.translation()),
                    [q.w(), q.x(), q.y(), q.z()],
                    np.ravel(node.getLinearVelocity()),
                    np.ravel(node.getAngularVelocity()),
                )
            )
        return seen

    hinged = task["support"]["motion"]["kind"] == "hinge"
    turn = (lambda: (table.getPosition(0), table.getVelocity(0))) if hinged else None
    return march(task, f"DART {dart.__version__}", step, read, turn)


def _friction_solver(constraint: Any, kind: str, **options: Any) -> Any:
    """Return the solver of contacts of that kind, its options changed."""
    made = getattr(constraint, kind)
    chosen = made.Options()
    for name, value in options.items():
        setattr(chosen, name, made.Law.__members__[value] if name == "law" else value)
    return made(chosen)


def _support(dart: Any, np: Any, world: Any, task: Task) -> Any:
    """Make the ground, at rest or on a hinge; return the joint."""
    support, motion = task["support"], task["support"]["motion"]
    skeleton = dart.dynamics.Skeleton("ground")
    if motion["kind"] == "fixed":
        joint, node = skeleton.createWeldJointAndBodyNodePair()
    else:
        joint, node = skeleton.createRevoluteJointAndBodyNodePair()
        joint.setAxis(np.array([0.0, 0.0, 1.0]))
    # Of two coefficients the smaller counts: balls on a box have that of the box at most, which they do not need.
    surface = np, 1e3, float(task["restitution"] > 0)
    if "mesh" in support:  # through its meshes the ball falls: plates behind the triangles bound the same room
        for place, frame, half in plates(np, support["mesh"]):
            box = dart.dynamics.BoxShape(2 * np.array([half, half, _THICK]))
            _rough(node, box, place - _THICK * frame[:, 2], *surface).setRelativeRotation(frame)
    elif support["kind"] == "dome":
        _rough(node, dart.dynamics.SphereShape(support["radius"]), [0.0, 0.0, -support["radius"]], *surface)
    else:
        _rough(node, dart.dynamics.BoxShape(np.array([100.0, 100.0, 1.0])), [0.0, 0.0, -0.5], *surface)
    inertia = motion.get("inertia", 1.0)
    node.setInertia(dart.dynamics.Inertia(1.0, np.zeros(3), np.diag([1.0, 1.0, inertia])))
    world.addSkeleton(skeleton)
    if motion["kind"] != "fixed":
        joint.setVelocity(0, motion["rate"])
    return joint


def _body(dart: Any, np: Any, world: Any, task: Task, body: Task, i: int) -> Any:
    """Make a body that moves freely, its frame at the centre of mass; return its node."""
    shape = body["shape"]
    kinds = {
        "sphere": lambda: dart.dynamics.SphereShape(shape["radius"]),
        "box": lambda: dart.dynamics.BoxShape(2 * np.array(shape["half_widths"])),
        "disc": lambda: dart.dynamics.CylinderShape(shape["radius"], 2e-4),
        "ellipsoid": lambda: dart.dynamics.EllipsoidShape(2 * np.array(shape["semi_axes"])),
    }
    if shape["kind"] not in kinds:
        raise CannotError(f"this adapter has no {shape['kind']}")
    skeleton = dart.dynamics.Skeleton(f"body{i}")
    joint, node = skeleton.createFreeJointAndBodyNodePair()
    friction = 1e3 if len(task["bodies"]) > 1 and i > 0 else task["friction"]
    _rough(node, kinds[shape["kind"]](), body["offset"], np, friction, task["restitution"])
    node.setInertia(dart.dynamics.Inertia(body["mass"], np.zeros(3), np.array(body["inertia"])))
    world.addSkeleton(skeleton)
    pose = dart.math.Isometry3()
    pose.set_translation(np.array(body["position"]))
    pose.set_rotation(dart.math.Quaternion(*body["orientation"]).to_rotation_matrix())
    if hasattr(joint, "setTransform"):
        joint.setTransform(pose)
    else:
        skeleton.setPositions(dart.dynamics.FreeJoint.convertToPositions(pose))
    skeleton.setVelocities(np.array([*body["angular_velocity"], *body["velocity"]]))
    return node


def _rough(node: Any, shape: Any, place: list[float], np: Any, friction: float, restitution: float) -> Any:
    """Give a body its shape, with a coefficient of friction and one of restitution; return the shape's node."""
    part = node.createShapeNode(shape)
    part.createCollisionAspect()
    part.createDynamicsAspect()
    part.getDynamicsAspect().setFrictionCoeff(friction)
    part.getDynamicsAspect().setRestitutionCoeff(restitution)
    part.setRelativeTranslation(np.array(place, dtype=float))
    return part


if __name__ == "__main__":
    serve(run)
