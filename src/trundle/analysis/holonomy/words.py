"""What is said of each shipped system besides its equations."""

from __future__ import annotations

from .system import Telling

EULER_NOTE = "Where sin θ = 0 the angles φ and ψ turn about the same axis: a failure of the angles, not of the body."
_EULER = "x, y of the centre; Euler angles φ about the vertical, θ of the pole from it, ψ about the pole; radius a"
_SQUARE = (
    "Roll round a small square of side s, first along x and then along y, and it comes back turned: by s²/a² about "
    "the vertical, clockwise seen from above."
)

TELLINGS = {
    "cylinder": Telling(
        coordinates="x of the axis, φ how far it has turned; radius a",
        verdict="The position gives the angle: if we measure x, we know φ. One of the two can be left out of the "
        "dynamics.",
    ),
    "cylinder-in-cylinder": Telling(
        coordinates="θ of the line of centres from the lowest point, φ how far the inner one has turned; radii a < b",
        verdict="The same as on a plane, with (b − a)θ for x: the position gives the angle.",
    ),
    "sphere": Telling(
        coordinates=_EULER,
        verdict="Position does not give orientation: we would have to know the rolling history, and the pole need not "
        "be on top when the ball is back where it began.",
        brackets={
            "[roll along x, roll along y]": f"{_SQUARE} It has pivoted, though it only rolled.",
            "[roll along x, pivot]": "Roll by s along x, pivot by ε, roll back, pivot back: it is home again, turned "
            "by sε/a about the line that it rolled along.",
            "[roll along y, pivot]": "The same along y turns it about the other level axis: every orientation at every "
            "place.",
        },
        also=(("roll along x", "roll along y"),),
        chart=EULER_NOTE,
    ),
    "sphere-no-pivot": Telling(
        coordinates=_EULER,
        verdict="Even if it never pivots, rolling alone reaches every orientation at every place: loops within loops "
        "do it.",
        brackets={
            "[roll along x, roll along y]": f"{_SQUARE} It may not pivot, and yet it has.",
            "[roll along x, [roll along x, roll along y]]": "Roll on by s, go round the square, back by s, round the "
            "square the other way: turned by s³/a³ about the line along x.",
            "[roll along y, [roll along x, roll along y]]": "The same along y: a turn about the other level axis.",
        },
        chart=EULER_NOTE,
    ),
    "sphere-on-turntable": Telling(
        coordinates=f"{_EULER}; the time t counts as a coordinate, since the plane turns at the rate ω",
        verdict="A turning plane changes nothing of it: no function stays constant, be the time in it or not.",
        chart=EULER_NOTE,
    ),
    "coin": Telling(
        coordinates="x, y of the centre, φ its heading, ψ how far it has rolled; radius a",
        verdict="It can be brought to any place, with any heading and any side up.",
        brackets={
            "[roll, turn]": "Roll, turn, roll back, turn back: it has moved sideways, the way it cannot roll.",
            "[turn, [roll, turn]]": "The same in two headings, one undone: it has moved along its heading without "
            "having rolled.",
        },
    ),
    "disc": Telling(
        coordinates="x, y of the centre; φ its heading, θ its lean (upright at π/2), ψ how far it has rolled; radius a",
        verdict="The height of the centre, a sin θ, follows from the lean; nothing else follows from anything.",
        brackets={"[roll, turn]": "Roll, turn, roll back, turn back: it has moved sideways, as the upright coin does."},
        chart=EULER_NOTE,
    ),
    "skate": Telling(
        coordinates="x, y of the blade, φ its heading",
        verdict="It cannot slide sideways, and yet gets anywhere with any heading, as every parked car has.",
        brackets={"[glide, turn]": "Glide, turn, glide back, turn back: it has moved sideways."},
    ),
    "car": Telling(
        coordinates="x, y of the rear axle, θ heading, δ angle of the front wheels; l between the axles",
        verdict="It parks anywhere, by driving and steering to and fro.",
        brackets={
            "[drive, steer]": "Drive, steer, drive back, steer back: its heading has changed.",
            "[drive, [drive, steer]]": "That once ahead, and undone behind: it has moved sideways.",
        },
    ),
    "trailers": Telling(
        coordinates="x, y and heading θ of the last trailer; angles δ₂ between the trailers, δ₁ between tractor and "
        "first trailer; hitches of length 1",
        verdict="It can be brought anywhere with any angles. With the tractor at a right angle that takes one bracket "
        "more.",
    ),
    "cart": Telling(
        coordinates="x, y of the axle's middle, θ heading, φ₁ and φ₂ turns of left and right wheel; radius a, axle 2b",
        verdict="The wheels' turns give the heading, but not the place: an odometer knows which way the cart points, "
        "and must be told where it is.",
    ),
    "disguised": Telling(
        coordinates="x, y, z of a point",
        verdict="The form is no differential, and becomes one after division: the point stays on one paraboloid.",
    ),
}
