"""Whether everybody can read a page: what axe-core finds against levels A and AA of the WCAG, in both themes."""

from axe_playwright_python.sync_playwright import Axe

LEVELS = {"type": "tag", "values": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22a", "wcag22aa"]}


def violations(page):
    """{theme: rule and place of each violation} of the page that is open; {} without any."""
    found = {}
    for theme in ("light", "dark"):
        page.emulate_media(color_scheme=theme, reduced_motion="reduce")
        page.wait_for_timeout(300)  # views draw themselves anew
        results = Axe().run(page, options={"runOnly": LEVELS, "resultTypes": ["violations"]}).response
        said = [f"{one['id']}: {node['html'][:150]}" for one in results["violations"] for node in one["nodes"]]
        found |= {theme: said} if said else {}
    return found


def fits(page, width):
    """Make the screen so wide and wait until nothing reaches beyond it."""
    page.set_viewport_size({"width": width, "height": 900})
    page.wait_for_function("(width) => document.documentElement.scrollWidth <= width", arg=width)
