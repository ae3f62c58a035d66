"""The laws of the phases of contact as the numerical methods take them, one file a phase."""

from .flight import FlightLaw
from .friction import CONE_SLACK, cone, left_of_resistance
from .law import AN_INSTANT, CONTACT, CORNER, Law, Numbers, Rates, state_turning
from .resting import Held, RestingLaw
from .rolling import RollingLaw, RollingWithResistance
from .slipping import JAMS, SlidingFreely, SlippingLaw

__all__ = [
    "AN_INSTANT",
    "CONE_SLACK",
    "CONTACT",
    "CORNER",
    "JAMS",
    "FlightLaw",
    "Held",
    "Law",
    "Numbers",
    "Rates",
    "RestingLaw",
    "RollingLaw",
    "RollingWithResistance",
    "SlidingFreely",
    "SlippingLaw",
    "cone",
    "left_of_resistance",
    "state_turning",
]
