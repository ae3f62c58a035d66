"""What axe-core finds in a page: what would shut somebody out of it."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Page

AXE = Path(__file__).parents[2] / "web" / "node_modules" / "axe-core" / "axe.min.js"
GRAVE = ("serious", "critical")
OF_COLOURS = ("color-contrast", "link-in-text-block")  # all rules of axe-core that look at colours


def violations(page: Page, part: str = "body", rules: tuple[str, ...] = ()) -> list[str]:
    """Return what is of serious or critical level in a part of the page, each with the first places where it is.

    By some of the rules, or else by all of them.
    """
    if not AXE.is_file():
        raise FileNotFoundError("axe-core is not there: run `python web/build.py test`, as `make test` does first")
    # By the debugger, which the page's policy against foreign scripts does not bind.
    if not page.evaluate("'axe' in window"):
        page.evaluate(AXE.read_text(encoding="utf-8"))
    options = {"resultTypes": ["violations"]} | ({"runOnly": list(rules)} if rules else {})
    found = page.evaluate("([part, options]) => axe.run(part, options)", [part, options])
    return [
        f"{one['impact']}: {one['help']} ({one['id']}): "
        + "; ".join(
            f"{' '.join(map(str, node['target']))} {node['any'][0]['message'] if node['any'] else ''}"
            for node in one["nodes"][:4]
        )
        for one in found["violations"]
        if one["impact"] in GRAVE
    ]
