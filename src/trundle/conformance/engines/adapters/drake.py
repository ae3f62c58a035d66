"""Drake: MultibodyPlant in discrete time, with point contact."""

from __future__ import annotations

from typing import Any

from .serving import CannotError, Task, changes, march, pieces, refuse, serve


def run(task: Task) -> Task:
    """Answer one task."""
    import numpy as np
    from pydrake import all as drake

    refuse(
        task,
        {
            "restitution": "its discrete contacts have no coefficient of restitution: they dissipate",
            "driven": "it has no body of prescribed velocity",
            "box": "its point contact has one point for a box on a plane, which then tips; hydroelastic contact was not"
            " tried",
        },
    )
    setting = task["setting"]
    builder = drake.DiagramBuilder()
    options = {name: setting[name] for name in ("stiction_tolerance", "penetration_allowance") if name in setting}
    config = drake.MultibodyPlantConfig(time_step=task["dt"], contact_model="point", **options)
    if "approximation" in setting:
        config.discrete_contact_approximation = setting["approximation"]
    plant, _graph = drake.AddMultibodyPlant(config, builder)
    hinge = _support(drake, np, plant, task)
    bodies = [_body(drake, np, plant, task, body, i) for i, body in enumerate(task["bodies"])]
    plant.mutable_gravity_field().set_gravity_vector(task["gravity"])
    plant.Finalize()
    if any(any(body["force"]) for body in task["bodies"]):
        _push(drake, builder, plant, bodies, task)
    diagram = builder.Build()
    simulator = drake.Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    for made, body in zip(bodies, task["bodies"], strict=True):
        q = np.array(body["orientation"]) / np.linalg.norm(body["orientation"])
        plant.SetFreeBodyPose(context, made, drake.RigidTransform(drake.Quaternion(q), body["position"]))
        velocity = drake.SpatialVelocity(body["angular_velocity"], body["velocity"])
        plant.SetFreeBodySpatialVelocity(context, made, velocity)
    if hinge is not None:
        hinge.set_angular_rate(context, task["support"]["motion"]["rate"])
    begun = plant.GetPositionsAndVelocities(context)
    simulator.Initialize()
    count = [0]

    def step(steps: int) -> None:
        """Take steps."""
        count[0] += steps
        simulator.AdvanceTo(count[0] * task["dt"])

    def read() -> list[Any]:
        """Return the state of each body: its frame is at the centre of mass."""
        seen = []
        for made in bodies:
            pose = plant.EvalBodyPoseInWorld(context, made)
            velocity = plant.EvalBodySpatialVelocityInWorld(context, made)
            q = pose.rotation().ToQuaternion().wxyz()
            seen.append((pose.translation(), q, velocity.translational(), velocity.rotational()))
        return seen

    turn = None if hinge is None else lambda: (hinge.get_angle(context), hinge.get_angular_rate(context))
    answer = march(task, f"Drake {_version()}", step, read, turn)
    if "derivatives" in task:
        answer["derivatives"] = {"AutoDiffXd": differentiated(drake, np, task, diagram, plant, bodies[0], begun)}
    return answer


def differentiated(drake: Any, np: Any, task: Task, diagram: Any, plant: Any, made: Any, begun: Any) -> list[Any]:
    """Return the derivatives of the final state, by the run in AutoDiffXd."""
    directions = task["derivatives"]
    place, moves = made.floating_positions_start(), plant.num_positions() + made.floating_velocities_start_in_v()
    slopes = np.zeros((begun.size, len(directions)))
    for j, direction in enumerate(directions):
        slope = direction["bodies"][0]
        slopes[place : place + 7, j] = [*slope["orientation"], *slope["position"]]
        slopes[moves : moves + 6, j] = [*slope["angular_velocity"], *slope["velocity"]]
        for hinge in set(range(plant.num_positions(), begun.size)) - set(range(moves, moves + 6)):
            slopes[hinge, j] = direction["support"]["motion"]["rate"]
    twin = diagram.ToAutoDiffXd()
    simulator = drake.Simulator_[drake.AutoDiffXd](twin)
    own = twin.GetSubsystemByName("plant")
    context = own.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    own.SetPositionsAndVelocities(context, drake.InitializeAutoDiff(begun, slopes)[:, 0])
    try:
        simulator.Initialize()
        simulator.AdvanceTo(task["duration"])
    except RuntimeError as error:
        return [str(error)] * len(directions)
    found = drake.ExtractGradient(own.GetPositionsAndVelocities(context))
    parts = {"position": place + 4, "velocity": moves + 3, "angular_velocity": moves}
    ends = [{key: [found[at : at + 3, j].tolist()] for key, at in parts.items()} for j in range(len(directions))]
    reason = "this adapter makes no variable of a number of the model"
    return [end if changes(direction) <= {"start"} else reason for end, direction in zip(ends, directions, strict=True)]


