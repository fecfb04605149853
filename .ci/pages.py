#!/usr/bin/env python3
"""Looks at report pages in Chromium: at 360, 820 and 1440 px, light and dark, at 1920 px, and printed.

    .ci/pages.py PAGE.html ...

A page fails where the console has an error, something is fetched, the page is wider than the window, a text lies
over another one in any unit, a picture or a card stays in its unit, a text has less contrast than WCAG AA asks for,
a picture has no title, a table is sorted wrongly, or something does not work by keyboard: the cursor of a picture, the
choice of a unit, the copy of a table. All that is folded is opened first. Without Chromium it says so and passes.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# the widths of a telephone, a tablet and a desk; of a wide desk; of A4 within its margins
VIEWS = [(width, scheme) for width in (360, 820, 1440) for scheme in ("light", "dark")]
VIEWS += [(1920, "light"), (672, "print")]

# Returns a list of complaints.
CHECK = r"""
(() => {
  const complaints = [];
  const root = document.documentElement;
  document.querySelectorAll('details').forEach(details => { details.open = true; });
  if (root.scrollWidth > innerWidth + 1) complaints.push(`the page is ${root.scrollWidth} px wide`);
  if (document.title === '' || root.lang === '') complaints.push('no title or no language');
  for (const title of document.querySelectorAll('svg > title')) {
    if (title.textContent.trim() === '') complaints.push('a picture has no title');
  }

  // the first alone believes in parts of a picture that are not drawn
  const shown = element => element.checkVisibility({ visibilityProperty: true, contentVisibilityAuto: true })
    && element.getClientRects().length > 0;
  const channel = c => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  const light = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
  const colour = text => (text.match(/[\d.]+/g) ?? [0, 0, 0]).map(Number);
  const contrast = (a, b) => {
    const [x, y] = [light(a), light(b)].sort((p, q) => q - p);
    return (x + 0.05) / (y + 0.05);
  };
  const paper = element => {
    for (let e = element; e; e = e.parentElement) {
      const c = colour(getComputedStyle(e).backgroundColor);
      if (c.length < 4 || c[3] > 0) return c;
    }
    return [255, 255, 255];
  };

  // where pictures are turned dark: invert(amount), then hue-rotate(180deg), as the filter effects module defines them
  const filtered = (svg, rgb) => {
    const inverted = /invert\(([\d.]+)\)/.exec(getComputedStyle(svg).filter);
    if (!inverted) return rgb;
    const [r, g, b] = rgb.slice(0, 3).map(c => 255 * Number(inverted[1]) + c * (1 - 2 * Number(inverted[1])));
    const rows = [[-0.574, 1.43, 0.144], [0.426, 0.43, 0.144], [0.426, 1.43, -0.856]];
    return rows.map(([p, q, s]) => Math.min(Math.max(p * r + q * g + s * b, 0), 255));
  };

  const look = () => {
    const texts = [];
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walk.nextNode(); node; node = walk.nextNode()) {
      const element = node.parentElement;
      if (!node.data.trim() || ['SCRIPT', 'STYLE', 'TITLE', 'DESC', 'CAPTION'].includes(element.tagName.toUpperCase())) continue;
      if (element.closest('title, desc, caption, .skip') || !shown(element)) continue;
      const range = document.createRange();
      range.selectNodeContents(node);
      const style = getComputedStyle(element);
      const svg = element.closest('svg');
      const [ink, on] = svg ? [colour(style.fill), [255, 255, 255]].map(rgb => filtered(svg, rgb))
        : [colour(style.color), paper(element)];
      const size = parseFloat(style.fontSize);
      const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
      const ratio = contrast(ink, on);
      const where = svg ? ' in a picture' : '';
      if (ratio < (large && !svg ? 3 : 4.5)) complaints.push(`contrast ${ratio.toFixed(2)}${where}: ${node.data.trim().slice(0, 40)}`);
      for (const box of range.getClientRects()) {
        if (box.width > 0 && box.height > 0) texts.push({ text: node.data.trim(), box, scroller: element.closest('.wide') });
      }
    }
    texts.sort((a, b) => a.box.top - b.box.top);
    const over = (a, b) => {
      // letters fill the middle of their boxes
      const inner = ({ box }) => [box.left + 1, box.top + 0.28 * box.height, box.right - 1, box.bottom - 0.28 * box.height];
      const [p, q] = [inner(a), inner(b)];
      return Math.min(p[2], q[2]) - Math.max(p[0], q[0]) > 1 && Math.min(p[3], q[3]) - Math.max(p[1], q[1]) > 1;
    };
    texts.forEach((a, k) => {
      for (const b of texts.slice(k + 1)) {
        if (b.box.top > a.box.bottom) break;
        // what is scrolled away lies behind nothing
        if (a.scroller === b.scroller && over(a, b)) complaints.push(`"${a.text.slice(0, 30)}" over "${b.text.slice(0, 30)}"`);
      }
    });
  };
  look();
  // the same in every other unit; what was wrong before is said once
  const units = [...document.querySelectorAll('.units select')];
  for (let k = 1; units.some(select => k < select.options.length); k += 1) {
    for (const select of units.filter(select => k < select.options.length)) {
      select.selectedIndex = k;
      select.dispatchEvent(new Event('change'));
    }
    look();
  }
  // in the last unit of all nothing is left in the first
  const left = units.map(select => select.options[0].value);
  for (const part of document.querySelectorAll('.headline, .cards, aside li, section > p, section > ul, summary, .note, figcaption, svg text')) {
    const words = part.textContent.match(new RegExp(`(\\d\\s|/ )(${left.join('|')})(?![\\p{L}²³·])`, 'gu'));
    if (left.length > 0 && words && shown(part)) complaints.push(`"${part.textContent.trim().slice(0, 60)}" stays in its unit`);
  }
  return [...new Set(complaints)];
})()
"""

# What a column is sorted into, ascending. A cell that begins with a slash continues the row above it, and goes with it.
SORTED = [
    ["–3", "0.2 ± 0.1", "< 1", "1", "/7", "12.5 ± 0.3", "110.3 ± 1.9", "/99", "1\u2009101 ± 105", "1.2·10⁴", "–"],
    ["1 : 10⁸", "1 : 8021", "3 : 1", "10⁴ : 1", "10²³ : 1"],
    ["2 joints", "10 joints", "base", "joint 2", "joint 10", "rod 5#"],
]
ORDER = "[...document.querySelectorAll('tbody td:last-child')].map(cell => cell.textContent)"


def sorting(browser, page):
    """Complaints about the sorting of tables: by keyboard, with the script of a page."""
    found = []
    for column in SORTED:
        column = [cell.replace("–3", "\u22123") for cell in column]
        rows = []
        for cell in column:
            rows.append([]) if not cell.startswith("/") else None
            rows[-1].append(cell.removeprefix("/"))
        # descending, what has no number stands last too
        last = [group for group in rows if group == ["–"]]
        descending = [group for group in reversed(rows) if group != ["–"]] + last
        mixed = rows[1::2] + rows[::2]
        kind = "left" if "base" in column else "number"
        cells = [(k == 0, cell) for group in mixed for k, cell in enumerate(group)]
        body = "".join(f"<tr><td class=left>{'row' if is_first else ''}<td class={kind}>{cell}" for is_first, cell in cells)
        table = f"<table><thead><tr><th>a<th class={kind}>b<tbody>{body.replace('< ', '&lt; ')}</table>"
        with tempfile.NamedTemporaryFile("w", suffix=".html", encoding="utf-8") as file:
            file.write(re.sub("<main>.*</main>", lambda _: f"<main><section>{table}</section></main>", page, flags=re.S))
            file.flush()
            browser.events.clear()
            browser.ask("Page.navigate", url=pathlib.Path(file.name).as_uri())
            browser.wait("Page.loadEventFired")
            browser.evaluate("document.querySelector('th:last-child button').focus()")
            for expected in (rows, descending, mixed):
                for kind_of_event in ("keyDown", "keyUp"):
                    key = {"key": "Enter", "code": "Enter", "windowsVirtualKeyCode": 13, "text": "\r"}
                    browser.ask("Input.dispatchKeyEvent", type=kind_of_event, **key)
                order, expected = browser.evaluate(ORDER), [cell for group in expected for cell in group]
                if order != expected:
                    found.append(f"sorted into {order}, not {expected}")
    return found


COPIES = """
navigator.clipboard.writeText = async text => { window.copied = text; };
document.querySelectorAll('details').forEach(details => { details.open = true; });
"""
SHOWN = "[...document.querySelectorAll('%s')].filter(e => e.checkVisibility() && e.getClientRects().length > 0)"


def by_keyboard(browser, url):
    """Complaints about what does not answer to keys on a page at a desk."""
    found = []
    browser.complaints(url, 1440, "light")
    browser.evaluate(COPIES)

    def pressed(selector, key, text=""):
        """Puts the focus onto the first of these that is seen and presses a key; false where there is none."""
        if not browser.evaluate(f"(e => {{ e?.focus(); return !!e && document.activeElement === e; }})({SHOWN % selector}[0])"):
            return False
        code = {"Enter": 13, "ArrowRight": 39, "ArrowDown": 40}[key]
        for kind in ("keyDown" if text else "rawKeyDown", "keyUp"):
            browser.ask("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, text=text)
        return True

    if browser.evaluate((SHOWN % "svg[data-panels][tabindex]") + ".length"):
        read = "[...document.querySelectorAll('output')].map(output => output.textContent).join('')"
        if not pressed("svg[data-panels][tabindex]", "ArrowRight") or ": " not in browser.evaluate(read):
            found.append("the cursor of a picture does not move by keyboard")
        first = browser.evaluate(read)
        if pressed("svg[data-panels][tabindex]", "ArrowRight") and browser.evaluate(read) == first:
            found.append("the cursor of a picture stands still")
    unit = "document.querySelector('th button.unit')?.textContent"
    before = browser.evaluate(unit)
    if before is not None and pressed("th button.unit", "Enter", "\r") and browser.evaluate(unit) == before:
        found.append("a unit is not chosen by keyboard")
    if browser.evaluate("!!document.querySelector('.files button')"):
        heads = "document.querySelector('.files button').closest('details').querySelectorAll('thead th').length"
        pressed(".files button", "Enter", "\r")
        copied = browser.evaluate("window.copied ?? ''")
        if copied.count("\n") < 2 or copied.split("\n")[0].count(",") < browser.evaluate(heads) - 1:
            found.append(f"a table is copied as {copied[:40]!r}")
    return found


class Browser:
    """Chromium by its pipe: one message after another, each ended by a zero byte."""

    def __init__(self, program):
        to_browser, from_us = os.pipe()
        to_us, from_browser = os.pipe()

        def in_browser():
            # out of the way of 3 and 4 first
            reading, writing = os.dup(to_browser), os.dup(from_browser)
            os.dup2(reading, 3)
            os.dup2(writing, 4)

        arguments = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-pipe"]
        self.process = subprocess.Popen(
            [program, *arguments, "about:blank"],
            preexec_fn=in_browser,
            close_fds=False,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)
        self.out, self.read = os.fdopen(from_us, "wb", 0), os.fdopen(to_us, "rb", 0)
        self.rest, self.number, self.session, self.events = b"", 0, None, []

    def message(self):
        while b"\0" not in self.rest:
            more = self.read.read(65536)
            if not more:
                sys.exit("the browser has gone")
            self.rest += more
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def ask(self, method, **parameters):
        self.number += 1
        question = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            question["sessionId"] = self.session
        self.out.write(json.dumps(question).encode() + b"\0")
        while True:
            message = self.message()
            if message.get("id") == self.number:
                if "error" in message:
                    sys.exit(f"{method}: {message['error']}")
                return message["result"]
            self.events.append(message)

    def wait(self, method):
        while not any(event.get("method") == method for event in self.events):
            self.events.append(self.message())

    def open(self):
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self.ask(f"{domain}.enable")

    def evaluate(self, expression):
        answer = self.ask("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in answer:
            sys.exit(str(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def complaints(self, url, width, scheme):
        self.events.clear()
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
        media, colours = ("print", "light") if scheme == "print" else ("screen", scheme)
        feature = {"name": "prefers-color-scheme", "value": colours}
        self.ask("Emulation.setEmulatedMedia", media=media, features=[feature])
        self.ask("Page.navigate", url=url)
        self.wait("Page.loadEventFired")
        found = self.evaluate(CHECK)
        for event in self.events:
            method, event = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                found.append(f"script: {event['exceptionDetails'].get('text')}")
            elif method == "Log.entryAdded" and event["entry"]["level"] == "error":
                found.append(f"console: {event['entry']['text']}")
            elif method == "Network.requestWillBeSent" and event["request"]["url"] != url:
                found.append(f"fetched: {event['request']['url'][:80]}")
        return found


def main():
    program = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if program is None:
        print("pages: NOT TESTED, there is no Chromium here")
        return
    browser = Browser(program)
    browser.open()
    failed = 0
    for complaint in sorting(browser, pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")):
        print(complaint)
        failed += 1
    for page in sys.argv[1:]:
        url = pathlib.Path(page).resolve().as_uri()
        for complaint in by_keyboard(browser, url):
            print(f"{page}: {complaint}")
            failed += 1
        for width, scheme in VIEWS:
            for complaint in browser.complaints(url, width, scheme):
                print(f"{page}, {width} px, {scheme}: {complaint}")
                failed += 1
    browser.process.kill()
    print(f"pages: {len(sys.argv) - 1} looked at, {failed} complaints")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
