"""trundle itself, from the same task as the others: its row shows what the task and the protocol keep of a motion."""

from __future__ import annotations

from typing import Any

from .serving import PARTS, CannotError, Task, serve


def run(task: Task) -> Task:
    """Answer one task; the step does not matter to it."""
    import time

    import trundle as tr

    if len(task["bodies"]) > 1:
        raise CannotError("it has one body on one support")
    system, body = system_of(tr, task), task["bodies"][0]
    motion = task["support"]["motion"]
    own = (0.0, motion["rate"]) if motion["kind"] == "hinge" else ()
    start = tr.State(
        position=tuple(body["position"]),
        velocity=tuple(body["velocity"]),
        angular_velocity=tuple(body["angular_velocity"]),
        orientation=tuple(body["orientation"]),
        support=own,
    )
    method = task["setting"].get("method", "auto")
    began = time.process_time()
    tolerance = task["setting"].get("tolerance")
    data = tr.simulate(system, start, task["duration"], task["every"], method, tolerance=tolerance).data
    spent = time.process_time() - began
    count = round(task["duration"] / task["every"]) + 1
    data = data.sel(time=[i * task["every"] for i in range(count)], method="nearest")
    answer: Task = {"engine": f"trundle {tr.__version__}", "seconds": spent, "time": data.time.values.tolist()}
    answer |= {part: data[part].values[:, None, :].tolist() for part in PARTS}
    if own:
        answer["support"] = [list(row) for row in zip(data.support_angle.values, data.support_rate.values, strict=True)]
    return answer


def system_of(tr: Any, task: Task) -> Any:
    """Read the system back from the task."""
    from trundle.mechanics.algebra import Vector
    from trundle.mechanics.bodies.inertia import inertia_of

    told, support, motion = task["bodies"][0], task["support"], task["support"]["motion"]
    shape, offset = told["shape"], Vector(*told["offset"]) if any(told["offset"]) else None
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = told["inertia"]
    if shape["kind"] == "sphere":
        form = tr.Sphere(shape["radius"], offset)
    elif shape["kind"] == "disc":
        form = tr.Disc(shape["radius"], offset)
    else:
        form = tr.Ellipsoid(*shape["semi_axes"], offset)
    inertia = tr.Isotropic(xx) if xx == yy == zz and not offset else inertia_of((xx, yy, zz), (xy, xz, yz))
    body = tr.Body(mass=told["mass"], inertia=inertia, shape=form)
    surface = tr.Plane() if support["kind"] == "plane" else tr.Dome(support["radius"])
    moves = {
        "fixed": tr.Fixed,
        "driven": lambda: tr.Spin(motion["rate"]),
        "hinge": lambda: tr.FreeAxle(motion["inertia"], motion["rate"]),
    }[motion["kind"]]()
    gx, _, gz = task["gravity"]
    import math

    ground = tr.Support(surface, moves, math.atan2(gx, -gz), task["friction"], restitution=task["restitution"])
    return tr.RollingSystem(body, ground, gravity=math.hypot(gx, gz))


if __name__ == "__main__":
    serve(run)
