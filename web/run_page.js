// Reading the charts of a run's report with pointer or finger: a line in every chart at the same
// time, and a box with the values. Also enlarges pictures. Needs nothing but the page.
(() => {
  const data = JSON.parse(document.getElementById('chart-data').textContent);
  const middles = data.from.map((from, i) => (from + data.to[i]) / 2);
  const tip = document.createElement('div');
  tip.id = 'tip';
  tip.setAttribute('role', 'status');
  document.body.append(tip);
  const boxes = [...document.querySelectorAll('.hover')].map((box) => {
    const svg = box.querySelector('svg');
    const cursor = document.createElementNS('http://www.w3.org/2000/svg', 'line');
    cursor.setAttribute('class', 'cursor');
    cursor.setAttribute('y1', box.dataset.top);
    cursor.setAttribute('y2', box.dataset.bottom);
    cursor.style.display = 'none';
    svg.append(cursor);
    return {box, svg, cursor};
  });
  const begin = data.from[0];
  const span = data.to[data.to.length - 1] - begin || 1;
  const number = (value) => String(Number(value.toPrecision(4)));

  function nearest(time) {
    let low = 0;
    let high = middles.length - 1;
    while (high - low > 1) {
      const half = (low + high) >> 1;
      if (middles[half] < time) low = half; else high = half;
    }
    return time - middles[low] < middles[high] - time ? low : high;
  }

  function range(low, high) {
    return high === undefined || high === low ? number(low) : `${number(low)} \u2026 ${number(high)}`;
  }

  function lineText(line, i) {
    if (line.low[i] === null) return `${line.name}: none`;
    let text = `${line.name}: ${range(line.low[i], line.high && line.high[i])}`;
    if (line.unit) text += ` ${line.unit}`;
    if (line.bandLow) text += ` (95 %: ${range(line.bandLow[i], line.bandHigh[i])})`;
    return text;
  }

  function rowText(box, svg, event, i) {
    const area = svg.getBoundingClientRect();
    const y = (event.clientY - area.top) / area.height * svg.viewBox.baseVal.height;
    const share = (y - box.dataset.top) / (box.dataset.bottom - box.dataset.top);
    const row = Math.floor(share * data.rows.length);
    if (row < 0 || row >= data.rows.length) return [];
    const status = data.rows[row][i];
    return [`marker ${data.markers[row]}: ${status === '-' ? 'not known' : data.statuses[status]}`];
  }

  function place(i) {
    const frames = data.first[i] === data.last[i] ? `frame ${data.first[i]}` :
      `frames ${data.first[i]} \u2013 ${data.last[i]}`;
    return `${frames}, ${range(data.from[i], data.to[i])} s`;
  }

  function show(box, svg, event) {
    const area = svg.getBoundingClientRect();
    const x = (event.clientX - area.left) / area.width * svg.viewBox.baseVal.width;
    const share = (x - box.dataset.left) / box.dataset.width;
    if (share < -0.02 || share > 1.02) return hide();
    const i = nearest(begin + share * span);
    const key = box.dataset.chart;
    const lines = key === 'markers' ? rowText(box, svg, event, i) :
      data.charts[key].map((line) => lineText(line, i));
    tip.replaceChildren(...[place(i), ...lines].map((text, row) => {
      const line = document.createElement('div');
      line.textContent = text;
      if (row === 0) line.className = 'soft';
      return line;
    }));
    tip.style.display = 'block';
    const left = event.clientX + 16 + tip.offsetWidth > innerWidth;
    tip.style.left = `${left ? Math.max(4, event.clientX - 16 - tip.offsetWidth) : event.clientX + 16}px`;
    tip.style.top = `${Math.min(event.clientY + 14, innerHeight - tip.offsetHeight - 4)}px`;
    for (const other of boxes) {
      const at = Number(other.box.dataset.left) +
        (middles[i] - begin) / span * other.box.dataset.width;
      other.cursor.setAttribute('x1', at);
      other.cursor.setAttribute('x2', at);
      other.cursor.style.display = '';
    }
  }

  function hide() {
    tip.style.display = 'none';
    for (const {cursor} of boxes) cursor.style.display = 'none';
  }

  for (const {box, svg} of boxes) {
    box.addEventListener('pointermove', (event) => show(box, svg, event));
    box.addEventListener('pointerdown', (event) => show(box, svg, event));
    box.addEventListener('pointerleave', hide);
  }
  for (const picture of document.querySelectorAll('.pictures img')) {
    picture.addEventListener('click', () => picture.closest('figure').classList.toggle('wide'));
  }
})();
