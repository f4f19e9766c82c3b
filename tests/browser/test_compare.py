"""The page of a comparison: its recommendations agree with the results, its table can be sorted, and rows and paths light
each other up.
"""

import json

import pytest
from conftest import ROOT

FILES = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"]


def compare(program, name, *words, code=0):
    """Compares planners; returns the page and the results of the same run."""
    page = program.folder / f"{name}.html"
    found = program.run("compare", *FILES, *words, "--quiet", "--json", "--output", page, code=code)
    return page, json.loads(found)


@pytest.fixture(scope="module")
def single(program):
    return compare(program, "compared")


def column(seen, name):
    """Returns the sort keys of a column from top to bottom; None for cells without a value."""
    return seen.do(
        """(name) => {
          const heads = [...document.querySelectorAll('.ranking thead th')];
          const index = heads.findIndex((head) => head.textContent.trim() === name);
          const cells = [...document.querySelectorAll('.ranking tbody tr')].map((row) => row.cells[index]);
          return cells.map((cell) => cell.dataset.value === undefined ? null : Number(cell.dataset.value));
        }""",
        name,
    )


def names(seen):
    return seen.page.locator(".ranking tbody .name").all_inner_texts()


def lit(seen):
    """Returns the lit row and the lit paths in both pictures."""
    return seen.do(
        """() => ({
          row: document.querySelector('tr.on')?.dataset.planner ?? null,
          paths: [...new Set([...document.querySelectorAll('svg.large .on')].map((path) => Number(path.dataset.path)))],
          dimmed: [...document.querySelectorAll('svg.large [data-path]:not(.on)')].map((path) => getComputedStyle(path).opacity),
        })"""
    )


def test_the_recommendations_are_the_best_of_the_same_run(single, show_file):
    page, result = single
    seen = show_file(page)
    rows = result["planners"]
    best = {
        "shortest": (min, lambda row: row["length"]),
        "safest": (max, lambda row: row["clearance"]),
        "quickest": (min, lambda row: row["time"]["total"]),
        "motion": (min, lambda row: row["duration"]),
    }
    for purpose, (choose, value) in best.items():
        card = seen.page.locator(f"[data-purpose='{purpose}']")
        winner = choose(rows, key=value)
        assert card.get_attribute("data-planner") == winner["planner"], purpose
        shown = card.get_attribute("data-value") or card.locator("[data-value]").first.get_attribute("data-value")
        assert float(shown) == pytest.approx(value(winner), rel=1e-12), purpose
    conclusion = seen.page.locator(".conclusion").inner_text()
    shortest, safest = (min(rows, key=best["shortest"][1]), max(rows, key=best["safest"][1]))
    assert "All 10 planners found a path" in conclusion
    assert shortest["planner"] in conclusion and safest["planner"] in conclusion
    assert seen.page.locator(".pick svg.small path.way").count() == 6, "workspace and configuration space of each"
    assert [heading for heading in seen.page.locator("h2").all_inner_texts()][:3] == ["Shortest", "Safest", "Quickest answer"]
    seen.shoot("compare")


def test_the_title_states_the_gap_and_the_length_of_the_quickest_answer(single, show_file):
    page, result = single
    seen = show_file(page)
    found = [row for row in result["planners"] if row["outcome"] == "found"]
    shortest = min(found, key=lambda row: row["length"])
    quickest = min(found, key=lambda row: row["time"]["total"])
    words = seen.page.locator("h1").inner_text()
    assert words == seen.page.title() and words.startswith(f"{shortest['planner']} is within ")
    if quickest is not shortest:
        longer = float(words.split(f"by {quickest['planner']}, is ")[1].split(" ")[0])
        assert longer == pytest.approx(100 * (quickest["length"] / shortest["length"] - 1), abs=0.0101)


def test_the_table_has_the_values_of_the_same_run_and_marks_the_best(single, show_file):
    page, result = single
    seen = show_file(page)
    rows = result["planners"]
    assert names(seen) == [row["planner"] for row in rows]
    for name, value, choose in [
        ("length", lambda row: row["length"], min),
        ("over optimum", lambda row: row["over_optimum"], min),
        ("clearance", lambda row: row["clearance"], max),
        ("motion", lambda row: row["duration"], min),
        ("computed in", lambda row: row["time"]["total"], min),
        ("memory", lambda row: row["memory"], min),
    ]:
        values = [value(row) for row in rows]
        assert column(seen, name) == pytest.approx(values, rel=1e-12), name
        index = seen.page.locator(".ranking thead th").all_inner_texts().index(name)
        marked = seen.do(
            "(index) => [...document.querySelectorAll('.ranking tbody tr')].filter((row) => row.cells[index].matches('.best')).map((row) => row.dataset.planner)",
            index,
        )
        assert rows[values.index(choose(values))]["planner"] in marked, name
        widths = seen.do("(index) => [...document.querySelectorAll('.ranking tbody tr')].map((row) => parseFloat(row.cells[index].querySelector('.bar i').style.width))", index)
        base = 1 if name == "over optimum" else 0
        assert widths == pytest.approx([100 * (v - base) / (max(values) - base) for v in values], abs=0.01), name
    assert seen.page.locator(".ranking svg.small").count() == 10


