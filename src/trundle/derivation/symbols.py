"""The symbols of the derivations, as in docs/conventions.md, and what each means."""

from __future__ import annotations

import sympy as sp

from .vectors import vector

a, m, k, g, c, I = sp.symbols("a m k g c I", positive=True)
omega, alpha, x, y, kappa, gamma = sp.symbols("omega alpha x y kappa gamma", real=True)
F_XYZ = sp.symbols("F_x F_y F_z", real=True)
K_XYZ = sp.symbols("K_x K_y K_z", real=True)
V_XY = sp.symbols("V_x V_y", real=True)
VDOT_XY = sp.symbols("Vdot_x Vdot_y", real=True)
R_XYZ = sp.symbols("R_x R_y R_z", real=True)
OMEGA_XYZ = sp.symbols("Omega_x Omega_y Omega_z", real=True)
OMEGADOT_XYZ = sp.symbols("Omegadot_x Omegadot_y Omegadot_z", real=True)
x_0, y_0, Vx_0, Vy_0, Omega_z0 = sp.symbols("x_0 y_0 V_x0 V_y0 Omega_z0", real=True)
zeta, zetadot, zetaddot, zeta_0, zetadot_0, zeta_c = sp.symbols("zeta zetadot zetaddot zeta_0 zetadot_0 zeta_c")
varphi, v_d, v_infinity, lam = sp.symbols("varphi v_d v_oo lambda")
varrho = sp.Symbol("varrho", real=True)
TIME = sp.Symbol("t", real=True)

n, r, V, Vdot, Omega, Omegadot, R, F, K, Z, e_x = map(
    vector, ("nhat", "r", "V", "Vdot", "Omega", "Omegadot", "R", "F", "K", "zhat", "ehat_x")
)
p, rho, rhodot, u, udot, rdot = map(vector, ("p", "rho", "rhodot", "u", "udot", "rdot"))

MEANINGS = {
    m: ("mass of the body", "kg"),
    a: ("radius of the body", "m"),
    I: ("its moment of inertia about the centre", "kg m²"),
    k: ("I/(m a²): 2/5 for a solid ball, 2/3 for a thin shell", "1"),
    g: ("acceleration of free fall", "m/s²"),
    alpha: ("tilt: the angle between the normal and the vertical", "rad"),
    omega: ("rate at which the support turns about its axis", "rad/s"),
    c: ("coefficient of linear drag", "kg/s"),
    n: ("unit normal, from the support into the body", "1"),
    Z: ("unit vector vertically up", "1"),
    e_x: ("unit vector down the slope", "1"),
    r: ("centre of the body, from the axis", "m"),
    p: ("contact point", "m"),
    rho: ("from the centre of mass to the contact", "m"),
    u: ("velocity of the support's material at the contact", "m/s"),
    V: ("velocity of the centre", "m/s"),
    Omega: ("angular velocity of the body", "rad/s"),
    R: ("force of the support on the body, at the contact", "N"),
    F: ("applied force", "N"),
    K: ("applied torque about the centre", "N m"),
    kappa: ("rate of the circle", "rad/s"),
    gamma: ("rate at which drag slows the body", "1/s"),
    varphi: ("acceleration that the loads give, as a complex number", "m/s²"),
}
