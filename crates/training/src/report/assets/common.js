// Functions shared by the report and comparison pages: time formatting, nearest sample, and charts linked to a slider.
const Flight = (function () {
  'use strict';
  const byId = (id) => document.getElementById(id);
  const all = (selector) => Array.from(document.querySelectorAll(selector));
  const clock = (t) => {
    const whole = Math.round(Math.abs(t));
    return (t < -0.5 ? '\u2212' : '') + Math.floor(whole / 60) + ':' + String(whole % 60).padStart(2, '0');
  };
  const number = (value, digits, unit) => (value === null ? '–' : value.toFixed(digits) + (unit === '%' ? '%' : ' ' + unit));
  const color = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // Returns the index of the time nearest to t in an ascending list.
  function indexAt(times, t) {
    let low = 0, high = times.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle] < t) low = middle + 1; else high = middle;
    }
    return low > 0 && t - times[low - 1] < times[low] - t ? low - 1 : low;
  }

  // Moves the drone's mark in a drawing. The drawing's matrix maps east, north and up to its coordinates. In a bridge's
  // side view, the mark is faint while the drone is far from that bridge.
  const numbers = (text) => (text ? text.split(' ').map(Number) : null);
  const drone = (node) => ({ node, m: numbers(node.dataset.matrix), near: numbers(node.dataset.near) });
  function place({ node, m, near }, e, n, u) {
    if (near) {
      const [east, north, alongEast, alongNorth, along, beside] = near;
      const x = (e - east) * alongEast + (n - north) * alongNorth, y = (e - east) * alongNorth - (n - north) * alongEast;
      node.classList.toggle('elsewhere', Math.abs(x) > along || Math.abs(y) > beside);
    }
    const x = m[0] * e + m[1] * n + m[2] * u + m[3];
    const y = m[4] * e + m[5] * n + m[6] * u + m[7];
    node.setAttribute('transform', 'translate(' + x.toFixed(1) + ' ' + y.toFixed(1) + ')');
  }

  // Play/pause control for a slider. `texts` contains the button's labels. `advance` moves the slider by the given number of seconds and returns `false` once
  // it reaches the end.
  function player(button, texts, begin, advance) {
    let timer = null;
    function stop() {
      if (timer !== null) cancelAnimationFrame(timer);
      timer = null;
      button.textContent = texts.play;
      button.setAttribute('aria-pressed', 'false');
    }
    button.addEventListener('click', () => {
      if (timer !== null) { stop(); return; }
      begin();
      let before = null;
      const step = (at) => {
        // Plays at eight times the flight's speed.
        const more = advance(before === null ? 0 : (at - before) / 1000 * 8);
        before = at;
        if (!more) { stop(); return; }
        timer = requestAnimationFrame(step);
      };
      button.textContent = texts.pause;
      button.setAttribute('aria-pressed', 'true');
      timer = requestAnimationFrame(step);
    });
    return stop;
  }

  // Charts with a common time axis. `curves` returns the times of a host element, its series (values, color, width, dash) and the
  // range of its vertical axis. `now` returns the slider's time; `pick` moves the slider.
  const HEIGHT = 132;
  function charts(curves, now, pick) {
    const hosts = all('.chart');
    let drawn = [];
    function chart(host) {
      const { times, lines, range } = curves(host);
      const axis = { stroke: color('--faint'), grid: { stroke: color('--grid'), width: 1 }, ticks: { stroke: color('--grid'), width: 1 }, font: '12px system-ui, sans-serif' };
      const series = lines.map((line) => ({ stroke: color(line.color), width: line.width, dash: line.dash, points: { show: false } }));
      const plot = new uPlot({
        width: host.clientWidth, height: HEIGHT, legend: { show: false }, cursor: { y: false, points: { show: false }, drag: { x: true, y: false }, sync: { key: 'flight' } },
        scales: { x: { time: false }, y: { range } },
        axes: [Object.assign({ values: (u, ticks) => ticks.map(clock), size: 30 }, axis), Object.assign({ size: 44 }, axis)],
        series: [{}, ...series],
      }, [times, ...lines.map((line) => line.values)], host);
      const mark = document.createElement('div');
      mark.className = 'now';
      plot.over.appendChild(mark);
      plot.over.addEventListener('click', () => {
        if (plot.cursor.left >= 0 && plot.cursor.idx != null) pick(times[plot.cursor.idx]);
      });
      const follow = () => {
        const x = plot.valToPos(now(), 'x');
        mark.hidden = x < 0 || x > plot.over.clientWidth;
        mark.style.transform = 'translateX(' + x.toFixed(1) + 'px)';
      };
      plot.hooks.setScale = [follow];
      return { plot, host, follow };
    }
    const follow = () => { for (const one of drawn) one.follow(); };
    function draw() {
      for (const { plot } of drawn) plot.destroy();
      drawn = hosts.filter((host) => host.clientWidth > 0).map(chart);
      follow();
    }
    new ResizeObserver(() => {
      for (const { plot, host, follow: own } of drawn) {
        if (host.clientWidth > 0 && host.clientWidth !== plot.width) { plot.setSize({ width: host.clientWidth, height: HEIGHT }); own(); }
      }
    }).observe(document.body);
    return { draw, follow };
  }

  // Charts use the colors of the screen theme. Printouts use the light theme.
  function whenColorsChange(repaint) {
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', repaint);
    addEventListener('beforeprint', () => { document.documentElement.dataset.theme = 'light'; repaint(); });
    addEventListener('afterprint', () => { delete document.documentElement.dataset.theme; repaint(); });
  }

  // Range of a vertical axis that starts at 0. Its upper end is the largest value, but at least 1 and at most the largest
  // meaningful value.
  const fromZero = (most) => (u, low, high) => [0, Math.max(1, most ? Math.min(most, high) : high) * 1.05];

  return { byId, all, clock, number, color, indexAt, drone, place, player, charts, whenColorsChange, fromZero };
})();
