"""Is the motion regular? Sections, Lyapunov exponents, periodic orbits."""
