"""MJX: MuJoCo's models in JAX; the model is that of the adapter for MuJoCo."""

from __future__ import annotations

from functools import cache
from typing import Any

from .mujoco import model, settled
from .serving import Task, backwards, march, refuse, serve, turned


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

    return march(task, f"MJX {_version()}", step, read)


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
