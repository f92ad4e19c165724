"""The book in a browser: links lead somewhere, the search finds, nothing is asked of the network, everybody can read it.

CI runs this file by its name: two notebooks run, and each of thirty pages is looked at in both themes and four widths.
"""

import html
import re
import shutil
from urllib.parse import unquote

import pytest
from accessibility import fits, violations

from ir50p_lab.course.publishing import book
from ir50p_lab.home import PROJECT

RUN = ("01_", "04_")  # the others are shown as they lie, for time
WIDTHS = (390, 420, 1366, 1920)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where the book is; of all notebooks but two a copy lies there that counts as run."""
    room = tmp_path_factory.mktemp("book")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(book, "_COPIES", room / "copies")
        (room / "copies").mkdir()
        for path in (PROJECT / "notebooks").glob("*.ipynb"):
            if not path.name.startswith(RUN):
                shutil.copyfile(path, room / "copies" / path.name)
        first = book.book(room / "site")
        made = {path: path.stat().st_mtime for path in (room / "copies").iterdir()}
        ready = [book._ready(PROJECT / "notebooks" / path.name, None, True) for path in made]
        assert {path: path.stat().st_mtime for path in ready} == made, "what was run is used again"
    assert first == room / "site" / "index.html"
    return room / "site"


def pages_of(folder):
    return {path.name: path.read_text("utf-8") for path in sorted(folder.glob("*.html"))}


def test_every_link_leads_somewhere(folder):
    pages = pages_of(folder)
    places = {name: set(re.findall(r'\bid="?([^" >]+)', page)) for name, page in pages.items()}
    missing = []
    for name, page in pages.items():
        for link in re.findall(r'<a\b[^>]* href="([^"]*)"', re.sub("<script.*?</script>", "", page, flags=re.DOTALL)):
            file, _, place = html.unescape(link).partition("#")
            if re.match(r"https?:", link):
                continue
            file = file or name
            if not (folder / file).is_file() or (place and not {place, unquote(place)} & places[file]):
                missing.append(f"{name}: {link}")
    assert not missing
    assert 'href="glossary.html"' in pages["index.html"] and 'href="try.html"' in pages["index.html"]


def test_from_page_to_page_through_the_whole_book(folder):
    pages, name, seen = pages_of(folder), "index.html", []
    while name:
        seen.append(name)
        found = re.search(r'rel="next" href="([^"#]+)', pages[name])
        back = re.search(r'rel="prev" href="([^"#]+)', pages[name])
        assert (back and back[1]) == (seen[-2] if len(seen) > 1 else None)
        name = found and found[1]
    assert sorted(seen) == sorted(set(pages) - {"try.html"})
    assert "forward_kinematics(arm, q)" in html.unescape(re.sub("<[^>]*>", "", pages["public_names.html"]))


def test_what_is_sought_is_found_by_keys_alone(folder, page):
    page.goto((folder / "index.html").as_uri())
    page.keyboard.press("Tab")
    assert page.evaluate("() => document.activeElement.textContent") == "Skip to the text"
    page.keyboard.press("Tab")
    page.keyboard.type("elbow half angle")
    page.locator(".found a").first.wait_for()
    told = re.fullmatch(r"(\d+) sections", page.locator(".told").text_content())
    assert page.locator(".found a").count() == min(int(told[1]), 20)
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.wait_for_url("**/*.html#*")
    assert "index.html" not in page.url and "elbow" in page.locator("main").text_content()


def test_without_a_network_the_arm_plays_and_nothing_is_asked_for(folder, page):
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.context.set_offline(True)
    page.emulate_media(reduced_motion="reduce")
    address = next(folder.glob("01_*.html")).as_uri()
    page.goto(address)
    page.wait_for_function("() => document.querySelector('.la')?.liveArm", timeout=60_000)
    before = page.evaluate("() => document.querySelector('.la').liveArm.q")
    page.locator(".la input[aria-label='joint 2 in degrees']").first.focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate("() => document.querySelector('.la').liveArm.q") != before
    assert page.locator("math").count() > 20
    own = {address, (folder / "search.js").as_uri()}
    assert {url for url in asked if not url.startswith(("data:", "blob:"))} == own


def test_every_page_fits_the_screen_and_can_be_read_by_everybody(folder, page):
    page.set_default_timeout(120_000)
    wrong = {}
    for path in sorted(folder.glob("*.html")):
        page.set_viewport_size({"width": WIDTHS[0], "height": 900})
        page.goto(path.as_uri())
        for width in WIDTHS:
            fits(page, width)
        if found := violations(page):
            wrong[path.name] = found
    assert not wrong
