"""ODE, the Open Dynamics Engine, by the module that Panda3D has of it; its interface is of single precision."""

from __future__ import annotations

from typing import Any

from .serving import CannotError, Task, march, refuse, serve

_MOST_CONTACTS = 16  # of a pair
_STILL = 1e-5  # m/s, below which the direction of slipping is rounding


def run(task: Task) -> Task:
    """Answer one task."""
    setting = task["setting"]
    core, ode, engine = _library(task, double=setting.get("double", False))
    refuse(
        task,
        {
            "ellipsoid": "it has no ellipsoid",
            "driven": "it has no body of prescribed velocity",
        },
    )
    world = ode.OdeWorld()
    world.setGravity(*task["gravity"])
    for name, value in setting.get("world", {}).items():
        getattr(world, f"set{name}")(value)
    ground, table, hinge = _support(core, ode, world, task)
    made = [_body(core, ode, world, body) for body in task["bodies"]]
    pairs = [(made[0], (ground, table), task["friction"])]
    pairs += [(each, made[0], task["friction_between"]) for each in made[1:]]
    along = setting.get("pyramid") == "along the slip"
    surfaces = [_surface(ode, friction, task["restitution"], along) for *_, friction in pairs]
    forces = [core.LVector3f(*told["force"]) for told in task["bodies"]]
    pushed = [(body, told["force"]) for (_, body), told in zip(made, task["bodies"], strict=True) if any(told["force"])]
    group, advance = ode.OdeJointGroup(), world.step if setting.get("solver") == "step" else world.quickStep

    def step(count: int) -> None:
        """Take steps: contacts are made anew for each, and a force lasts for one."""
        for _ in range(count):
            for ((geom, body), (other, under), _mu), surface, force in zip(pairs, surfaces, forces, strict=True):
                met = ode.OdeUtil.collide(geom, other, _MOST_CONTACTS)
                for i in range(met.getNumContacts()):
                    contact = ode.OdeContact()
                    contact.setGeom(met.getContactGeom(i))
                    if along:
                        _turn(contact, surface, body, under, force)
                    contact.setSurface(surface)
                    joint = ode.OdeContactJoint(world, group, contact)
                    # Which of the two the normal points to is that of the entry.
                    joint.attach(body, under) if under is not None else joint.attachBody(body, 0)
            for body, force in pushed:
                body.addForce(*force)
            advance(task["dt"])
            group.empty()

    def read() -> list[Any]:
        """Return the state of each body: its frame is at the centre of mass."""
        return [
            (body.getPosition(), body.getQuaternion(), body.getLinearVel(), body.getAngularVel()) for _, body in made
        ]

    turn = None if hinge is None else lambda: (hinge.getAngle(), table.getAngularVel()[2])
    return march(task, engine, step, read, turn)


def _library(task: Task, *, double: bool) -> tuple[Any, Any, str]:
    """Return what has vectors, what has ODE, and its name."""
    if double:
        if "mesh" in task["support"]:
            raise CannotError("this adapter has no triangles in double precision")
        from . import ode_in_double

        return ode_in_double.core, ode_in_double.ode, "ODE (of dartpy's wheel)"
    from panda3d import core, ode

    return core, ode, f"ODE (Panda3D {core.PandaSystem.getVersionString()})"


def _turn(contact: Any, surface: Any, body: Any, under: Any, force: Any) -> None:
    """Turn the pyramid of friction to where the body slips, or is pushed; what slips has no friction across."""
    met = contact.getGeom()
    place, normal = met.getPos(), met.getNormal()
    slip = body.getPointVel(place) - (under.getPointVel(place) if under is not None else normal.zero())
    ways = (way - normal * way.dot(normal) for way in (slip, force, normal.unitX(), normal.unitY()))
    along = next(way for way in ways if way.length() > _STILL)
    along.normalize()
    contact.setFdir1(along)
    # Across, it would hold back each turn of the slip with all of its strength.
    surface.setMu2(0.0 if slip.length() > _STILL else surface.getMu())


