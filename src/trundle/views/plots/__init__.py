"""Figures of a run: its path in the frames that matter, and its time series. matplotlib loads on use."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from trundle.simulation.trajectory import Trajectory

__all__ = ["path_figure", "series_figure"]


def path_figure(run: Trajectory) -> Figure:
    """Draw the path of the body's centre, seen from above, in each frame that tells something new.

    One sheet: the support frame; the world frame with the height above the start where the support is tilted;
    the corotating frame where it turns. On a tilted support the page is turned so that downhill is down.

    Parameters
    ----------
    run : Trajectory
        What to draw, in any frame; lengths of every magnitude choose their own unit. Of more than half a million
        samples only as many are drawn as the lines need.

    Returns
    -------
    matplotlib.figure.Figure
        Needs neither a display nor pyplot: save it with ``savefig``, or end a notebook cell with it.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("tilted-turntable").run()
    >>> [panel.get_title(loc="left") for panel in path_figure(run).axes]
    ['Support frame', 'World frame, from above', '', 'Corotating frame']
    """
    from .fewer import fewer
    from .path import draw

    return draw(fewer(run))


def series_figure(run: Trajectory) -> Figure:
    """Draw position, speed, angular velocity, contact force and friction needed against time.

    A support that is tilted adds the height above the start. A run of many turns is shown twice on the same
    scale: its first turns, and the whole.

    Parameters
    ----------
    run : Trajectory
        What to draw, in any frame; the series are those of the support frame. Of more than half a million samples
        only as many are drawn as the lines need.

    Returns
    -------
    matplotlib.figure.Figure
        Needs neither a display nor pyplot.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("tilted-turntable").run()
    >>> series_figure(run).axes[0].get_ylabel()
    'position (cm)'
    """
    from .fewer import fewer
    from .series import draw

    return draw(fewer(run))
