"""Newton, on Warp: its kernels run on the processor here, which is not what they are made for."""

from __future__ import annotations

from typing import Any

from .serving import END, CannotError, Task, changes, march, refuse, serve

LONGEST, FINEST = 2.0, 1e-3  # s: longer runs and finer steps take a processor minutes
MOST_TAPED = 2000  # steps: to go back over them nine times takes a processor half a minute
_XPBD, _TAPED = "SolverXPBD", "SolverSemiImplicit"


def run(task: Task) -> Task:
    """Answer one task."""
    if task["duration"] > LONGEST or task["dt"] < 0.99 * FINEST:
        raise CannotError(
            f"on a processor, runs longer than {LONGEST:g} s and steps finer than {1e3 * FINEST:g} ms take it minutes"
        )
    refuse(
        task,
        {
            "driven": "this adapter found no body of prescribed velocity that contacts feel",
            "hinge": "its cases are longer than 2 s",
        },
    )
    setting = task["setting"]
    kind = setting.get("solver", _XPBD)
    if task["restitution"] and kind != _XPBD:
        raise CannotError(f"{kind} has no coefficient of restitution")
    import warp as wp

    wp.config.quiet = True
    wp.init()
    wp.set_device("cpu")
    import newton
    import numpy as np

    builder = newton.ModelBuilder(gravity=tuple(task["gravity"]))
    _support(newton, wp, np, builder, task)
    bodies = [_body(newton, wp, builder, task, body, i) for i, body in enumerate(task["bodies"])]
    model = builder.finalize(device="cpu", requires_grad="derivatives" in task and kind == _TAPED)
    options = dict(setting.get("options", {}))
    if task["restitution"]:
        options["enable_restitution"] = True
    solver = getattr(newton.solvers, kind)(model, **options)
    states, control, contacts = [model.state(), model.state()], model.control(), model.contacts()
    _start(newton, model, states[0], task, bodies)
    pushed = [(body, told["force"]) for body, told in zip(bodies, task["bodies"], strict=True) if any(told["force"])]
    forces = states[0].body_f.numpy().copy()  # it shows the state itself, which each step clears
    for body, force in pushed:
        forces[body, :3] = force

    def step(count: int) -> None:
        """Take steps; a force lasts for one."""
        for _ in range(count):
            states[0].clear_forces()
            if pushed:
                states[0].body_f.assign(forces)
            model.collide(states[0], contacts)
            solver.step(states[0], states[1], control, contacts, task["dt"])
            states.reverse()

    def read() -> list[Any]:
        """Return the state of each body: its frame is at the centre of mass."""
        places, rates = states[0].body_q.numpy(), states[0].body_qd.numpy()
        return [(places[i, :3], places[i, [6, 3, 4, 5]], rates[i, :3], rates[i, 3:]) for i in bodies]

    answer = march(task, f"Newton {newton.__version__}", step, read)
    if "derivatives" in task:
        _start(newton, model, begun := model.state(), task, bodies)
        answer["derivatives"] = {
            "wp.Tape": _untaped(task, kind) or differentiated(wp, task, model, solver, begun, bodies[0])
        }
    return answer


def _untaped(task: Task, kind: str) -> list[str]:
    """Return why there are no derivatives by any direction; nothing where there are some."""
    steps, reason = round(task["duration"] / task["dt"]), ""
    if kind != _TAPED:
        reason = f"{kind} is not differentiable, as Newton's table of its solvers says"
    elif len(task["bodies"]) > 1:
        reason = "reverse mode goes back once for each number of the final state: this adapter does it for one body"
    elif steps > MOST_TAPED:
        reason = f"to go back over {steps} steps takes a processor minutes"
    return [reason] * len(task["derivatives"]) if reason else []


