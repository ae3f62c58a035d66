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
    able = [changes(direction) <= {"start", "gravity", "friction"} for direction in directions]
    body, kind = task["bodies"][0], state.qpos.dtype
    slopes = [direction["bodies"][0] for direction in directions]
    spins = []  # of the angular velocity in the axes of the body
    for slope in slopes:
        half = times([body["orientation"][0], *(-x for x in body["orientation"][1:])], slope["orientation"])[1:]
        across = cross(backwards(body["orientation"], body["angular_velocity"]), [2 * x for x in half])
        own = backwards(body["orientation"], slope["angular_velocity"])
        spins.append([a + b for a, b in zip(own, across, strict=True)])
    along = {
        "qpos": jnp.array([[*slope["position"], *slope["orientation"]] for slope in slopes], kind),
        "qvel": jnp.array([[*slope["velocity"], *spin] for slope, spin in zip(slopes, spins, strict=True)], kind),
        "gravity": jnp.array([direction["gravity"] for direction in directions], kind),
        "friction": jnp.array([[direction["friction"]] * 2 + [0.0] * 3 for direction in directions], kind),
    }
    count = round(task["duration"] / task["dt"])

    def end(by: Any) -> Any:
        """Return the final state by how far the start lies along each direction."""
        moved = {key: jnp.tensordot(by, part, 1) for key, part in along.items()}
        gravity, friction = world.opt.gravity + moved["gravity"], world.pair_friction + moved["friction"]
        model = world.tree_replace({"opt.gravity": gravity, "pair_friction": friction})
        begun = state.replace(qpos=state.qpos + moved["qpos"], qvel=state.qvel + moved["qvel"])
        last = jax.lax.fori_loop(0, count, lambda _, now: mjx.step(model, now), begun)
        w, u = last.qpos[3], last.qpos[4:7]
        spin = last.qvel[3:6]
        spin = spin + 2 * jnp.cross(u, jnp.cross(u, spin) + w * spin)
        return jnp.concatenate([last.qpos[:3], last.qvel[:3], spin])

    found: dict[str, list[Any]] = {}
    for way, mode in (("forward mode", jax.jacfwd), ("reverse mode", jax.jacrev)):
        try:
            columns = np.asarray(jax.jit(mode(end))(jnp.zeros(len(directions), kind)), dtype=float).T
            parts = [dict(zip(END, ([part.tolist()] for part in np.split(one, 3)), strict=True)) for one in columns]
            reason = "this adapter has no direction of it"
            found[way] = [part if can else reason for part, can in zip(parts, able, strict=True)]
        except (TypeError, ValueError, NotImplementedError) as error:
            found[way] = [f"{type(error).__name__}: {error}"] * len(directions)
    return found


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