def _surface(ode: Any, friction: float, restitution: float, along: bool) -> Any:
    """Return how two surfaces meet: with a pyramid of friction, which is what it has."""
    surface = ode.OdeSurfaceParameters()
    mode = ode.OdeSurfaceParameters.MFContactApprox1
    if along:
        mode |= ode.OdeSurfaceParameters.MFContactFDir1 | ode.OdeSurfaceParameters.MFContactMu2
    surface.setMu(friction)
    if restitution:
        mode |= ode.OdeSurfaceParameters.MFContactBounce
        surface.setBounce(restitution)
        surface.setBounceVel(0.0)
    surface.setMode(mode)
    return surface


def _support(core: Any, ode: Any, world: Any, task: Task) -> tuple[Any, Any, Any]:
    """Make the ground; return its shape, and the body and the joint of a table on a hinge."""
    support, motion = task["support"], task["support"]["motion"]
    if "mesh" in support:
        return ode.OdeTriMeshGeom(ode.OdeTriMeshData(_mesh(core, support["mesh"]), True)), None, None
    if support["kind"] == "dome":
        ball = ode.OdeSphereGeom(support["radius"])
        ball.setPosition(0.0, 0.0, -support["radius"])
        return ball, None, None
    if motion["kind"] == "fixed":
        return ode.OdePlaneGeom(0.0, 0.0, 1.0, 0.0), None, None
    box, table, mass, hinge = ode.OdeBoxGeom(100.0, 100.0, 1.0), ode.OdeBody(world), ode.OdeMass(), None
    mass.setParameters(1.0, 0.0, 0.0, 0.0, 1.0, 1.0, motion["inertia"], 0.0, 0.0, 0.0)
    table.setMass(mass)
    box.setBody(table)
    box.setOffsetPosition(0.0, 0.0, -0.5)
    hinge = ode.OdeHingeJoint(world)
    hinge.attach(table, None)
    hinge.setAnchor(0.0, 0.0, 0.0)
    hinge.setAxis(0.0, 0.0, 1.0)
    table.setAngularVel(0.0, 0.0, motion["rate"])
    return box, table, hinge


def _mesh(core: Any, mesh: Task) -> Any:
    """Return a node with these triangles."""
    data = core.GeomVertexData("bowl", core.GeomVertexFormat.getV3(), core.Geom.UHStatic)
    writer = core.GeomVertexWriter(data, "vertex")
    for vertex in mesh["vertices"]:
        writer.addData3(*vertex)
    triangles = core.GeomTriangles(core.Geom.UHStatic)
    for corners in mesh["triangles"]:
        triangles.addVertices(*corners)
    geom = core.Geom(data)
    geom.addPrimitive(triangles)
    node = core.GeomNode("bowl")
    node.addGeom(geom)
    return core.NodePath(node)


def _body(core: Any, ode: Any, world: Any, told: Task) -> tuple[Any, Any]:
    """Make a body, its frame at the centre of mass; return its shape and itself."""
    shape = told["shape"]
    kinds = {
        "sphere": lambda: ode.OdeSphereGeom(shape["radius"]),
        "box": lambda: ode.OdeBoxGeom(*(2 * half for half in shape["half_widths"])),
        "disc": lambda: ode.OdeCylinderGeom(shape["radius"], 2e-4),
    }
    if shape["kind"] not in kinds:
        raise CannotError(f"this adapter has no {shape['kind']}")
    geom, body, mass = kinds[shape["kind"]](), ode.OdeBody(world), ode.OdeMass()
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = told["inertia"]
    mass.setParameters(told["mass"], 0.0, 0.0, 0.0, xx, yy, zz, xy, xz, yz)
    body.setMass(mass)
    geom.setBody(body)
    if any(told["offset"]):
        geom.setOffsetPosition(*told["offset"])
    body.setPosition(*told["position"])
    body.setQuaternion(core.LQuaternionf(*told["orientation"]))
    body.setLinearVel(*told["velocity"])
    body.setAngularVel(*told["angular_velocity"])
    return geom, body


if __name__ == "__main__":
    serve(run)
