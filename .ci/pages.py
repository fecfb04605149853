#!/usr/bin/env python3
"""Looks at report pages in Chromium: at 360, 820 and 1440 px, light and dark, and printed.

    .ci/pages.py PAGE.html ...

A page fails where the console has an error, something is fetched, the page is wider than the window, a text lies
over another one in any unit, a picture or a card stays in its unit, or a text has less contrast than WCAG AA asks
for. Without Chromium it says so and passes.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

# the widths of a telephone, a tablet and a desk; of A4 within its margins
VIEWS = [(width, scheme) for width in (360, 820, 1440) for scheme in ("light", "dark")] + [(672, "print")]

# Returns a list of complaints.
CHECK = r"""
(() => {
  const complaints = [];
  const root = document.documentElement;
  if (root.scrollWidth > innerWidth + 1) complaints.push(`the page is ${root.scrollWidth} px wide`);
  if (document.title === '' || root.lang === '') complaints.push('no title or no language');

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
      const [ink, on] = svg ? [colour(style.fill), [255, 255, 255]] : [colour(style.color), paper(element)];
      const size = parseFloat(style.fontSize);
      const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
      const ratio = contrast(ink, on);
      if (!svg && ratio < (large ? 3 : 4.5)) complaints.push(`contrast ${ratio.toFixed(2)}: ${node.data.trim().slice(0, 40)}`);
      if (svg && ratio < 3) complaints.push(`contrast ${ratio.toFixed(2)} in a picture: ${node.data.trim().slice(0, 40)}`);
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

    def complaints(self, url, width, scheme):
        self.events.clear()
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
        media, colours = ("print", "light") if scheme == "print" else ("screen", scheme)
        feature = {"name": "prefers-color-scheme", "value": colours}
        self.ask("Emulation.setEmulatedMedia", media=media, features=[feature])
        self.ask("Page.navigate", url=url)
        self.wait("Page.loadEventFired")
        answer = self.ask("Runtime.evaluate", expression=CHECK, returnByValue=True)
        if "exceptionDetails" in answer:
            sys.exit(str(answer["exceptionDetails"]))
        found = list(answer["result"]["value"])
        for event in self.events:
            method, of = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                found.append(f"script: {of['exceptionDetails'].get('text')}")
            elif method == "Log.entryAdded" and of["entry"]["level"] == "error":
                found.append(f"console: {of['entry']['text']}")
            elif method == "Network.requestWillBeSent" and of["request"]["url"] != url:
                found.append(f"fetched: {of['request']['url'][:80]}")
        return found


def main():
    program = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if program is None:
        print("pages: NOT TESTED, there is no Chromium here")
        return
    browser = Browser(program)
    browser.open()
    failed = 0
    for page in sys.argv[1:]:
        url = pathlib.Path(page).resolve().as_uri()
        for width, scheme in VIEWS:
            for complaint in browser.complaints(url, width, scheme):
                print(f"{page}, {width} px, {scheme}: {complaint}")
                failed += 1
    browser.process.kill()
    print(f"pages: {len(sys.argv) - 1} looked at, {failed} complaints")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
