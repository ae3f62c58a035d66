"""Methods that turn a system and a start into states at given times: closed forms, Taylor series, Runge-Kutta."""
