// Fills the live page of a run with what the program sends, and sends it what the buttons ask.
// Needs nothing but the page; the 3-D view, window.softforceBody, may be there or not.
(() => {
  const SPAN = 60;            // s, of the plot
  const RETRY = 1000;         // ms, between attempts to connect
  const SILENCE = 12000;      // ms without a sign of life: the connection is lost
  const HUES = 6;
  const at = (id) => document.getElementById(id);
  const number = (value, digits = 3) =>
    value === null || value === undefined ? '\u2013' : String(Number(value.toPrecision(digits)));

  let state = null;      // the newest
  let run = null;        // which run it is of
  let points = [];       // [time, [[name, x, y, z, norm, sd of these…], …]], oldest first
  let names = [];        // of forces, in the order of their colours
  let body = null;
  let noBody = window.softforceBody ? '' : 'This softforce was built without the 3-D view.';
  let heard = 0;

  // ---- the token: from the address's fragment, which browsers send to nobody, or typed
  const fragment = new URLSearchParams(location.hash.slice(1));
  if (fragment.has('token')) {
    sessionStorage.setItem('token', fragment.get('token'));
    history.replaceState(null, '', location.pathname);
  }
  at('token').value = sessionStorage.getItem('token') ?? '';
  at('token').addEventListener('input', () => {
    sessionStorage.setItem('token', at('token').value.trim());
    say('');
  });

  function say(text, bad = false) {
    at('said').textContent = text;
    at('said').className = text && bad ? 'verdict bad' : 'soft';
  }

  async function post(name) {
    const token = at('token').value.trim();
    try {
      const answer = await fetch(`/${name}`, {
        method: 'POST', headers: {'X-Softforce-Token': token}, signal: AbortSignal.timeout(8000),
      });
      if (answer.ok) {
        say(name === 'tare' ? 'taring: keep the load still' : '');
      } else if (answer.status === 403) {
        say(token ? 'wrong token: it is printed where the run was started' :
          'enter the token that was printed where the run was started', true);
        at('token').focus();
      } else {
        say(`refused (${answer.status})`, true);
      }
    } catch {
      say('no answer', true);
    }
  }
  at('controls').addEventListener('submit', (event) => event.preventDefault());
  for (const button of document.querySelectorAll('[data-post]')) {
    button.addEventListener('click', () => post(button.dataset.post));
  }
  at('picture').addEventListener('click', () => at('picture').classList.toggle('large'));
  at('part').addEventListener('change', plot);

  // ---- the plot
  function svg(tag, attributes, text) {
    const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    if (text !== undefined) made.textContent = text;
    return made;
  }

  function ticks(low, high, count) {
    const rough = (high - low) / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((digit) => digit * power).find((one) => one >= rough);
    const made = [];
    for (let k = Math.ceil(low / step); k * step <= high; ++k) made.push(k * step);
    return made;
  }

  function plot() {
    const part = Number(at('part').value);
    const left = 52, right = 550, top = 12, bottom = 270;
    const last = points.length > 0 ? points[points.length - 1][0] : 1;
    const first = points.length > 0 ? Math.max(points[0][0], last - SPAN) : 0;
    const begin = Math.min(first, last - 1);
    let low = 0, high = 0.01;
    const lines = names.map((name) => points.flatMap(([time, forces]) => {
      const force = forces.find((one) => one[0] === name);
      if (!force) return [[time, null]];
      const value = force[1 + part];
      const half = 1.96 * force[5 + part];
      const under = part === 3 ? Math.max(0, value - half) : value - half;
      low = Math.min(low, under);
      high = Math.max(high, value + half);
      return [[time, value, under, value + half]];
    }));
    [low, high] = [low < 0 ? 1.08 * low : 0, 1.08 * high];
    const x = (time) => (left + (time - begin) / (last - begin) * (right - left)).toFixed(1);
    const y = (value) => (bottom - (value - low) / (high - low) * (bottom - top)).toFixed(1);
    const parts = [svg('rect', {class: 'paper', x: left, y: top, width: right - left,
                                height: bottom - top})];
    for (const value of ticks(low, high, 5)) {
      parts.push(svg('line', {class: 'grid', x1: left, x2: right, y1: y(value), y2: y(value)}));
      parts.push(svg('text', {x: left - 6, y: Number(y(value)) + 4, 'text-anchor': 'end'},
                     number(value)));
    }
    for (const time of ticks(begin, last, 6)) {
      parts.push(svg('text', {x: x(time), y: bottom + 18, 'text-anchor': 'middle'},
                     number(time, 5)));
    }
    parts.push(svg('text', {x: 4, y: top + 4}, 'N'), svg('text', {x: right - 4, y: 298,
      'text-anchor': 'end'}, 's'));
    lines.forEach((line, k) => {
      // Where the force was not there, the line is broken.
      const pieces = [];
      let piece = null;
      for (const point of line) {
        if (point[1] === null) {
          piece = null;
        } else {
          if (!piece) pieces.push(piece = []);
          piece.push(point);
        }
      }
      for (const one of pieces) {
        const band = [...one.map(([time, , , up]) => `${x(time)} ${y(up)}`),
                      ...one.slice().reverse().map(([time, , down]) => `${x(time)} ${y(down)}`)];
        parts.push(svg('path', {class: `band c${k % HUES}`, d: `M${band.join('L')}Z`}));
        parts.push(svg('path', {
          class: `line c${k % HUES}`,
          d: `M${one.map(([time, value]) => `${x(time)} ${y(value)}`).join('L')}`,
        }));
      }
    });
    parts.push(svg('rect', {class: 'frame', x: left, y: top, width: right - left,
                            height: bottom - top}));
    at('forces').replaceChildren(...parts);
    at('forces').dataset.points = points.length;
  }

  function addPoint(time, forces) {
    if (points.length > 0 && time <= points[points.length - 1][0]) return;
    points.push([time, forces]);
    while (points[0][0] < time - SPAN) points.shift();
    keepNames(forces);
  }

  function keepNames(forces) {
    for (const [name] of forces) if (!names.includes(name)) names.push(name);
  }

  async function loadHistory() {
    const answer = await fetch('/history');
    if (!answer.ok) return;
    const {points: past} = await answer.json();
    const newest = past.length > 0 ? past[past.length - 1][0] : -Infinity;
    points = [...past, ...points.filter(([time]) => time > newest)];
    names = [];
    for (const [, forces] of points) keepNames(forces);
    plot();
  }

  // ---- pictures and body: the next is asked for when the last is there
  async function newest(path) {
    const answer = await fetch(path);
    return answer.ok ? answer : null;
  }

  let fetching = false;
  async function look() {
    if (fetching || document.hidden || state.frame < 0) return;
    fetching = true;
    try {
      const picture = state.pictures > 0 && await newest('/pictures/0');
      if (picture) {
        const old = at('picture').src;
        at('picture').src = URL.createObjectURL(await picture.blob());
        at('picture').hidden = false;
        at('picture-caption').textContent = 'Click to enlarge.';
        if (old) URL.revokeObjectURL(old);
      }
      if (noBody) {
        at('view-caption').textContent = noBody;
      } else {
        if (!body) {
          const shape = await newest('/shape');
          at('view').replaceChildren();
          if (shape) body = window.softforceBody(at('view'), await shape.json());
        }
        const view = body && await newest('/view');
        if (view) {
          body.update(await view.json());
          at('view').dataset.ready = 'yes';
          at('view-caption').textContent =
            'Drag to turn, wheel or two fingers to zoom. Colour: displacement.';
        }
      }
    } catch (error) {
      if (error instanceof TypeError) return;  // the connection; the events tell of that
      noBody = `The 3-D view needs a browser with WebGL (${error.message}).`;
      at('view').replaceChildren();
      at('view-caption').textContent = noBody;
    } finally {
      fetching = false;
    }
  }

  // ---- the rest
  function cell(tag, text, name) {
    const made = document.createElement(tag);
    made.textContent = text;
    if (name) made.className = name;
    return made;
  }

  function card(figure, meaning) {
    const made = document.createElement('div');
    made.className = 'card';
    made.append(cell('b', figure), cell('span', meaning));
    return made;
  }

  function key(name, text) {
    const made = cell('span', '', 'entry');
    made.append(cell('span', '', `key ${name}`), text);
    return made;
  }

  function show() {
    const {controls} = state;
    document.title = `${state.scene} \u2013 softforce`;
    at('scene').textContent = state.scene;
    at('moment').textContent = state.frame < 0 ? 'waiting for the first frame' :
      `frame ${state.frame}, ${state.time.toFixed(2)} s`;
    at('reason').hidden = !state.reason;
    at('reason').textContent = state.reason;
    const cards = state.forces.map(([name, , , , norm, , , , sd]) =>
      card(`${norm.toPrecision(3)} N`, `${name}, \u00b1 ${(1.96 * sd).toPrecision(2)} (95 %)`));
    cards.push(card(`${state.rate.toFixed(1)} /s`, 'frames'));
    cards.push(card(`${state.latency.toFixed(0)} ms`, 'from picture to force'));
    if (state.live) cards.push(card(state.dropped, 'sets dropped'));
    if (state.expected > 0) cards.push(card(`${state.processed} / ${state.expected}`, 'frames done'));
    at('cards').replaceChildren(...cards);
    at('force-key').replaceChildren(...names.map((name, k) => key(`c${k % HUES}`, name)));

    const counts = state.statuses.map(() => 0);
    for (const [, status] of state.markers) ++counts[status];
    at('marker-key').replaceChildren(...state.statuses.map(
        (name, k) => key(`s${k}`, `${name} ${counts[k]}`)));
    at('markers').replaceChildren(...state.markers.map(([id, status]) => {
      const made = cell('span', id, `s${status}`);
      made.title = `marker ${id}: ${state.statuses[status]}`;
      return made;
    }));

    const head = document.createElement('tr');
    for (const text of ['stage', 'median', '95 %', 'longest', 'waiting']) {
      head.append(cell('th', text, text === 'stage' ? '' : 'number'));
    }
    at('stages').replaceChildren(head, ...state.stages.map(([name, ...values]) => {
      const row = document.createElement('tr');
      row.append(cell('td', name), ...values.map((value) => cell('td', number(value, 2), 'number')));
      return row;
    }));

    at('record').classList.toggle('on', controls.recording);
    at('record').textContent = controls.recording ? 'Stop recording' : 'Record';
    at('pause').classList.toggle('on', controls.paused);
    at('pause').textContent = controls.paused ? 'Go on' : 'Pause';
    for (const button of document.querySelectorAll('[data-post]')) {
      button.disabled = state.ended || (button.id === 'record' && !controls.canRecord);
    }
    if (controls.tares === controls.tared && controls.tared > 0 &&
        at('said').textContent.startsWith('taring')) {
      say('tared');
    }
    plot();
  }

  function link(text, style) {
    at('link').textContent = text;
    at('link').className = `verdict ${style}`;
    document.body.classList.toggle('stale', style === 'bad');
  }

  function receive(event) {
    heard = Date.now();
    state = JSON.parse(event.data);
    if (state.run !== run) {
      run = state.run;
      points = [];
      names = [];
      body = null;
      say('');
      loadHistory().catch(() => {});
    }
    if (state.frame >= 0) addPoint(state.time, state.forces);
    if (state.ended) {
      link(`run ended: ${state.ended}`, state.usable ? 'good' : 'advice');
    } else {
      link(controls().paused ? 'paused' : state.live ? 'live' : 'running', 'good');
    }
    show();
    look();
  }

  function controls() {
    return state.controls;
  }

  function connect() {
    const events = new EventSource('/events');
    heard = Date.now();
    let open = true;
    const lost = () => {
      if (!open) return;
      open = false;
      clearInterval(watch);
      events.close();
      // What ended does not come back by itself, but the next run may.
      if (!state?.ended) link('connection lost, trying again', 'bad');
      setTimeout(connect, RETRY);
    };
    const watch = setInterval(() => {
      // Comments, which keep a connection alive, do not show here: ask whether anybody is there.
      if (Date.now() - heard < SILENCE) return;
      heard = Date.now();
      fetch('/', {method: 'HEAD', signal: AbortSignal.timeout(5000)}).catch(lost);
    }, 1000);
    events.onmessage = receive;
    events.onerror = lost;
  }
  document.addEventListener('visibilitychange', () => state && look());
  connect();
})();
