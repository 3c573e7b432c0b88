// Interactive parts of a comparison: one slider for both flights, aligned at lift-off or at the start of a task.
(function () {
  'use strict';
  const { byId, all, clock, number } = Flight;
  const block = byId('comparison-data');
  if (!block) return;
  const data = JSON.parse(block.textContent);
  const { flights, texts } = data;
  if (flights.some((flight) => flight.series.t.length === 0)) return;
  // Step of the slider and of the charts, s.
  const STEP = 0.2;
  const slider = byId('moment'), select = byId('line-up');
  const drones = all('.drone').map((node) => ({ flight: Number(node.dataset.flight), drone: Flight.drone(node) }));
  let times = [], now = 0;

  // Converts the common time, which is 0 at the alignment point, to a flight's own time.
  const start = (k) => flights[k].starts[Number(select.value)];
  const own = (k, t) => t + start(k);
  // Returns an index into a flight's series; null before lift-off and after the end.
  function index(k, t) {
    const series = flights[k].series.t, at = own(k, t);
    if (at < series[0] - STEP || at > series[series.length - 1] + STEP) return null;
    return Flight.indexAt(series, at);
  }

  const value = { speed: [1, 'm/s'], distance: [1, 'm'], clearance: [1, 'm'], battery: [0, '%'] };
  function words(k, key, i) {
    if (i === null) return key === 'task' ? texts.notFlying : '–';
    const series = flights[k].series;
    if (key === 'task') return series.task[i] === null ? '–' : flights[k].tasks[series.task[i]];
    return number(series[key][i], value[key][0], value[key][1]);
  }

  function show(step) {
    now = Math.min(times.length - 1, Math.max(0, step));
    const t = times[now], at = flights.map((_, k) => index(k, t));
    for (const { flight, drone } of drones) {
      const i = at[flight], s = flights[flight].series;
      drone.node.classList.toggle('away', i === null);
      if (i !== null) Flight.place(drone, s.e[i], s.n[i], s.u[i]);
    }
    slider.value = String(now);
    byId('moment-text').textContent = clock(t);
    // Names may contain a dollar sign, which has a meaning in replacement texts.
    const spoken = flights.map((_, k) => texts.slider.replace('%session', String(k + 1)).replace('%task', () => words(k, 'task', at[k])));
    slider.setAttribute('aria-valuetext', clock(t) + ', ' + spoken.join(', '));
    for (const cell of all('[data-now]')) {
      const k = Number(cell.dataset.flight);
      cell.textContent = words(k, cell.dataset.now, at[k]);
    }
    curves.follow();
  }

  const curves = Flight.charts((host) => {
    const name = host.dataset.columns;
    const lines = flights.map((flight, k) => ({
      values: times.map((t) => { const i = index(k, t); return i === null ? null : flight.series[name][i]; }),
      color: '--s' + (k + 1), width: 1.6, dash: k === 1 ? [7, 3] : undefined,
    }));
    const limit = { speed: data.limits.speed, clearance: data.limits.close }[name];
    if (limit) lines.push({ values: times.map(() => limit), color: '--faint', width: 1.2, dash: [2, 4] });
    return { times, lines, range: name === 'battery' ? [0, 100] : Flight.fromZero({ distance: 20, clearance: 20 }[name]) };
  }, () => times[now], (moment) => { stop(); show(Flight.indexAt(times, moment)); });

  // Changes the alignment: recomputes the common times and moves the slider to 0.
  function lineUp() {
    const from = Math.min(...flights.map((flight, k) => flight.series.t[0] - start(k)));
    const to = Math.max(...flights.map((flight, k) => flight.series.t[flight.series.t.length - 1] - start(k)));
    // The steps always include 0 so that the slider can show the exact alignment point.
    const first = Math.floor(from / STEP), count = Math.ceil(to / STEP) - first + 1;
    times = Array.from({ length: count }, (_, k) => (first + k) * STEP);
    slider.max = String(count - 1);
    curves.draw();
    show(-first);
  }

  let t = 0;
  const stop = Flight.player(byId('play'), texts, () => {
    if (now >= times.length - 1) show(0);
    t = times[now];
  }, (seconds) => {
    t += seconds;
    show(Flight.indexAt(times, t));
    return t < times[times.length - 1];
  });
  slider.addEventListener('input', () => { stop(); show(Number(slider.value)); });
  select.addEventListener('change', () => { stop(); lineUp(); });
  Flight.whenColorsChange(() => curves.draw());
  byId('run').hidden = false;
  byId('readout').hidden = false;
  document.body.classList.add('live');
  lineUp();
})();