def test_columns_are_sorted_by_a_click_or_a_key(single, show_file):
    page, _ = single
    seen = show_file(page)
    head = lambda name: seen.page.locator(".ranking thead").get_by_role("button", name=name, exact=True)
    state = lambda name: seen.page.locator(".ranking thead th", has_text=name).first.get_attribute("aria-sort")
    first = names(seen)
    head("length").click()
    assert state("length") == "ascending"
    lengths = column(seen, "length")
    assert lengths == sorted(lengths)
    head("length").focus()
    seen.page.keyboard.press("Enter")
    assert state("length") == "descending"
    assert column(seen, "length") == sorted(lengths, reverse=True)
    # More clearance is better, so the first click puts the greatest one first.
    head("clearance").click()
    assert state("clearance") == "descending" and state("length") is None
    assert column(seen, "clearance") == sorted(column(seen, "clearance"), reverse=True)
    head("planner").click()
    assert names(seen) == sorted(first)


def test_rows_without_a_value_come_last_in_both_directions(program, show_file):
    # With so few samples, the roadmap finds no path.
    page, result = compare(program, "unknown", "--planner", "shortest", "--with", "prm --samples 2 --levels 1")
    outcomes = [row["outcome"] for row in result["planners"]]
    assert outcomes == ["found", "unknown"]
    seen = show_file(page)
    head = seen.page.locator(".ranking thead").get_by_role("button", name="length", exact=True)
    for _ in range(2):
        head.click()
        assert column(seen, "length")[-1] is None
    assert seen.page.locator("tr[data-path]").count() == 1
    assert "1 of 2 planners found a path" in seen.page.locator(".conclusion").inner_text()


def test_rows_and_paths_light_each_other_up(single, show_file):
    page, result = single
    seen = show_file(page)
    rows = [row["planner"] for row in result["planners"]]
    assert lit(seen)["row"] is None
    index = rows.index("harmonic")
    seen.page.locator("tr[data-planner='harmonic']").hover()
    now = lit(seen)
    assert (now["row"], now["paths"]) == ("harmonic", [index])
    seen.page.wait_for_timeout(300)
    assert {float(opacity) for opacity in lit(seen)["dimmed"]} == {0.1}
    note = seen.page.locator(".lit-path")
    assert note.inner_text().startswith("harmonic: ")
    seen.shoot("compare-lit")
    # A row that is sorted elsewhere still lights its own path.
    seen.page.locator(".ranking thead").get_by_role("button", name="memory", exact=True).click()
    seen.page.locator("tr[data-planner='voronoi'] button").focus()
    assert lit(seen)["row"] == "voronoi"
    # A place on the path of the Voronoi planner in the configuration space, far from other paths.
    place = seen.do(
        """(path) => {
          const group = document.querySelectorAll('svg.large')[1].querySelectorAll(`[data-path='${path}']`);
          const line = group[group.length - 1].querySelector('path');
          for (let share = 0.02; share < 1; share += 0.02) {
            const { x, y } = line.getPointAtLength(line.getTotalLength() * share).matrixTransform(line.getScreenCTM());
            const hit = document.elementFromPoint(x, y)?.closest('[data-path]');
            if (hit?.dataset.path === String(path)) return [x, y];
          }
        }""",
        rows.index("voronoi"),
    )
    seen.page.locator("tr[data-planner='voronoi'] button").blur()
    assert lit(seen)["row"] is None
    seen.page.mouse.move(*place)
    assert lit(seen)["row"] == "voronoi"


def test_a_click_pins_a_path_and_escape_releases_it(single, show_file):
    page, _ = single
    seen = show_file(page)
    seen.page.locator("tr[data-planner='first'] button").click()
    button = seen.page.locator("tr[data-planner='first'] button")
    assert button.get_attribute("aria-pressed") == "true"
    seen.page.locator("h1").hover()
    assert lit(seen)["row"] == "first", "it stays lit without the pointer"
    seen.page.locator("tr[data-planner='prm']").hover()
    assert lit(seen)["row"] == "prm"
    seen.page.locator("h1").hover()
    assert lit(seen)["row"] == "first"
    seen.page.keyboard.press("Escape")
    assert (lit(seen)["row"], button.get_attribute("aria-pressed")) == (None, "false")
    # The card of a recommendation lights its path as well.
    card = seen.page.locator("[data-purpose='shortest']")
    card.hover()
    assert lit(seen)["row"] == card.get_attribute("data-planner")


