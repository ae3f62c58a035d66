"""What every run can do to be looked at: in a line, as a table, as a widget, as a page, as a model."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from ...display import Displayed, Headline, Markup, fold, joined, mathml, number, pairs, paragraph, section, table
from ...extras import need
from ...files import written_whole

if TYPE_CHECKING:
    from ...simulation.trajectory import Trajectory
    from .widget import SceneWidget


_MOST_EVENTS = 12  # listed


class Viewable(Displayed):
    """The part of a Trajectory that shows it.

    Examples
    --------
    >>> import trundle as tr
    >>> isinstance(tr.Scenario.load("level-turntable-nudged").run(), Viewable)
    True
    """

    def __repr__(self) -> str:
        run = cast("Trajectory", self)
        ending = f", {run.events[-1].text}" if run.events else ""
        return f"<Trajectory: {_extent(run)}, {run.method}, {run.frame} frame{ending}>"

    def _headline(self) -> Headline:
        from ..plots.words import title_of

        run = cast("Trajectory", self)
        card = run._card_if_made()  # to make one takes seconds, and nobody asked for it
        told = ("not checked yet: card() checks it", None) if card is None else (card.outcome, card.passed)
        return Headline(run.title or title_of(run.system), *told)

    def _parts(self) -> Iterator[Markup]:
        from ...solve.exact.formula import formula_of
        from ..plots.words import key_numbers

        run = cast("Trajectory", self)
        form = run._kept.get("form") if run.method == "exact" else None
        tolerance = joined([f"{run.method}, tolerance ", number(run.tolerance)])
        yield paragraph(key_numbers(run.system, run.start.support))
        yield pairs(
            [
                ("samples", _extent(run)),
                ("method", "exact: a closed form" if run.method == "exact" else tolerance),
                ("frame", run.frame),
            ]
        )
        yield mathml(formula_of(run.system, form)["latex"], display=True) if form is not None else Markup()
        told = [(number(event.time, 9, "s"), event.kind, event.text) for event in run.events[:_MOST_EVENTS]]
        left = len(run.events) - len(told)
        yield section("Events", table(told, numbers=(0,)), paragraph(f"and {left} more" if left else ""))
        named = [
            (str(name), str(v.attrs["long_name"]), str(v.attrs["units"])) for name, v in run.data.data_vars.items()
        ]
        yield fold("Variables of data", table(named, ("name", "what it is", "unit")))

    def view(self, *others: Trajectory, **options: Any) -> SceneWidget:
        """Show the motion in a notebook: Jupyter, VS Code or marimo.

        Parameters
        ----------
        *others : Trajectory
            More bodies on the same stage, which has the support of this one.
        **options
            `frame`, `theme`, `height`, `speed` and more: see `trundle.views.viewer.widget.SceneWidget`.

        Returns
        -------
        SceneWidget
            Shown where a cell ends with it; where there are no widgets, a picture of the path.

        Raises
        ------
        MissingExtraError
            If the extra `notebook` is not installed.

        Examples
        --------
        >>> import trundle as tr
        >>> widget = tr.Scenario.load("level-turntable-nudged").run().view(height=300)
        >>> widget.height
        300
        >>> widget.close()
        """
        need("notebook", "view", "`save_html` needs nothing more, and shows the same in any browser.")
        from .widget import SceneWidget

        return SceneWidget((cast("Trajectory", self), *others), **options)

    def save_html(self, path: Any, *others: Trajectory) -> Path:
        """Write one file that plays the motion in any browser, without a network, with its card.

        Parameters
        ----------
        path : path
            Such as ``"scene.html"``; its folder must exist.
        *others : Trajectory
            More bodies on the same stage.

        Returns
        -------
        pathlib.Path
            The file, written whole or not at all.

        Raises
        ------
        TrundleError
            If it cannot be written.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.Scenario.load("level-turntable-nudged").run().save_html("scene.html").suffix
        '.html'
        """
        from ..scene import scene_of
        from .page import page_of

        runs = (cast("Trajectory", self), *others)
        return _written(Path(path), page_of([scene_of(run, with_card=True) for run in runs]))

    def save_glb(self, path: Any) -> Path:
        """Write an animated model, glTF 2.0 with y up, for Blender and other programs.

        Parameters
        ----------
        path : path
            Such as ``"scene.glb"``; its folder must exist.

        Returns
        -------
        pathlib.Path
            The file, written whole or not at all.

        Raises
        ------
        MissingExtraError
            If the extra `lab` is not installed.
        TrundleError
            If it cannot be written.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.Scenario.load("level-turntable-nudged").run().save_glb("scene.glb").suffix
        '.glb'
        """
        from .exports import export

        return _written(Path(path), export(cast("Trajectory", self), ".glb"))


def _extent(run: Trajectory) -> str:
    t = run.data.time.values
    return f"{t.size} samples over {t[-1] - t[0]:g} s"


def _written(target: Path, content: bytes) -> Path:
    with written_whole(target) as temporary:
        temporary.write_bytes(content)
    return target
