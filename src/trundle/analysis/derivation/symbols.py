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
p, pdot, rho, rhodot, u, udot, rdot = map(vector, ("p", "pdot", "rho", "rhodot", "u", "udot", "rdot"))

b, ell, G, lam_0 = sp.symbols("b ell G lambda_0", positive=True)
theta, thetadot, thetaddot, phi = sp.symbols("theta thetadot thetaddot phi", real=True)
theta_0, thetadot_0, period = sp.symbols("theta_0 thetadot_0 T")
N, R_theta, par = sp.symbols("N R_theta mu", real=True)
e_z, e_r, e_theta = map(vector, ("ehat_z", "ehat_r", "ehat_theta"))

MEANINGS = {
    m: ("mass of the body", "kg"),
    a: ("radius of the body", "m"),
    I: ("its moment of inertia about the centre", "kg m²"),
    k: ("I/(m a²), 2/5 solid ball, 2/3 thin shell, 1/2 solid cylinder, 1 hoop", "1"),
    b: ("radius of the cylinder that it rolls on", "m"),
    ell: ("distance of its centre from that cylinder's axis", "m"),
    theta: ("angle of its centre about that axis, from the lowest line", "rad"),
    theta_0: ("angle of its centre at the start, from the lowest line", "rad"),
    thetadot_0: ("rate at which its centre goes round at the start", "rad/s"),
    lam_0: ("rate of small swings", "1/s"),
    period: ("time of one swing, or of once round", "s"),
    phi: ("angle by which the body has turned", "rad"),
    g: ("acceleration of free fall", "m/s²"),
    alpha: ("tilt: the angle between the normal and the vertical", "rad"),
    omega: ("rate at which the support turns about its axis", "rad/s"),
    c: ("coefficient of linear drag", "kg/s"),
    n: ("unit normal, from the support into the body", "1"),
    Z: ("unit vector vertically up", "1"),
    e_x: ("unit vector along the first axis", "1"),
    e_z: ("unit vector along the third axis", "1"),
    e_r: ("unit vector from the axis to the centre", "1"),
    e_theta: ("unit vector along the track", "1"),
    r: ("centre of the body, from the axis", "m"),
    p: ("contact point", "m"),
    rho: ("from the centre of mass to the contact", "m"),
    u: ("velocity of the support's material at the contact", "m/s"),
    V: ("velocity of the centre", "m/s"),
    Omega: ("angular velocity of the body", "rad/s"),
    R: ("force of the support on the body, at the contact", "N"),
    F: ("applied force", "N"),
    G: ("pull across the axis, weight included", "N"),
    N: ("force that presses body and support together", "N"),
    R_theta: ("force along the track, that rolling takes", "N"),
    par: ("parameter of Jacobi's functions", "1"),
    K: ("applied torque about the centre", "N m"),
    kappa: ("rate of the circle", "rad/s"),
    gamma: ("rate at which drag slows the body", "1/s"),
    varphi: ("acceleration that the loads give, as a complex number", "m/s²"),
    v_d: ("velocity at which the circle drifts, as a complex number", "m/s"),
    varrho: ("radius of the circle", "m"),
}
