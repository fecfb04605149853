// What helps a reader; the page says everything without it.
'use strict';
(() => {
  const make = (name, text, className) => {
    const element = document.createElement(name);
    element.textContent = text;
    if (className) element.className = className;
    return element;
  };
  const number = cell => {
    const text = cell.textContent.replace(/[\s\u2007\u2008]/g, '').replace('\u2212', '-');
    return /^[-+]?[\d.]+(e[-+]?\d+)?$/i.test(text) ? Number(text) : NaN;
  };

  // sorting: ascending, descending, as it was
  const sort = (table, column, button) => {
    const body = table.tBodies[0];
    const rows = [...body.rows];
    rows.forEach((row, k) => { row.dataset.at ??= k; });
    const next = { ascending: 'descending', descending: 'none' }[button.parentElement.ariaSort] ?? 'ascending';
    for (const cell of table.tHead.rows[0].cells) cell.ariaSort = 'none';
    button.parentElement.ariaSort = next;
    const sign = next === 'descending' ? -1 : 1;
    rows.sort((a, b) => {
      if (next === 'none') return a.dataset.at - b.dataset.at;
      const [x, y] = [a, b].map(row => row.cells[column]);
      const difference = number(x) - number(y);
      return sign * (Number.isNaN(difference) ? x.textContent.localeCompare(y.textContent) : difference);
    });
    body.append(...rows);
  };

  // units that people switch between, as factors
  const UNITS = {
    '\u00b5m': [['\u00b5m', 1], ['mm', 1e-3], ['mil', 1 / 25.4]],
    '\u00b5rad': [['\u00b5rad', 1], ['mrad', 1e-3], ['\u00b0', 1.8e-4 / Math.PI]],
    'mm': [['mm', 1], ['in', 1 / 25.4]],
    'N': [['N', 1], ['lbf', 1 / 4.4482216152605]],
  };
  const digits = text => text.replace(/e.*$/i, '').replace(/[^\d]/g, '').replace(/^0+/, '').length || 1;
  const switchUnit = (table, column, button) => {
    const units = UNITS[button.dataset.unit];
    const at = (Number(button.dataset.at ?? 0) + 1) % units.length;
    button.dataset.at = at;
    button.textContent = units[at][0];
    for (const row of table.tBodies[0].rows) {
      const cell = row.cells[column];
      if (!cell) continue;
      cell.dataset.text ??= cell.textContent;
      cell.dataset.value ??= number(cell);
      const value = Number(cell.dataset.value);
      if (Number.isNaN(value)) continue;
      const scaled = Number((value * units[at][1]).toPrecision(digits(cell.dataset.text)));
      cell.textContent = at === 0 ? cell.dataset.text : String(scaled).replace('-', '\u2212');
    }
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
      cell.prepend(button);
      if (unit && UNITS[unit.textContent]) {
        const own = make('button', unit.textContent, 'unit');
        own.dataset.unit = unit.textContent;
        own.title = 'Another unit';
        own.addEventListener('click', () => switchUnit(table, column, own));
        unit.replaceWith(own);
      }
    });
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

  // a cursor that reads the axes, in all pictures with the same abscissa
  const pictures = [...document.querySelectorAll('svg[data-panels]')].map(svg => ({
    svg, panels: JSON.parse(svg.dataset.panels), output: svg.closest('figure').querySelector('output'),
  }));
  const SVG = 'http://www.w3.org/2000/svg';
  const at = (from, to, log, share) => log ? from * (to / from) ** share : from + share * (to - from);
  const share = (from, to, log, value) => log ? Math.log(value / from) / Math.log(to / from) : (value - from) / (to - from);
  const short = value => Number(value.toPrecision(4)).toString().replace('-', '\u2212');
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
  for (const picture of pictures) {
    picture.svg.addEventListener('pointerleave', clear);
    picture.svg.addEventListener('pointermove', event => {
      clear();
      const box = picture.svg.getBoundingClientRect();
      const scale = picture.svg.viewBox.baseVal.width / box.width;
      const [px, py] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
      const panel = picture.panels.find(p => px >= p.box[0] && px <= p.box[2] && py >= p.box[1] && py <= p.box[3]);
      if (!panel) return;
      const [left, top, right, bottom] = panel.box;
      const x = panel.x && at(...panel.x, (px - left) / (right - left));
      const y = panel.y && at(...panel.y, (bottom - py) / (bottom - top));
      if (panel.y) rule(picture.svg, left, py, right, py);
      picture.output.textContent = [[panel.xlabel, x], [panel.ylabel, y]].filter(([, value]) => value !== null)
        .map(([label, value]) => `${label}: ${short(value)}`).join('   ');
      if (x === null) return;
      for (const other of pictures) for (const p of other.panels) {
        if (!p.x || p.xlabel !== panel.xlabel) continue;
        const own = share(...p.x, x);
        if (!(own >= 0 && own <= 1)) continue;
        const along = p.box[0] + own * (p.box[2] - p.box[0]);
        rule(other.svg, along, p.box[1], along, p.box[3]);
      }
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
