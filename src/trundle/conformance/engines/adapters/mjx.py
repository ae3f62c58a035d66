"""MJX: MuJoCo's models in JAX; the model is that of the adapter for MuJoCo."""

from __future__ import annotations

from functools import cache
from typing import Any

from .mujoco import model, settled
from .serving import END, Task, backwards, changes, cross, march, refuse, serve, times, turned


def run(task: Task) -> Task:
    """Answer one task."""
    import jax

    jax.config.update("jax_platforms", "cpu")
    double = bool(task["setting"].get("double", False))
    jax.config.update("jax_enable_x64", double)
    import mujoco
    from mujoco import mjx

    refuse(
        task,
        {
            "restitution": "it has no coefficient of restitution: contacts are damped springs",
            "driven": "it has no body of prescribed velocity that contacts know of",
            "mesh": "it takes a piece for each triangle, and to compile 406 of them takes it minutes",
            "hinge": "it has no collision of a moving table and a ball: planes may not move, and MJX has no pair of a"
            " cylinder and a sphere",
        },
    )
    described = mujoco.MjModel.from_xml_string(model(task))
    data = mujoco.MjData(described)
    heights = settled(mujoco, task)
    for i, body in enumerate(task["bodies"]):
        x, y, z = body["position"]
        joint = data.joint(f"b{i}")
        joint.qpos = [x, y, z if heights is None else heights[i], *body["orientation"]]
        joint.qvel = [*body["velocity"], *backwards(body["orientation"], body["angular_velocity"])]
        data.xfrc_applied[described.body(f"b{i}").id, :3] = body["force"]
    world, state = mjx.put_model(described), [mjx.put_data(described, data)]
    # In double precision a step returns longer integers than it was given.
    wanted = jax.eval_shape(mjx.step, world, state[0])
    state[0] = jax.tree.map(lambda x, like: x.astype(like.dtype), state[0], wanted)
    begun = state[0]
    steps = _steps(double)
    jax.block_until_ready(steps(world, state[0], 1))  # compiled before anything is timed

    def step(count: int) -> None:
        """Take steps."""
        state[0] = jax.block_until_ready(steps(world, state[0], count))

    def read() -> list[Any]:
        """Return the state of each body, the angular velocity turned to space axes."""
        q, v = state[0].qpos.tolist(), state[0].qvel.tolist()
        starts = range(len(task["bodies"]))
        rows = [(q[7 * i : 7 * i + 7], v[6 * i : 6 * i + 6]) for i in starts]
        return [(p[:3], p[3:], w[:3], turned(p[3:], w[3:])) for p, w in rows]

    answer = march(task, f"MJX {_version()}", step, read)
    if "derivatives" in task:
        answer["derivatives"] = differentiated(task, world, begun)
    return answer


def differentiated(task: Task, world: Any, state: Any) -> dict[str, list[Any]]:
    """Return the derivatives of the final state, in forward and in reverse mode."""
    import jax
    import numpy as np
    from jax import numpy as jnp
    from mujoco import mjx

    directions = task["derivatives"]
    able = [changes(direction) <= {"start", "gravity", "friction", "force"} for direction in directions]
    count, kind = len(task["bodies"]), state.qpos.dtype
    rows = [[_tangent(*pair) for pair in zip(task["bodies"], one["bodies"], strict=True)] for one in directions]
    tangents = np.array(rows)  # directions, bodies, 13
    forces = np.zeros((len(directions), *state.xfrc_applied.shape))
    forces[:, -count:, :3] = [[body["force"] for body in one["bodies"]] for one in directions]
    # The first pair is that of the first body and the ground, the others those of the others and it.
    rough = np.zeros((len(directions), *world.pair_friction.shape))
    rough[:, 0, :2] = [[one["friction"]] * 2 for one in directions]
    rough[:, 1:, :2] = np.array([one["friction_between"] for one in directions])[:, None, None]
    along = {
        "qpos": jnp.array(tangents[:, :, :7].reshape(len(directions), -1), kind),
        "qvel": jnp.array(tangents[:, :, 7:].reshape(len(directions), -1), kind),
        "gravity": jnp.array([direction["gravity"] for direction in directions], kind),
        "friction": jnp.array(rough, kind),
        "force": jnp.array(forces, kind),
    }
    steps = round(task["duration"] / task["dt"])

    def end(by: Any, world: Any) -> Any:
        """Return the final state by how far the start lies along each direction."""
        moved = {key: jnp.tensordot(by, part, 1) for key, part in along.items()}
        gravity, friction = world.opt.gravity + moved["gravity"], world.pair_friction + moved["friction"]
        model = world.tree_replace({"opt.gravity": gravity, "pair_friction": friction})
        begun = state.replace(
            qpos=state.qpos + moved["qpos"],
            qvel=state.qvel + moved["qvel"],
            xfrc_applied=state.xfrc_applied + moved["force"],
        )
        last = jax.lax.fori_loop(0, steps, lambda _, now: mjx.step(model, now), begun)
        places, rates = last.qpos.reshape(count, 7), last.qvel.reshape(count, 6)
        w, u, spin = places[:, 3:4], places[:, 4:], rates[:, 3:]
        spin = spin + 2 * jnp.cross(u, jnp.cross(u, spin) + w * spin)
        return jnp.stack([places[:, :3], rates[:, :3], spin])

    once = world.tree_replace({"opt.iterations": 1})
    found: dict[str, list[Any]] = {}
    # With more iterations than one its solver is a loop that JAX has no reverse mode of.
    for way, mode, chosen in (
        ("forward mode", jax.jacfwd, world),
        ("reverse mode", jax.jacrev, world),
        ("reverse mode, one iteration of the solver", jax.jacrev, once),
    ):
        try:
            at = jnp.zeros(len(directions), kind)
            columns = np.asarray(jax.jit(lambda by, mode=mode, chosen=chosen: mode(end)(by, chosen))(at), dtype=float)
            parts = [dict(zip(END, columns[..., j].tolist(), strict=True)) for j in range(len(directions))]
            reason = "this adapter has no direction of it"
            found[way] = [part if can else reason for part, can in zip(parts, able, strict=True)]
        except (TypeError, ValueError, NotImplementedError) as error:
            found[way] = [f"{type(error).__name__}: {error}"] * len(directions)
    return found


def _tangent(body: Task, slope: Task) -> list[float]:
    """Return how qpos and qvel of a body change: angular velocities are in its axes."""
    q = body["orientation"]
    half = times([q[0], *(-x for x in q[1:])], slope["orientation"])[1:]
    across = cross(backwards(q, body["angular_velocity"]), [2 * x for x in half])
    spin = [a + b for a, b in zip(backwards(q, slope["angular_velocity"]), across, strict=True)]
    return [*slope["position"], *slope["orientation"], *slope["velocity"], *spin]


@cache
def _steps(double: bool) -> Any:  # noqa: ARG001  one for each precision
    """Return what takes many steps: compiled once for models that differ in numbers only."""
    import jax
    from mujoco import mjx

    @jax.jit
    def steps(world: Any, state: Any, count: Any) -> Any:
        """Take steps of a model."""
        return jax.lax.fori_loop(0, count, lambda _, now: mjx.step(world, now), state)

    return steps


def _version() -> str:
    """Return the version of the package."""
    from importlib.metadata import version

    return version("mujoco-mjx")


if __name__ == "__main__":
    serve(run)