def _version() -> str:
    """Return the version of the package."""
    from importlib.metadata import version

    return version("drake")


def _surface(drake: Any, task: Task, friction: float) -> Any:
    """Return what contact is to know of a surface."""
    properties = drake.ProximityProperties()
    coulomb = drake.CoulombFriction(friction, friction)
    stiffness = task["setting"].get("stiffness")
    drake.AddContactMaterial(
        **({"point_stiffness": stiffness} if stiffness else {}), friction=coulomb, properties=properties
    )
    if "relaxation_time" in task["setting"]:
        properties.AddProperty("material", "relaxation_time", task["setting"]["relaxation_time"])
    return properties


def _support(drake: Any, np: Any, plant: Any, task: Task) -> Any:
    """Make the ground: a half space or a large ball; return the joint of a table on a hinge."""
    support, motion = task["support"], task["support"]["motion"]
    # Of two coefficients it takes 2 μ₁ μ₂/(μ₁ + μ₂): the same one twice gives that one.
    own, pair = task["friction"], task["friction_between"]
    properties = _surface(drake, task, own * pair / (2 * pair - own) if pair else own)
    if "mesh" in support:  # a mesh is taken for its convex hull by point contact: it is told as convex pieces
        for i, piece in enumerate(pieces(support["mesh"])):
            shape = drake.Convex(points=np.array(piece).T, label=f"piece{i}")
            plant.RegisterCollisionGeometry(plant.world_body(), drake.RigidTransform(), shape, f"ground{i}", properties)
        return None
    if support["kind"] == "dome":
        place, shape = drake.RigidTransform([0.0, 0.0, -support["radius"]]), drake.Sphere(support["radius"])
    else:
        place, shape = drake.RigidTransform(), drake.HalfSpace()
    if motion["kind"] == "fixed":
        plant.RegisterCollisionGeometry(plant.world_body(), place, shape, "ground", properties)
        return None
    inertia = drake.SpatialInertia(1.0, [0.0, 0.0, 0.0], drake.UnitInertia(*[motion["inertia"]] * 3))
    table = plant.AddRigidBody("table", inertia)
    hinge = plant.AddJoint(drake.RevoluteJoint("hinge", plant.world_frame(), table.body_frame(), [0, 0, 1]))
    plant.RegisterCollisionGeometry(table, place, shape, "ground", properties)
    return hinge


def _body(drake: Any, np: Any, plant: Any, task: Task, body: Task, i: int) -> Any:
    """Make a body, its frame at the centre of mass."""
    shape = body["shape"]
    kinds = {
        "sphere": lambda: drake.Sphere(shape["radius"]),
        "disc": lambda: drake.Cylinder(shape["radius"], 2e-4),
        "ellipsoid": lambda: drake.Ellipsoid(*shape["semi_axes"]),
    }
    if shape["kind"] not in kinds:
        raise CannotError(f"this adapter has no {shape['kind']}")
    J = np.array(body["inertia"]) / body["mass"]
    unit = drake.UnitInertia(J[0, 0], J[1, 1], J[2, 2], J[0, 1], J[0, 2], J[1, 2])
    made = plant.AddRigidBody(f"body{i}", drake.SpatialInertia(body["mass"], [0.0, 0.0, 0.0], unit))
    friction = task["friction_between"] or task["friction"]
    place = drake.RigidTransform(body["offset"])
    plant.RegisterCollisionGeometry(made, place, kinds[shape["kind"]](), f"shape{i}", _surface(drake, task, friction))
    return made


def _push(drake: Any, builder: Any, plant: Any, bodies: list[Any], task: Task) -> None:
    """Apply the constant forces of the task."""
    forces = []
    for made, body in zip(bodies, task["bodies"], strict=True):
        if any(body["force"]):
            force = drake.ExternallyAppliedSpatialForce()
            force.body_index = made.index()
            force.p_BoBq_B = [0.0, 0.0, 0.0]
            force.F_Bq_W = drake.SpatialForce([0.0, 0.0, 0.0], body["force"])
            forces.append(force)
    source = builder.AddSystem(
        drake.ConstantValueSource(drake.Value[list[drake.ExternallyAppliedSpatialForce]](forces))
    )
    builder.Connect(source.get_output_port(0), plant.get_applied_spatial_force_input_port())


if __name__ == "__main__":
    serve(run)
