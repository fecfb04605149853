// What helps a reader; the page says everything without it.
'use strict';
(() => {
  const make = (name, text, className) => {
    const element = document.createElement(name);
    element.textContent = text;
    if (className) element.className = className;
    return element;
  };
  const plain = text => text.replace(/[\s\u2007\u2008\u2009]/g, '').replaceAll('\u2212', '-');
  const number = cell => {
    const text = plain(cell.textContent);
    return /^[-+]?[\d.]+(e[-+]?\d+)?$/i.test(text) ? Number(text) : NaN;
  };
  // what a cell is sorted by, however its number is written: "a ± b", "a (b to c)", "< a", "10³ : 1",
  // "1.2·10³", "a of b"; NaN of words
  const RAISED = '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079';
  const SIZE = /^([-+]?\d*\.?\d+(?:e[-+]?\d+)?)(?:[×·]10\^(-?\d+))?(?:\^(-?\d+))?/i;
  const size = text => {
    const raised = text.replace(/\u207b?[\u2070\u00b9\u00b2\u00b3\u2074-\u2079]+/g,
      power => `^${[...power].map(c => c === '\u207b' ? '-' : RAISED.indexOf(c)).join('')}`);
    const found = SIZE.exec(raised);
    if (!found) return [NaN, raised];
    const [all, digits, ten, power] = found;
    return [Number(digits) ** Number(power ?? 1) * 10 ** Number(ten ?? 0), raised.slice(all.length)];
  };
  const key = cell => {
    const text = plain(cell.textContent);
    const [, bound, rest] = /^([<>≤≥≈~]?)(.*)$/u.exec(text);
    const [value, after] = size(rest);
    if (after.startsWith(':')) return value / size(after.slice(1))[0];
    // words may begin with a number too
    const ends = /^($|[%°±(→–]|to\d|of\d)/.test(after) || cell.className === 'number';
    return ends ? value * { '<': 1 - 1e-12, '>': 1 + 1e-12 }[bound] || value : NaN;
  };

  // sorting: ascending, descending, as it was. What has no number stands last, and a row that
  // continues the one above it goes where that goes
  const words = new Intl.Collator('en', { numeric: true });
  const sort = (table, column, button) => {
    const body = table.tBodies[0];
    const rows = [...body.rows];
    rows.forEach((row, k) => { row.dataset.at ??= k; });
    const next = { ascending: 'descending', descending: 'none' }[button.parentElement.ariaSort] ?? 'ascending';
    for (const cell of table.tHead.rows[0].cells) cell.ariaSort = 'none';
    button.parentElement.ariaSort = next;
    const sign = next === 'descending' ? -1 : 1;
    rows.sort((a, b) => a.dataset.at - b.dataset.at);
    const groups = [];
    for (const row of rows) {
      const continues = groups.length && /^$|^its /.test(row.cells[0].textContent.trim());
      if (continues) groups.at(-1).push(row); else groups.push([row]);
    }
    if (next !== 'none') {
      groups.sort(([a], [b]) => {
        const [x, y] = [a, b].map(row => row.cells[column]);
        const [p, q] = [key(x), key(y)];
        const [noX, noY] = [Number.isNaN(p), Number.isNaN(q)];
        return noX && noY ? sign * words.compare(x.textContent, y.textContent) : noX - noY || sign * (p - q);
      });
    }
    body.append(...groups.flat());
  };

  // units: of all tables and pictures at once. One of 'a' in units of its choice, and 'a/b' part by part
  const UNITS = JSON.parse(document.body.dataset.units);
  const chosen = {};
  const choice = part => UNITS[part]?.[chosen[part] ?? 0] ?? [part, 1];
  const now = unit => unit.split('/').map(part => choice(part)[0]).join('/');
  const factor = unit => unit.split('/').map(part => choice(part)[1]).reduce((above, below) => above / below);
  const bases = unit => unit.split('/').filter(part => UNITS[part]);
  // every number of a text, with as many digits as it had
  const inUnit = (text, unit, least = 1) => factor(unit) === 1 ? text
    : text.replace(/\d[\d\u2009]*(\.\d+)?(e[-\u2212]?\d+)?/gi, found => {
      const digits = found.replace(/e.*$/i, '').replace(/[^\d]/g, '').replace(/^0+/, '').length || 1;
      const value = Number(found.replaceAll('\u2009', '').replace('\u2212', '-')) * factor(unit);
      const short = value.toPrecision(Math.min(Math.max(digits, least), 15));
      return (/e/.test(short) ? String(Number(short)) : short).replace('e-', 'e\u2212');
    });
  const switched = [];
  const changes = (element, unit) => {
    const text = element.textContent;
    switched.push(() => { element.textContent = inUnit(text, unit); });
  };
  // within words: "14 to 3.0 µm", "Ø 32 × 1 mm" (where 1 is exact), "x / mm"
  const [NUMBER, BETWEEN] = ['\\d[\\d\u2009]*(?:\\.\\d+)?', '(?:,\\s|\\s(?:±|→|×|–|to|and|or)\\s)'];
  const UNIT = `((?:${Object.keys(UNITS).join('|')})(?:/(?:\\([\\p{L}·]+\\)|[\\p{L}µ]+))?)(?![\\p{L}\\d²³·/]|\\sm\\b)`;
  const QUANTITY = new RegExp(`((?:${NUMBER}${BETWEEN})*${NUMBER})(\\s)${UNIT}`, 'gu');
  const LABEL = new RegExp(` / ${UNIT}(?=\\s*$)`, 'gu');
  const inWords = text => text
    .replace(QUANTITY, (_, numbers, space, unit) => inUnit(numbers, unit, 3) + space + now(unit))
    .replace(LABEL, (_, unit) => ` / ${now(unit)}`);
  const WORDS = '.headline, .cards, aside li, section > p, section > ul, summary, .note, td.left';
  const present = new Set();
  const switches = node => {
    const text = node.data;
    const units = [...text.matchAll(QUANTITY), ...text.matchAll(LABEL)].flatMap(found => bases(found.at(-1)));
    units.forEach(unit => present.add(unit));
    if (units.length) switched.push(() => { node.data = inWords(text); });
  };
  const choose = (unit, at) => {
    chosen[unit] = at % UNITS[unit].length;
    switched.forEach(change => change());
  };

  const csv = table => [...table.rows].map(row => [...row.cells].map(cell => {
    const value = number(cell);
    const text = Number.isNaN(value) ? cell.innerText.trim().replace(/\s*\n\s*/g, ' ') : String(value);
    return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  }).join(',')).join('\n') + '\n';

  for (const table of document.querySelectorAll('table')) {
    [...table.tHead.rows[0].cells].forEach((cell, column) => {
      const unit = cell.querySelector('.unit');
      const button = make('button', cell.firstChild?.textContent ?? '');
      button.title = 'Sort';
      button.addEventListener('click', () => sort(table, column, button));
      cell.firstChild?.remove();
      // a heading is repeated on every sheet of paper, but no button is
      cell.prepend(button, make('span', button.textContent, 'printed'));
      const [base] = bases(unit?.textContent ?? '');
      if (base) {
        const own = make('button', unit.textContent, 'unit');
        own.title = 'Another unit';
        own.addEventListener('click', () => choose(base, (chosen[base] ?? 0) + 1));
        switched.push(() => { own.textContent = now(unit.textContent); });
        for (const row of table.tBodies[0].rows) if (row.cells[column]) changes(row.cells[column], unit.textContent);
        const printed = make('span', unit.textContent, 'unit printed');
        switched.push(() => { printed.textContent = own.textContent; });
        unit.replaceWith(own, printed);
      }
    });
    // units by row: a button where the unit stands, for the numbers of its row
    const heads = [...table.tHead.rows[0].cells];
    const names = heads.findIndex(head => head.dataset.rowUnit === 'names');
    for (const row of names < 0 ? [] : table.tBodies[0].rows) {
      const unit = row.cells[names].textContent;
      const [base] = bases(unit);
      if (!base) continue;
      const own = make('button', unit, 'unit');
      own.title = 'Another unit';
      own.addEventListener('click', () => choose(base, (chosen[base] ?? 0) + 1));
      switched.push(() => { own.textContent = now(unit); });
      row.cells[names].replaceChildren(own);
      heads.forEach((head, column) => { if (head.dataset.rowUnit === 'has') changes(row.cells[column], unit); });
    }
    const files = table.closest('details')?.querySelector('.files');
    if (files && navigator.clipboard) {
      const copy = make('button', 'copy as CSV');
      copy.addEventListener('click', async () => {
        await navigator.clipboard.writeText(csv(table));
        copy.textContent = 'copied';
      });
      files.append(' \u00b7 ', copy);
    }
  }

  for (const group of document.querySelectorAll('g[data-of]')) {
    const { of, unit } = group.dataset;
    switched.push(() => group.setAttribute('display', now(of) === unit ? 'inline' : 'none'));
  }
  for (const group of document.querySelectorAll('g[data-number]')) changes(group.firstElementChild, group.dataset.number);

  // what is said and shown; a command is as it was typed
  for (const part of document.querySelectorAll(`${WORDS}, figcaption, svg text`)) {
    if (part.closest('g[data-of], g[data-number]')) continue;
    const texts = document.createTreeWalker(part, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) if (!texts.currentNode.parentElement.closest('code, .files, .units')) switches(texts.currentNode);
  }

  // one choice for each unit of the page, after its contents
  for (const unit of document.querySelectorAll('button.unit')) bases(unit.textContent).forEach(one => present.add(one));
  for (const group of document.querySelectorAll('g[data-of]')) bases(group.dataset.of).forEach(unit => present.add(unit));
  if (present.size) {
    const bar = make('p', 'Units ', 'units');
    for (const unit of Object.keys(UNITS).filter(unit => present.has(unit))) {
      const select = make('select', '');
      select.setAttribute('aria-label', `${unit} in`);
      UNITS[unit].forEach(([name]) => select.append(make('option', name)));
      select.addEventListener('change', () => choose(unit, select.selectedIndex));
      switched.push(() => { select.selectedIndex = chosen[unit] ?? 0; });
      bar.append(select, ' ');
    }
    document.querySelector('main > section').before(bar);
  }

  // a cursor that reads the axes, in all pictures with the same abscissa; by pointer or arrow keys
  const pictures = [...document.querySelectorAll('svg[data-panels]')].map(svg => ({
    svg, panels: JSON.parse(svg.dataset.panels), output: svg.closest('figure').querySelector('output'),
  }));
  const SVG = 'http://www.w3.org/2000/svg';
  const at = (from, to, log, share) => log ? from * (to / from) ** share : from + share * (to - from);
  const share = (from, to, log, value) => log ? Math.log(value / from) / Math.log(to / from) : (value - from) / (to - from);
  // in steps of a thousandth of the axis, however far from zero it is
  const short = (value, [from, to, log]) => {
    const step = log ? Math.abs(value) : Math.abs(to - from);
    const decimals = Math.min(Math.max(3 - Math.floor(Math.log10(step || 1)), 0), 20);
    return Number(value.toFixed(decimals)).toString().replace('-', '\u2212');
  };
  const clear = () => {
    document.querySelectorAll('line.cursor').forEach(line => line.remove());
    pictures.forEach(picture => { picture.output.textContent = ''; });
  };
  const rule = (svg, x1, y1, x2, y2) => {
    const line = document.createElementNS(SVG, 'line');
    const attributes = { x1, y1, x2, y2, class: 'cursor', stroke: '#777777', 'stroke-width': 8, 'pointer-events': 'none' };
    for (const [name, value] of Object.entries(attributes)) line.setAttribute(name, value);
    svg.append(line);
  };
  const point = (picture, panel, px, py) => {
    clear();
    const [left, top, right, bottom] = panel.box;
    const x = panel.x && at(...panel.x, (px - left) / (right - left));
    const y = panel.y && at(...panel.y, (bottom - py) / (bottom - top));
    if (panel.y) rule(picture.svg, left, py, right, py);
    const read = (label, value, unit, [from, to, log]) => {
      const by = unit ? factor(unit) : 1;
      return `${unit ? label.replace(unit, now(unit)) : label}: ${short(value * by, [from * by, to * by, log])}`;
    };
    picture.output.textContent = [[panel.xlabel, x, panel.xunit, panel.x], [panel.ylabel, y, panel.yunit, panel.y]]
      .filter(([, value]) => value !== null).map(axis => read(...axis)).join('   ');
    if (x === null) return;
    for (const other of pictures) for (const p of other.panels) {
      if (!p.x || p.xlabel !== panel.xlabel) continue;
      const own = share(...p.x, x);
      if (!(own >= 0 && own <= 1)) continue;
      const along = p.box[0] + own * (p.box[2] - p.box[0]);
      rule(other.svg, along, p.box[1], along, p.box[3]);
    }
  };
  // by keyboard: in steps of a fiftieth, from panel to panel beyond an edge
  const STEP = 0.02;
  const STEPS = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, -STEP], ArrowDown: [0, STEP] };
  for (const picture of pictures) {
    const panels = picture.panels.filter(panel => panel.x || panel.y);
    let [which, along, down] = [0, 0.5, 0.5];
    const show = () => {
      const [left, top, right, bottom] = panels[which].box;
      point(picture, panels[which], left + along * (right - left), top + down * (bottom - top));
    };
    if (panels.length) picture.svg.tabIndex = 0;
    picture.svg.addEventListener('blur', clear);
    picture.svg.addEventListener('keydown', event => {
      if (event.key === 'Escape') clear();
      const step = panels.length && STEPS[event.key];
      if (!step) return;
      event.preventDefault();
      [along, down] = [along + step[0], Math.min(Math.max(down + step[1], 0), 1)];
      const next = which + Math.sign(step[0]);
      if ((along < 0 || along > 1) && panels[next]) [which, along] = [next, along < 0 ? 1 : 0];
      along = Math.min(Math.max(along, 0), 1);
      show();
    });
    picture.svg.addEventListener('pointerleave', clear);
    picture.svg.addEventListener('pointermove', event => {
      const box = picture.svg.getBoundingClientRect();
      const scale = picture.svg.viewBox.baseVal.width / box.width;
      const [px, py] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
      const panel = picture.panels.find(p => px >= p.box[0] && px <= p.box[2] && py >= p.box[1] && py <= p.box[3]);
      if (panel) point(picture, panel, px, py); else clear();
    });
  }

  // all is printed
  const opened = [];
  addEventListener('beforeprint', () => document.querySelectorAll('details:not([open])').forEach(details => {
    details.open = true;
    opened.push(details);
  }));
  addEventListener('afterprint', () => { opened.splice(0).forEach(details => { details.open = false; }); });
})();
