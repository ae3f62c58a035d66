"""Six scenarios, each slider to both its ends: none leads to a refusal, for each ends where the physics does."""

from __future__ import annotations

import json
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from trundle.lab.answers import possible
from trundle.scenario import files

from .visiting import Visitor

SIX = (
    "superball",
    "billiard-draw",
    "rattleback",
    "cylinder-in-cylinder",
    "tippe-top",
    "ball-in-a-turning-bowl",
)
# Each slider to both its ends and back, all at once; what each says there.
TO_THEIR_ENDS = """controls => [...controls.querySelectorAll('.field')].flatMap(field => {
    const slider = field.querySelector('.slider')
    const box = field.querySelector('.field-number')
    const tell = (of, ...names) => names.forEach(name => of.dispatchEvent(new Event(name)))
    if (slider.disabled) return []
    box.focus() // all digits
    const unit = () => field.querySelector('.field-unit')?.value ?? ''
    const before = `${box.value} ${unit()}`.trim()
    return ['0', '1000'].map(end => {
        slider.value = end
        tell(slider, 'input')
        const found = {path: field.dataset.path, number: Number(box.value), unit: unit()}
        box.value = before
        tell(box, 'input', 'change')
        return found
    })
})"""


@pytest.fixture(scope="module")
def page(staying: Visitor) -> Page:
    return staying.open("#/compare", drawn=False, cards=False)


def moved(scenario: dict[str, Any], path: str, number: float, unit: str) -> dict[str, Any] | None:
    """Return a scenario with one number changed; None where it does not say that number."""
    changed: Any = json.loads(json.dumps(scenario))
    *way, last = (int(key) if key.isdigit() else key for key in path.split("."))
    holder = changed
    try:
        for key in way:
            holder = holder[key]
        holder[last]
    except (KeyError, IndexError):
        return None
    holder[last] = f"{number!r} {unit}" if unit else number
    return changed


@pytest.mark.parametrize("name", SIX)
def test_no_slider_leads_to_a_refusal(page: Page, name: str) -> None:
    page.evaluate("name => { location.hash = `#/bench?name=${name}` }", name)
    controls = page.locator(".controls")
    expect(controls).to_have_attribute("data-ends", files.title_of(name), timeout=60_000)
    scenario = files.parse(files.read(name), name)
    ends = controls.evaluate(TO_THEIR_ENDS)
    assert len(ends) > 10
    tried = [(end, moved(scenario, **end)) for end in ends]
    known = [(end, one) for end, one in tried if one is not None]
    assert len(known) > 10
    told = json.loads(possible([one for _, one in known]).body)
    assert [(end, why) for (end, _), why in zip(known, told, strict=True) if why] == []


def test_sliders_built_while_their_ends_are_sought_find_theirs(visitor: Visitor) -> None:
    page = visitor.open("#/compare", drawn=False, cards=False)
    # The reach of a place is that of the scene, which is laid out a frame later: here while the first ends are sought.
    page.evaluate("""() => {
        const [draw, ask] = [window.requestAnimationFrame, window.fetch]
        let letGo
        const sought = new Promise(resolve => { letGo = resolve })
        window.requestAnimationFrame = what => void sought.then(() => draw(what))
        window.fetch = async (...given) => {
            const ends = String(given[0]).endsWith('/api/possible')
            if (ends) letGo()
            if (ends) await new Promise(resolve => setTimeout(resolve, 300))
            return ask(...given)
        }
        location.hash = "#/bench?name=superball"
    }""")
    expect(page.locator(".controls")).to_have_attribute("data-ends", files.title_of("superball"), timeout=60_000)