def test_a_focused_row_is_not_hidden_by_the_pictures(single, show_file):
    page, _ = single
    seen = show_file(page, width=1280, height=900)
    seen.do("window.scrollTo(0, document.body.scrollHeight)")
    for planner in ("voronoi", "shortest"):
        seen.page.locator(f"tr[data-planner='{planner}'] button").focus()
        row, pictures = (seen.page.locator(place).bounding_box() for place in (f"tr[data-planner='{planner}']", ".pictures"))
        assert row["y"] >= pictures["y"] + pictures["height"] - 1, planner


def test_without_scripts_the_page_shows_the_same(single, show_file):
    page, result = single
    seen = show_file(page, java_script_enabled=False)
    assert seen.page.locator(".ranking tbody tr").count() == len(result["planners"])
    assert seen.page.locator(".ranking button").count() == 0
    assert seen.page.locator("svg.large").count() == 2


@pytest.mark.parametrize(("queries", "charts"), [(4, False), (5, True)])
def test_charts_need_five_runs_of_each_planner(program, show_file, queries, charts):
    page, result = compare(program, f"queries{queries}", "--queries", str(queries), "--planner", "shortest", "--planner", "wavefront")
    seen = show_file(page)
    assert (seen.page.locator("svg.chart .box").count() > 0) == charts
    assert ("Distributions" in seen.page.locator("h2").all_inner_texts()) == charts
    assert seen.page.locator(".ranking").first.locator("tbody tr").count() == 2
    # Each query has its own folded part, in which the rows light up the paths of this query alone.
    parts = seen.page.locator("details:has(.compared)")
    assert parts.count() == queries
    parts.nth(0).locator("summary").click()
    parts.nth(0).locator("tr[data-path]").first.hover()
    assert seen.page.locator(".compared.lit").count() == 1
    # The wins are those of the same run.
    lengths = [[row["length"] for row in problem["planners"]] for problem in result["problems"]]
    wins = [sum(row[k] is not None and row[k] <= min(v for v in row if v is not None) * (1 + 1e-6) for row in lengths) for k in (0, 1)]
    assert column(seen, "shortest")[:2] == wins


def test_a_single_problem_has_no_chart(single, show_file):
    seen = show_file(single[0])
    assert seen.page.locator("svg.chart").count() == 0


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_planners_of_a_family_share_a_hue_and_stand_out(single, show_file, scheme):
    seen = show_file(single[0], color_scheme=scheme)
    colors = seen.do(
        """() => [...document.querySelectorAll('.ranking tbody tr')].map((row) =>
          [row.dataset.planner, getComputedStyle(row.querySelector('svg.line path')).stroke.match(/\\d+/g).map(Number),
           row.querySelector('svg.line path').getAttribute('stroke-dasharray')])"""
    )
    families = {"shortest": 2, "subdivision": 2, "first": 2, "wavefront": 1, "harmonic": 1}
    looks = set()
    for planner, (red, green, blue), dashes in colors:
        family = families.get(planner, 0)
        hue = 2 if blue > green > red else 1 if green < min(red, blue) else 0
        assert hue == family, planner
        looks.add((family, dashes))
    assert len(looks) == len(colors), "planners of a family have different dashes"


def test_infeasible_worlds_have_a_proof_and_no_recommendation(program, show_file):
    page = program.folder / "compare_closed.html"
    closed = [FILES[0], ROOT / "workspaces/no_path.toml"]
    program.run("compare", *closed, "--planner", "shortest", "--planner", "first", "--quiet", "--output", page, code=3)
    seen = show_file(page)
    assert "There is no path: 2 of 2 planners proved it." in seen.page.locator(".conclusion").inner_text()
    assert seen.page.locator(".pick").count() == 0
    assert seen.page.locator(".ranking .o-infeasible").count() == 2
    assert seen.page.locator("svg.large").count() == 2


def test_the_head_of_the_table_stays_in_sight_on_a_phone(single, show_file):
    page, _ = single
    seen = show_file(page, width=390, height=420)
    seen.do("document.querySelector('.ranking').closest('.wide').scrollIntoView({ block: 'start' })")
    # The table scrolls by itself, and its head stays.
    wide = "document.querySelector('.ranking').closest('.wide')"
    assert seen.do(f"{wide}.scrollHeight > {wide}.clientHeight")
    seen.do(f"{wide}.scrollTo(0, 10000)")
    head = seen.page.locator(".ranking thead th").first.bounding_box()
    last = seen.page.locator(".ranking tbody tr").last.bounding_box()
    assert -0.5 <= head["y"] <= 1 and last["y"] + last["height"] <= 420.5
