"""The review page in headless Chromium, operated as by a reader. Usage: browser_test.py WEFT SOURCE_FOLDER"""

import base64
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import webdriver

WEFT, SOURCE = sys.argv[1:3]
SKIPPED = 77  # exit code for ctest
HOSTILE = "<img src=x onerror=alert(1)> & 'co'"
FRAMES, STEP = 40, 4  # drawn frames are 0, 4, 8 up to 36, in which a falling band differs clearly
PICTURES = FRAMES // STEP
SIZE = (192, 108)


def weft(folder, *arguments):
    subprocess.run([WEFT, *arguments], cwd=folder, check=True, capture_output=True)


def simulate(folder, output, *settings):
    name = pathlib.Path(output).name.split("_{")[0].removesuffix(".mp4")
    weft(folder, "run", f"{SOURCE}/scenes/falling_band.toml", "-o", output, "--stats",
         str(pathlib.Path(output).parent / f"{name}.json"), "--frames", f"0:{FRAMES}:{STEP}", "--quality", "draft",
         "--size", f"{SIZE[0]}x{SIZE[1]}", "--progress", "none", "--set", "cloth.band.particles=[17,161]", *settings)


def read_png(content):
    """Rows of bytes, three for each pixel, of an 8-bit RGB or RGBA picture."""
    place, data = 8, b""
    while place < len(content):
        length, kind = struct.unpack(">I4s", content[place:place + 8])
        chunk = content[place + 8:place + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", chunk[:10])
            assert depth == 8 and color in (2, 6)
            pixel = 3 if color == 2 else 4
        data += chunk if kind == b"IDAT" else b""
        place += 12 + length
    data, rows, above = zlib.decompress(data), [], bytes(width * pixel)
    for y in range(height):
        start = y * (width * pixel + 1)
        row = bytearray(data[start + 1:start + 1 + width * pixel])
        for i, value in enumerate(row):
            a, b, c = (row[i - pixel] if i >= pixel else 0), above[i], (above[i - pixel] if i >= pixel else 0)
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (value + (0, a, b, (a + b) // 2, paeth)[data[start]]) % 256
        rows.append(bytes(row))
        above = row
    return [bytes(v for i, v in enumerate(row) if i % pixel < 3) for row in rows]


def distance(a, b):
    return sum(abs(x - y) for row, other in zip(a, b) for x, y in zip(row, other)) / (len(a) * len(a[0]))


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="weft_review_")
        folder = cls.folder = pathlib.Path(cls.scratch.name)
        simulate(folder, "in/plain.mp4")
        simulate(folder, "in/soft/plain.mp4", "--set", "cloth.band.material.stretch=300")
        simulate(folder, "in/stills/plain_{frame:03}.png")
        for age, file in enumerate(("stills/plain_000.png", "soft/plain.mp4", "plain.mp4")):
            os.utime(folder / "in" / file, (1.7e9 - 60 * age,) * 2)
        (folder / "in" / f"{HOSTILE}.mp4").write_bytes((folder / "in/plain.mp4").read_bytes())
        (folder / "ref").mkdir()
        (folder / "ref/plain.mp4").write_bytes((folder / "in/plain.mp4").read_bytes())
        weft(folder, "review", "in", "--reference", "ref", "-o", "page")
        cls.stills = [read_png((folder / f"in/stills/plain_{STEP * k:03}.png").read_bytes()) for k in range(PICTURES)]
        cls.browser = webdriver.Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.scratch.cleanup()

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])
        elsewhere = [url for url in self.browser.requests() if not url.startswith(("file:", "data:", "about:"))]
        self.assertEqual(elsewhere, [])

    def open(self, address="", width=1280, height=800, dark=False, page=None):
        self.browser.resize(width, height)
        self.browser.prefer(dark)
        self.browser.open("about:blank")
        self.browser.open((page or self.folder / "page/index.html").as_uri() + address)
        self.browser.wait("return document.querySelector('#content > *')")

    def open_run(self, run, more=""):
        self.open(f"#run=runs/{run}{more}")
        self.settled()

    def settled(self):
        """Waits until every visible picture is the one that the controls select; returns its frame."""
        return int(self.browser.wait("""
            const viewer = document.querySelector('.viewer'), wanted = viewer.querySelector('.scrubber').value;
            const media = [...viewer.querySelectorAll('video, .layer img')];
            return media.length > 0 && media.every((m) => m.dataset.picture === wanted) && viewer.dataset.frame;"""))

    def shown(self, selector=".blend", size=SIZE):
        """The screen content, at the size of the video."""
        box = self.browser.run("const b = document.querySelector(arguments[0]).getBoundingClientRect();"
                               "return {x: b.x + scrollX, y: b.y + scrollY, width: b.width, height: b.height}", selector)
        clip = {**box, "scale": size[0] / box["width"]}
        picture = self.browser.devtools("Page.captureScreenshot", {"clip": clip})["data"]
        return read_png(base64.b64decode(picture))

    def picture_on_screen(self):
        """The number of the still that is most similar to the screen."""
        screen = self.shown()
        return min(range(PICTURES), key=lambda k: distance(screen, self.stills[k]))

    def text(self, selector):
        return self.browser.run("return document.querySelector(arguments[0]).textContent", selector)

    def overflow(self):
        return self.browser.run("""
            const width = document.documentElement.clientWidth;
            return [...document.querySelectorAll('body *')].filter((e) => !e.closest('.table-frame, .sheet, .scene-lines, .hidden, .skip') &&
              e.getBoundingClientRect().right > width + 1).map((e) => e.className || e.tagName).slice(0, 5)""")

    def test_overview_lists_every_run_and_shows_names_as_text(self):
        self.open()
        names = self.browser.run("return [...document.querySelectorAll('.runs .name a')].map((a) => a.textContent)")
        self.assertCountEqual(names, ["plain", "soft/plain", "stills/plain", HOSTILE])
        self.assertEqual(self.browser.run("return document.querySelectorAll('img[src=x]').length"), 0)

    def test_runs_are_filtered_and_sorted(self):
        self.open()
        self.browser.press("/", *"soft")
        shown = "return [...document.querySelectorAll('.runs tbody tr:not([hidden])')].map((tr) => tr.dataset.run)"
        self.assertEqual(self.browser.run(shown), ["runs/soft-plain"])
        self.open()
        self.browser.run("[...document.querySelectorAll('.runs thead button')].find((b) => b.textContent === 'Largest strain').click()")
        order = self.browser.run(shown)
        self.assertEqual((order[-2:]), ["runs/soft-plain", f"runs/img-src-x-onerror-alert-1-co"])

    def sweep(self):
        """Runs with 0.02, 0.01, 0.2 for a key, and with a valid and an invalid value for another; made once."""
        page = self.folder / "sweep/page"
        if not page.exists():
            subprocess.run([WEFT, "sweep", f"{SOURCE}/scenes/falling_band.toml", "-o", "sweep", "--quality", "draft", "--size", "64x36",
                            "--frames", "0:3", "--set", "time.step=0.02,0.01,0.2", "--set", "cloth.band.position=[0,0,2],[0,0,0]"],
                           cwd=self.folder, check=False, capture_output=True)
        return page / "index.html"

    def test_runs_of_a_sweep_stand_in_its_order_with_their_values(self):
        def column(k):
            return self.browser.run("return [...document.querySelectorAll('.runs tbody tr')].map((tr) => tr.cells[arguments[0]].textContent)", k)

        def sort(label):
            self.browser.run("[...document.querySelectorAll('.runs thead button')].find((b) => b.textContent === arguments[0]).click()", label)

        self.open(page=self.sweep())
        heads = self.browser.run("return [...document.querySelectorAll('.runs thead th')].map((th) => th.textContent)")
        step, place = heads.index("step"), heads.index("position")
        self.assertEqual(column(step), ["0.02", "0.02", "0.01", "0.01", "0.2", "0.2"])
        self.assertEqual(column(2)[0], "step=0.02_position=0,0,2falling_band")
        sort("step")
        self.assertEqual(column(step), ["0.01", "0.01", "0.02", "0.02", "0.2", "0.2"])
        sort("position")
        self.assertEqual(column(place), ["[0,0,2]"] * 3 + ["[0,0,0]"] * 3)
        sort("Run")
        self.assertEqual(column(step), ["0.02", "0.02", "0.01", "0.01", "0.2", "0.2"])
        self.assertRegex(column(3)[1], "failed: scene.*falling_band.toml: expected surfaces that are apart")
        self.assertEqual(self.browser.run("return review.model.versions(review.model.runs[0]).length"), 1)
        for width in (1280, 390):
            self.open(page=self.sweep(), width=width)
            self.assertEqual(self.overflow(), [], width)

    def test_keyboard_alone_chooses_and_compares_runs(self):
        self.open()
        self.browser.press("j", "j", "x", "j", "x", "c")
        self.browser.wait("return document.querySelector('.compare-page')")
        self.assertEqual(self.browser.run("return document.querySelectorAll('.members li').length"), 2)

    def test_every_frame_that_is_asked_for_is_on_screen(self):
        self.open_run("soft-plain")
        self.open_run("plain", "&with=")
        for k in (0, 7, 3, 9, 8, 1, 2):
            self.browser.run("const s = document.querySelector('.scrubber'); s.value = arguments[0]; s.dispatchEvent(new Event('input'))", k)
            self.assertEqual(self.settled(), STEP * k)
            self.assertEqual(self.picture_on_screen(), k)

    def test_stills_are_shown_as_videos_are(self):
        self.open_run("stills-plain", "&with=")
        self.browser.press("End")
        self.assertEqual(self.settled(), FRAMES - STEP)
        self.assertEqual(self.picture_on_screen(), PICTURES - 1)
        self.browser.press("Home", "Space")
        self.browser.wait(f"return document.querySelector('.viewer').dataset.frame === '{FRAMES - STEP}'")

    def test_keys_step_through_the_frames(self):
        self.open_run("plain")
        for keys, frame in (["ArrowRight"], STEP), (["."] * 2, 3 * STEP), (["ArrowLeft"], 2 * STEP), (["End"], FRAMES - STEP), \
                (["ArrowRight"], FRAMES - STEP), (["Shift+ArrowLeft"], 0), (["g", "2", "0", "Enter"], 20):
            self.browser.press(*keys)
            self.assertEqual(self.settled(), frame, keys)

    def test_playing_ends_on_the_last_frame(self):
        self.open_run("plain")
        self.browser.press("Space")
        self.browser.wait(f"return document.querySelector('.viewer').dataset.frame === '{FRAMES - STEP}'")
        self.browser.wait("return [...document.querySelectorAll('video')].every((video) => video.paused)")
        self.assertEqual(self.settled(), FRAMES - STEP)

    def test_address_leads_back_to_the_frame(self):
        self.open_run("plain", "&frame=24&view=blink")
        self.assertEqual(self.settled(), 24)
        self.assertEqual(self.text("[data-mode][aria-pressed=true]"), "Blink")
        self.browser.press("ArrowRight")
        self.settled()
        self.assertIn("frame=28", self.browser.run("return location.hash"))

    def test_line_in_the_plots_stands_at_the_frame_and_a_click_leads_there(self):
        self.open_run("plain")
        self.browser.press("End")
        self.settled()
        place = """const over = document.querySelector('[data-plot=strain] .u-over').getBoundingClientRect();
                   const line = document.querySelector('[data-plot=strain] .playhead').getBoundingClientRect();
                   return [over.left, over.top, over.width, line.left + 1 - over.left]"""
        left, top, width, line = self.browser.run(place)
        self.assertAlmostEqual(line, width, delta=1.5)  # the last picture is the last frame
        self.browser.drag([(left + width / 2, top + 20)] * 2)
        frame = self.settled()
        self.assertAlmostEqual(frame, (FRAMES - STEP) / 2, delta=STEP / 2)
        self.assertAlmostEqual(self.browser.run(place)[3], width * frame / (FRAMES - STEP), delta=1.5)

    def test_slider_follows_the_mouse_and_shows_both(self):
        self.open_run("soft-plain", "&with=runs/stills-plain&frame=36")
        box = self.browser.run("const b = document.querySelector('.blend').getBoundingClientRect(); return [b.left, b.top, b.width]")
        for percent in (100, 0):
            self.browser.drag([(box[0] + box[2] / 2, box[1] + 50), (box[0] + box[2] * percent / 100, box[1] + 50)])
            share = self.browser.run("return document.querySelector('.stage').style.getPropertyValue('--split')")
            self.assertAlmostEqual(float(share.rstrip("%")), percent, delta=0.5)
            # The slider at the left end shows only the reference.
            self.assertEqual(distance(self.shown(), self.stills[9]) < 3, percent == 0)
        self.browser.press("]", "]")
        self.assertEqual(self.browser.run("return document.querySelector('.split').value"), "10")

    def test_difference_of_equal_videos_is_dark_and_of_others_is_not(self):
        def brightest():
            # Leaves out the border, whose pixels mix with the surroundings of the picture.
            return max(max(row[6:-6]) for row in self.shown()[2:-2])

        self.open_run("plain", "&view=difference&frame=36")
        self.browser.run("document.querySelector('.names').hidden = true")
        # The dark end of the heat colours has a blue of 8. A browser reports a frame before it draws it.
        self.assertTrue(any(brightest() < 24 for _ in range(20)))
        self.open_run("soft-plain", "&view=difference&frame=36")
        self.browser.run("document.querySelector('.names').hidden = true")
        self.assertGreater(brightest(), 150)

    def test_heat_map_is_that_of_the_compared_picture_nearest_to_the_frame(self):
        self.open_run("soft-plain", "&frame=36&view=heat")
        note = self.browser.run("return document.querySelector('.heat-note').textContent")
        self.assertRegex(note, r"^frame 36: FLIP 0\.\d+, SSIM 0\.\d+")
        self.browser.wait("const heat = document.querySelector('img.heat'); return heat.complete && heat.naturalWidth > 0")
        self.open_run("plain", "&frame=36&view=heat")
        self.assertEqual(self.text(".heat-note"), "frame 36: equal in every pixel")
        self.assertEqual(self.text(".page-head .chip:nth-child(2)"), "same")

    def test_contact_sheet_leads_to_its_frames(self):
        self.open_run("plain")
        self.browser.wait("return [...document.querySelectorAll('.tile img')].every((img) => img.naturalWidth > 0)")
        tiles = self.browser.run("return [...document.querySelectorAll('.tile')].map((t) => t.textContent)")
        self.assertEqual(tiles, [str(STEP * k) for k in range(PICTURES)])
        self.browser.run("document.querySelectorAll('.tile')[6].click()")
        self.assertEqual(self.settled(), 6 * STEP)

    def test_blink_shows_one_then_the_other(self):
        self.open_run("plain", "&view=slider")
        self.browser.press("4")
        visible = "return getComputedStyle(document.querySelector('.layer-b')).visibility"
        self.browser.wait(visible + " === 'visible'")
        self.browser.wait(visible + " === 'hidden'")
        self.browser.press("b")
        self.assertEqual(self.browser.run(visible), "visible")
        self.browser.press("b")
        self.assertEqual(self.browser.run(visible), "hidden")

    def test_differences_of_scenes_are_just_those_that_were_set(self):
        self.open("#compare=runs/plain&compare=runs/soft-plain")
        self.assertEqual(self.browser.run("return [...document.querySelectorAll('.scenes tbody th')].map((e) => e.textContent)"),
                         ["cloth.band.material.stretch"])

    def test_scene_is_searched(self):
        self.open_run("plain")
        self.browser.press("/", *"stretch", "Enter")
        self.assertRegex(self.text(".scene-search .found"), r"^\d+ of \d+ lines$")
        self.assertIn("stretch", self.text(".scene-lines .current"))

    def test_dark_and_light_follow_the_system_until_one_is_chosen(self):
        ground = "return getComputedStyle(document.body).backgroundColor"
        self.open(dark=True)
        dark = self.browser.run(ground)
        self.browser.prefer(False)
        light = self.browser.wait(f"return getComputedStyle(document.body).backgroundColor !== '{dark}' && getComputedStyle(document.body).backgroundColor")
        self.browser.press("t", "t")  # auto, light, dark
        self.assertEqual(self.browser.run(ground), dark)
        self.open()
        self.assertEqual(self.browser.run(ground), dark, "the choice is kept")
        self.browser.press("t")
        self.assertEqual(self.browser.run(ground), light)

    def test_help_explains_the_keys_of_the_page(self):
        self.open_run("plain")
        self.browser.press("?")
        self.assertTrue(self.browser.run("return document.querySelector('#help').open"))
        self.assertIn("one frame back", self.text("#help"))
        self.browser.press("Escape")
        self.assertFalse(self.browser.run("return document.querySelector('#help').open"))

    def test_focus_is_seen(self):
        self.open()
        for _ in range(6):
            self.browser.press("Tab")
            self.assertNotEqual(self.browser.run("return getComputedStyle(document.activeElement).outlineStyle"), "none")

    def test_nothing_is_wider_than_the_window(self):
        for width in (1280, 390):
            for address in ("", "#run=runs/plain", "#run=runs/img-src-x-onerror-alert-1-co",
                            "#compare=runs/plain&compare=runs/soft-plain&compare=runs/stills-plain"):
                self.open(address, width=width)
                self.assertEqual(self.overflow(), [], (width, address))
                self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), width)

    def test_decisions_and_notes_stay_until_they_are_in_their_file(self):
        self.open_run("soft-plain", "&frame=12")
        self.browser.run("localStorage.clear()")
        self.open_run("soft-plain", "&frame=12")
        self.browser.press("w", "d")
        box = self.browser.run("const b = document.querySelector('.blend').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]")
        points = [(box[0] + box[2] * x, box[1] + box[3] * y) for x, y in ((0.25, 0.5), (0.5, 0.75), (0.75, 0.5))]
        self.browser.drag(points)
        self.browser.press("m", *"a fold", "Tab", "Tab", "Enter")  # past the draw button
        self.assertEqual(self.text(".note-list .at"), "frame 12")
        self.assertEqual(self.text(".downloads button"), "Download review.json for in: 1 new decision")
        self.assertEqual(self.text(".accept-line"), "weft accept ref/plain.mp4 in/soft/plain.mp4 --reason WHY")
        self.assertEqual(self.text(".versions tr:nth-child(2) .chip"), "needs work")
        self.browser.run("document.activeElement.blur()")
        self.browser.press("a")
        self.assertEqual(self.text(".accept-line"), "weft accept ref/plain.mp4 in/soft/plain.mp4 --reason 'a fold'")
        self.browser.press("w")
        self.open("?again#run=runs/soft-plain&frame=12")  # the browser keeps the decision
        self.settled()
        self.assertEqual(self.text("[data-state][aria-pressed=true]"), "Needs work")
        self.assertEqual(self.browser.run("return document.querySelectorAll('.drawn .over').length"), 1)
        self.browser.press("End")
        self.settled()
        self.assertEqual(self.browser.run("return document.querySelectorAll('.drawn .over').length"), 0, "of another frame")
        text = self.browser.run("return review.decisions.file('in')")
        note = json.loads(text)["runs"]["soft/plain"]["notes"][0]
        self.assertEqual((note["frame"], note["text"]), (12, "a fold"))
        for (x, y), (wanted_x, wanted_y) in zip(note["marks"][0], ((0.25, 0.5), (0.5, 0.75), (0.75, 0.5))):
            self.assertAlmostEqual(x, wanted_x, delta=0.01)
            self.assertAlmostEqual(y, wanted_y, delta=0.01)

        (self.folder / "in/review.json").write_text(text)
        try:
            weft(self.folder, "review", "in", "--reference", "ref", "-o", "page", "--overwrite")
            self.open("?after#state=needs work")
            shown = "return [...document.querySelectorAll('.runs tbody tr:not([hidden])')].map((tr) => tr.dataset.run)"
            self.assertEqual(self.browser.run(shown), ["runs/soft-plain"])
            self.assertEqual(self.browser.run("return document.querySelectorAll('.downloads button').length"), 0)
            (self.folder / "in/review.json").write_text(re.sub('"of": *"[0-9a-f]*"', '"of": "0000000000000000"', text))
            weft(self.folder, "review", "in", "--reference", "ref", "-o", "page", "--overwrite")
            self.open("?changed")
            self.assertEqual(self.text("[data-run='runs/soft-plain'] .verdict .chip"), "changed since needs work")
            self.browser.run("localStorage.clear()")
        finally:
            (self.folder / "in/review.json").unlink()
            weft(self.folder, "review", "in", "--reference", "ref", "-o", "page", "--overwrite")

    def test_decisions_of_two_tabs_are_all_kept(self):
        self.open_run("plain")
        self.browser.run("localStorage.clear()")
        self.open_run("plain")
        # Another tab stores a decision after this tab has read the storage.
        self.browser.run("""
            const run = review.model.find("runs/soft-plain"), date = new Date().toISOString();
            const entry = { state: "approved", notes: [], of: run.of, by: "", date };
            localStorage.setItem(`weft-review-decisions:${location.pathname}`, JSON.stringify({ [run.home]: { [run.key]: entry } }));""")
        self.browser.press("w")
        self.open_run("soft-plain")
        self.assertEqual(self.text("[data-state][aria-pressed=true]"), "Approved")
        self.open_run("plain")
        self.assertEqual(self.text("[data-state][aria-pressed=true]"), "Needs work")
        self.browser.run("localStorage.clear()")

    def test_versions_are_the_runs_of_one_scene_the_newest_first(self):
        self.open_run("plain")
        rows = self.browser.run("return [...document.querySelectorAll('.versions tbody tr td:first-child')].map((td) => td.textContent)")
        self.assertEqual(rows, ["stills/plain", "soft/plain", "plain"])
        self.open("#newest=1")
        shown = self.browser.run("return [...document.querySelectorAll('.runs tbody tr:not([hidden])')].map((tr) => tr.dataset.run)")
        self.assertEqual(shown, ["runs/img-src-x-onerror-alert-1-co", "runs/stills-plain"])

    def test_overview_loads_no_details_of_runs(self):
        self.browser.requests()
        self.open("?light")
        self.assertEqual([url for url in self.browser.requests() if url.endswith("data.js")], [])

    def test_video_that_does_not_play_is_named_with_the_reason(self):
        video = self.folder / "page/runs/plain/video.mp4"
        kept = video.read_bytes()
        video.write_bytes(b"words" * 100)
        try:
            self.open("#run=runs/plain&with=")
            self.browser.wait("return !document.querySelector('.stage-message').hidden")
            self.assertRegex(self.text(".stage-message"), "^plain: the video cannot be played: runs/plain/video.mp4: the file is not there, or this browser")
        finally:
            video.write_bytes(kept)
        self.browser.complaints()

    @unittest.skipUnless(os.environ.get("WEFT_AXE"), "WEFT_AXE names no axe.min.js of npm's axe-core")
    def test_axe_finds_nothing(self):
        axe, violations = pathlib.Path(os.environ["WEFT_AXE"]).read_text(), []
        for dark in (False, True):
            for width in (1280, 390):
                pages = [(None, address) for address in (
                    "", "#run=runs/plain", "#run=runs/soft-plain&view=side", "#run=runs/img-src-x-onerror-alert-1-co",
                    "#compare=runs/plain&compare=runs/soft-plain&compare=runs/stills-plain")]
                failed = "#run=runs/step-0-01-position-0-0-0-falling-band"
                for page, address in [*pages, (self.sweep(), ""), (self.sweep(), failed)]:
                    self.open(address, width=width, dark=dark, page=page)
                    self.browser.run(axe)
                    self.browser.run("window.found = null; axe.run({preload: false}).then((result) => (window.found = result))")
                    found = self.browser.wait("return window.found && [...window.found.violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target).join(' ')}`), 'done']")
                    violations += [(address, width, dark, violation) for violation in found[:-1]]
        self.maxDiff = None
        self.assertEqual(violations, [])

    def test_pages_without_statistics_pictures_or_scene_say_so(self):
        self.open_run("img-src-x-onerror-alert-1-co")
        self.assertIn("no statistics", self.text(".notes"))
        self.assertIn("No effective scene", self.text("#content"))


if __name__ == "__main__":
    if webdriver.missing():
        print(f"skipped: the page is tested in a browser, which is not here: apt-get install {' '.join(webdriver.missing())}")
        sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