def differentiated(wp: Any, task: Task, model: Any, solver: Any, begun: Any, body: int) -> list[Task | str]:
    """Return the derivatives of the final state of one body, by going back over all steps with Warp's tape."""
    states, control = [begun], model.control()
    with wp.Tape() as tape:
        for _ in range(round(task["duration"] / task["dt"])):
            contacts, following = model.contacts(), model.state()
            states[-1].clear_forces()
            model.collide(states[-1], contacts)
            solver.step(states[-1], following, control, contacts, task["dt"])
            states.append(following)
    able = [changes(direction) <= {"start", "gravity", "friction"} for direction in task["derivatives"]]
    found: list[dict[str, list[list[float]]]] = [{part: [[]] for part in END} for _ in able]
    for part, name, first in (
        ("position", "body_q", 0),
        ("velocity", "body_qd", 0),
        ("angular_velocity", "body_qd", 3),
    ):
        end = getattr(states[-1], name)
        for k in range(first, first + 3):
            one = end.numpy() * 0
            one[body, k] = 1.0
            tape.backward(grads={end: wp.array(one, dtype=end.dtype)})
            place, rate = begun.body_q.grad.numpy()[body], begun.body_qd.grad.numpy()[body]
            gravity, friction = model.gravity.grad.numpy()[0], model.shape_material_mu.grad.numpy()
            for slopes, told in zip(found, task["derivatives"], strict=True):
                start, (w, *turn) = told["bodies"][0], told["bodies"][0]["orientation"]
                slopes[part][0].append(
                    float(
                        place @ [*start["position"], *turn, w]
                        + rate @ [*start["velocity"], *start["angular_velocity"]]
                        + gravity @ told["gravity"]
                        + friction.sum() * told["friction"]
                    )
                )
            tape.zero()
    reason = "this adapter has no direction of it"
    return [slopes if can else reason for slopes, can in zip(found, able, strict=True)]


def _material(newton: Any, task: Task, friction: float) -> Any:
    """Return what a surface is like: nothing resists rolling and spinning."""
    own = task["setting"].get("material", {})
    return newton.ModelBuilder.ShapeConfig(
        density=0.0, mu=friction, restitution=task["restitution"], mu_rolling=0.0, mu_torsional=0.0, **own
    )


def _support(newton: Any, wp: Any, np: Any, builder: Any, task: Task) -> None:
    """Make the ground: of two coefficients of friction it takes the mean."""
    support = task["support"]
    material = _material(newton, task, task["friction"])
    if "mesh" in support:
        mesh = newton.Mesh(
            np.array(support["mesh"]["vertices"], dtype=np.float32),
            np.array(support["mesh"]["triangles"], dtype=np.int32).ravel(),
            compute_inertia=False,
            is_solid=False,
        )
        builder.add_shape_mesh(-1, mesh=mesh, cfg=material)
    elif support["kind"] == "dome":
        place = wp.transform(wp.vec3(0.0, 0.0, -support["radius"]), wp.quat_identity())
        builder.add_shape_sphere(-1, xform=place, radius=support["radius"], cfg=material)
    else:
        builder.add_ground_plane(cfg=material)


def _body(newton: Any, wp: Any, builder: Any, task: Task, told: Task, i: int) -> int:
    """Make a body that moves freely, its frame at the centre of mass."""
    shape, w = told["shape"], told["orientation"]
    place = wp.transform(wp.vec3(*told["position"]), wp.quat(w[1], w[2], w[3], w[0]))
    inertia = wp.mat33(*(x for row in told["inertia"] for x in row))
    body = builder.add_body(xform=place, mass=told["mass"], inertia=inertia, lock_inertia=True)
    own, pair = task["friction"], task["friction_between"]
    material = _material(newton, task, own if i == 0 else 2 * pair - own)
    frame = wp.transform(wp.vec3(*told["offset"]), wp.quat_identity())
    if shape["kind"] == "sphere":
        builder.add_shape_sphere(body, xform=frame, radius=shape["radius"], cfg=material)
    elif shape["kind"] == "box":
        hx, hy, hz = shape["half_widths"]
        builder.add_shape_box(body, xform=frame, hx=hx, hy=hy, hz=hz, cfg=material)
    elif shape["kind"] == "disc":
        builder.add_shape_cylinder(body, xform=frame, radius=shape["radius"], half_height=1e-4, cfg=material)
    else:
        raise CannotError(f"this adapter has no {shape['kind']}")
    return int(body)


def _start(newton: Any, model: Any, state: Any, task: Task, bodies: list[int]) -> None:
    """Set velocities, in both ways in which a state has them."""
    rates, spins = state.joint_qd.numpy(), state.body_qd.numpy()
    for k, (i, told) in enumerate(zip(bodies, task["bodies"], strict=True)):
        rates[6 * k : 6 * k + 6] = spins[i] = [*told["velocity"], *told["angular_velocity"]]
    state.joint_qd.assign(rates)
    newton.eval_fk(model, state.joint_q, state.joint_qd, state)
    state.body_qd.assign(spins)


if __name__ == "__main__":
    serve(run)
