"""Rapier: its Python module, which computes in single precision."""

from __future__ import annotations

from typing import Any

from .serving import CannotError, Task, march, principal_axes, refuse, serve


def run(task: Task) -> Task:
    """Answer one task."""
    import rapier3d as rapier

    refuse(task, {"ellipsoid": "it has no ellipsoid, only a convex polyhedron"})
    world = rapier.PhysicsWorld(gravity=tuple(task["gravity"]))
    parameters = world.integration_parameters
    parameters.dt = task["dt"]
    for name, value in task["setting"].get("parameters", {}).items():
        setattr(parameters, name, rapier.SpringCoefficients(*value) if isinstance(value, list) else value)
    if "friction_model" in task["setting"]:
        parameters.friction_model = getattr(rapier.FrictionModel, task["setting"]["friction_model"])
    table = _support(rapier, world, task)
    handles, principal = [], []
    for i, body in enumerate(task["bodies"]):
        handle, turn = _body(rapier, world, task, body, i)
        handles.append(handle)
        principal.append(turn)

    def step(count: int) -> None:
        """Take steps."""
        for _ in range(count):
            world.step()

    def read() -> list[Any]:
        """Return the state of each body: its frame is at the centre of mass."""
        seen = []
        for handle in handles:
            body = world.rigid_bodies[handle]
            at, turn = body.translation, body.rotation
            seen.append((_list(at), [turn.w, turn.i, turn.j, turn.k], _list(body.linvel), _list(body.angvel)))
        return seen

    hinged = task["support"]["motion"]["kind"] == "hinge"
    answer = march(task, f"Rapier {_version()}", step, read, (lambda: _turn_of(world, table)) if hinged else None)
    if hinged:  # a pose tells the angle up to whole turns only: the rate is what is needed
        answer["support"] = [[0.0, rate] for _, rate in answer["support"]]
    return answer


def _version() -> str:
    """Return the version of the package."""
    from importlib.metadata import version

    return version("rapier3d")


def _list(vector: Any) -> list[float]:
    """Return the components of a vector."""
    return [vector.x, vector.y, vector.z]


def _turn_of(world: Any, table: Any) -> tuple[float, float]:
    """Return the rate of the table; its angle is not told."""
    return 0.0, world.rigid_bodies[table].angvel.z


def _support(rapier: Any, world: Any, task: Task) -> Any:
    """Make the ground: a half-space or a ball, at rest, driven or on a hinge."""
    support, motion = task["support"], task["support"]["motion"]
    if support["kind"] == "dome":
        shape = rapier.Collider.ball(support["radius"]).translation((0.0, 0.0, -support["radius"]))
    elif "mesh" in support:
        shape = rapier.Collider.trimesh(support["mesh"]["vertices"], support["mesh"]["triangles"])
    else:
        # Not a box: on one, of whatever size, the edge of a disc loses energy and does not roll.
        shape = rapier.Collider.halfspace((0.0, 0.0, 1.0))
    # Of two coefficients the larger counts, and those of the bodies are their own.
    shape = shape.friction(0.0).restitution(0.0).friction_combine_rule(rapier.CoefficientCombineRule.MAX)
    shape = shape.restitution_combine_rule(rapier.CoefficientCombineRule.MAX).density(0.0)
    if motion["kind"] == "fixed":
        return world.add_body(rapier.RigidBody.fixed(), [shape])
    if motion["kind"] == "driven":
        return world.add_body(rapier.RigidBody.kinematic_velocity_based(angvel=(0.0, 0.0, motion["rate"])), [shape])
    mass = rapier.MassProperties((0.0, 0.0, 0.0), 1.0, (1.0, 1.0, motion["inertia"]))
    made = rapier.RigidBody.dynamic(can_sleep=False, angvel=(0.0, 0.0, motion["rate"])).additional_mass_properties(mass)
    table = world.add_body(made, [shape])
    ground = world.add_body(rapier.RigidBody.fixed())
    world.impulse_joints.insert(ground, table, rapier.RevoluteJoint.builder((0.0, 0.0, 1.0)).build())
    return table


def _body(rapier: Any, world: Any, task: Task, body: Task, i: int) -> tuple[Any, list[float]]:
    """Make a body, its frame in its centre of mass."""
    shape = body["shape"]
    kinds = {
        "sphere": lambda: rapier.Collider.ball(shape["radius"]),
        "box": lambda: rapier.Collider.cuboid(*shape["half_widths"]),
        # A cylinder stands along its second axis here.
        "disc": lambda: rapier.Collider.cylinder(1e-4, shape["radius"]).rotation((1.5707963267948966, 0.0, 0.0)),
    }
    if shape["kind"] not in kinds:
        raise CannotError(f"this adapter has no {shape['kind']}")
    moments, turn = principal_axes(body["inertia"])
    if turn != [1.0, 0.0, 0.0, 0.0]:
        raise CannotError("this adapter takes bodies whose axes are principal")
    friction = task["friction"] if i == 0 else task["friction_between"]
    collider = kinds[shape["kind"]]().translation(tuple(body["offset"])).density(0.0).friction(friction)
    collider = collider.friction_combine_rule(rapier.CoefficientCombineRule.MAX).restitution(task["restitution"])
    collider = collider.restitution_combine_rule(rapier.CoefficientCombineRule.MAX)
    w, x, y, z = body["orientation"]
    mass = rapier.MassProperties((0.0, 0.0, 0.0), body["mass"], tuple(moments))
    made = (
        rapier.RigidBody.dynamic(
            can_sleep=False, linvel=tuple(body["velocity"]), angvel=tuple(body["angular_velocity"])
        )
        .additional_mass_properties(mass)
        .gyroscopic_forces(True)
        .position(rapier.Isometry3(rapier.Vec3(*body["position"]), rapier.Rotation3(w, x, y, z)))
    )
    handle = world.add_body(made, [collider])
    if any(body["force"]):  # it acts until it is reset
        world.rigid_bodies[handle].add_force(tuple(body["force"]))
    return handle, turn


if __name__ == "__main__":
    serve(run)
