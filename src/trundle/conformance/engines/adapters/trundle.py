"""trundle itself, from the same task as the others: its row shows what the task and the protocol keep of a motion."""

from __future__ import annotations

from typing import Any

from .serving import END, PARTS, CannotError, Task, serve


def run(task: Task) -> Task:
    """Answer one task; the step does not matter to it."""
    import time

    import trundle as tr

    if len(task["bodies"]) > 1:
        raise CannotError("it has one body on one support")
    if "mesh" in task["support"]:
        raise CannotError("it rolls on smooth surfaces, such as the bowl that the triangles stand for")
    system = system_of(tr, task)
    start = start_of(tr, task)
    method = task["setting"].get("method", "auto")
    began = time.process_time()
    tolerance = task["setting"].get("tolerance")
    data = tr.simulate(system, start, task["duration"], task["every"], method, tolerance=tolerance).data
    spent = time.process_time() - began
    count = round(task["duration"] / task["every"]) + 1
    data = data.sel(time=[i * task["every"] for i in range(count)], method="nearest")
    answer: Task = {"engine": f"trundle {tr.__version__}", "seconds": spent, "time": data.time.values.tolist()}
    answer |= {part: data[part].values[:, None, :].tolist() for part in PARTS}
    if "support_rate" in data:
        answer["support"] = [list(row) for row in zip(data.support_angle.values, data.support_rate.values, strict=True)]
    if "derivatives" in task:
        answer["derivatives"] = {"variational equations": derivatives(tr, task)}
    return answer


def derivatives(tr: Any, task: Task) -> list[Task]:
    """Return the derivatives of the final state along each direction, by the variational equations."""
    import numpy as np

    from trundle.analysis.sensitivities.following import follow
    from trundle.mechanics.duals import Dual

    directions = task["derivatives"]

    def dual(value: Any, *slopes: Any) -> Any:
        """Put a dual in the place of each number that has a slope."""
        if isinstance(value, dict):
            return {key: dual(part, *(each[key] for each in slopes)) for key, part in value.items() if key in slopes[0]}
        if isinstance(value, list):
            return [dual(*parts) for parts in zip(value, *slopes, strict=True)]
        return Dual(value, tuple(slopes)) if any(isinstance(each, float) and each for each in slopes) else value

    in_duals = dual(task, *directions)
    both = [(system_of(tr, told), start_of(tr, told)) for told in (task, in_duals)]
    names = [each["by"] for each in directions]
    slopes = follow(*both[0], np.array([0.0, task["duration"]]), both[1], names, of_motion=True).slopes
    return [{part: [slopes[part][-1, :, j].tolist()] for part in END} for j in range(len(names))]


def start_of(tr: Any, task: Task) -> Any:
    """Read the start back from the task."""
    body, motion = task["bodies"][0], task["support"]["motion"]
    own = (0.0, motion["rate"]) if motion["kind"] == "hinge" else ()
    return tr.State(**{part: tuple(body[part]) for part in PARTS}, support=own)


def system_of(tr: Any, task: Task) -> Any:
    """Read the system back from the task."""
    from trundle.mechanics.algebra import Vector
    from trundle.mechanics.bodies.inertia import inertia_of
    from trundle.mechanics.scalars import namespace

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
    xp = namespace(gx, gz)
    ground = tr.Support(surface, moves, xp.atan2(gx, -gz), task["friction"], restitution=task["restitution"])
    return tr.RollingSystem(body, ground, gravity=xp.hypot(gx, gz))


if __name__ == "__main__":
    serve(run)
