// Interactive parts of a report: the slider, which moves the drone in every drawing, the charts, and the 3D view. Data is
// inserted as text, never as markup.
(function () {
  'use strict';
  const { byId, all, clock, number, color } = Flight;
  const block = byId('flight-data');
  if (!block) return;
  const data = JSON.parse(block.textContent);
  const s = data.series;
  const texts = data.texts;
  const count = s.t.length;
  if (count === 0) return;
  const end = s.t[count - 1];
  let now = 0;
  const listeners = [];

  // Frames between tasks count towards the nearest task, which is not being flown then.
  const taskName = (i) => (s.task[i] === null || s.state[i] === 0 ? '–' : data.tasks[s.task[i]].id + ' · ' + data.tasks[s.task[i]].name);
  const pathWords = (i) => texts.states[s.state[i]];
  // Names may contain a dollar sign, which has a meaning in replacement texts.
  const sliderWords = (i) => texts.slider.replace('%moment', clock(s.t[i])).replace('%path', pathWords(i)).replace('%task', () => taskName(i));

  // Slider.
  const slider = byId('moment');
  const drones = all('.drone').map(Flight.drone);
  const cursors = all('.cursor');
  const readout = {
    task: taskName,
    state: pathWords,
    distance: (i) => number(s.distance[i], 1, 'm'),
    speed: (i) => number(s.speed[i], 1, 'm/s'),
    clearance: (i) => number(s.clearance[i], 1, 'm'),
    battery: (i) => number(s.battery[i], 0, '%'),
  };
  function show(index) {
    now = Math.min(count - 1, Math.max(0, index));
    for (const drone of drones) Flight.place(drone, s.e[now], s.n[now], s.u[now]);
    for (const cursor of cursors) {
      const left = Number(cursor.dataset.left), right = Number(cursor.dataset.right);
      cursor.setAttribute('transform', 'translate(' + (left + (right - left) * (end > 0 ? s.t[now] / end : 0)).toFixed(1) + ' 0)');
    }
    slider.value = String(now);
    slider.setAttribute('aria-valuetext', sliderWords(now));
    byId('moment-text').textContent = clock(s.t[now]);
    for (const key of Object.keys(readout)) byId('now-' + key).textContent = readout[key](now);
    byId('now-task').title = taskName(now);
    for (const listener of listeners) listener(now);
  }
  slider.max = String(count - 1);
  slider.addEventListener('input', () => { hold(); show(Number(slider.value)); });
  byId('run').hidden = false;
  byId('readout').hidden = false;
  document.body.classList.add('live');

  // The video begins at lift-off, as the slider does. While it plays, it leads; otherwise it follows the slider.
  const video = byId('video');
  // Difference above which the paused video is moved, s (half a picture at 10 pictures per second).
  const VIDEO_STEP_S = 0.05;
  // Whether the slider moved the video, and not the user with the video's own controls.
  let sliderSeeks = false;
  function followSlider() {
    if (!video.paused || video.readyState === 0 || video.seeking || Math.abs(video.currentTime - s.t[now]) <= VIDEO_STEP_S) return;
    sliderSeeks = true;
    video.currentTime = s.t[now];
  }
  function missing() {
    video.hidden = true;
    byId('video-missing').hidden = false;
  }
  if (video) {
    video.addEventListener('error', missing);
    // The video may have failed before this script ran.
    if (video.error) missing();
    video.addEventListener('timeupdate', () => { if (!video.paused) show(Flight.indexAt(s.t, video.currentTime)); });
    video.addEventListener('play', () => stop());
    video.addEventListener('loadedmetadata', followSlider);
    video.addEventListener('seeked', () => {
      const own = !sliderSeeks;
      sliderSeeks = false;
      if (!video.paused) return;
      // The slider may have moved on during the search.
      if (own) show(Flight.indexAt(s.t, video.currentTime));
      else followSlider();
    });
    listeners.push(followSlider);
  }
  // Stops everything that moves the slider by itself.
  function hold() {
    stop();
    if (video) video.pause();
  }

  let t = 0;
  const stop = Flight.player(byId('play'), texts, () => {
    if (video) video.pause();
    if (now >= count - 1) show(0);
    t = s.t[now];
  }, (seconds) => {
    t += seconds;
    show(Flight.indexAt(s.t, t));
    return t < end;
  });

  // Links to moments.
  for (const link of all('a.moment-link')) {
    link.addEventListener('click', () => { hold(); show(Flight.indexAt(s.t, Number(link.dataset.t))); });
  }

  // Charts.
  const limits = {
    speed: () => s.t.map(() => data.limits.speed),
    distance: () => s.task.map((task) => (task === null ? null : data.tasks[task].within)),
    clearance: () => s.t.map(() => data.limits.close),
  };
  const curves = Flight.charts((host) => {
    const columns = host.dataset.columns.split(' ');
    const lines = columns.map((name, k) => ({ values: s[name], color: '--s' + (k + 1), width: columns.length > 1 ? 1.2 : 1.6 }));
    const limit = limits[columns[0]];
    if (limit) lines.push({ values: limit(), color: '--off', width: 1.5, dash: [6, 4] });
    const range = { battery: [0, 100], fb: [-1, 1] }[columns[0]];
    return { times: s.t, lines, range: range || Flight.fromZero({ distance: 20, clearance: 20 }[columns[0]]) };
  }, () => s.t[now], (moment) => { hold(); show(Flight.indexAt(s.t, moment)); });
  listeners.push(curves.follow);
  Flight.whenColorsChange(() => { curves.draw(); if (model) model.paint(); });

  // Creates the CSV file of the time series in the browser and offers it as a download. The file is in English.
  const csv = byId('series-csv');
  csv.hidden = false;
  csv.addEventListener('click', () => {
    const names = Object.keys(s);
    const heads = { t: 't_s', e: 'east_m', n: 'north_m', u: 'up_m', speed: 'speed_m_s', distance: 'distance_m', clearance: 'clearance_m', battery: 'battery_pct', wind: 'wind_m_s', wind_from: 'wind_from_deg', task: 'task', state: 'path' };
    const states = ['between tasks', 'off path', 'on path'];
    const cell = (name, i) => {
      if (name === 'task') return s.task[i] === null ? '' : data.tasks[s.task[i]].id;
      if (name === 'state') return states[s.state[i]];
      return s[name][i] ?? '';
    };
    const lines = s.t.map((_, i) => names.map((name) => cell(name, i)).join(','));
    const text = names.map((name) => heads[name] || name).join(',') + '\n' + lines.join('\n') + '\n';
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([text], { type: 'text/csv' }));
    link.download = 'series.csv';
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });

  // 3D view. The library is embedded as text and loaded only when the user opens the view.
  let model = null;
  const open = byId('model-open');
  const probe = document.createElement('canvas').getContext('webgl2');
  if (probe) {
    open.hidden = false;
    const lose = probe.getExtension('WEBGL_lose_context');
    if (lose) lose.loseContext();
  }
  const address = (text) => URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
  async function library() {
    const module = byId('three-module');
    const core = address(byId('three-core').textContent);
    return import(address(module.textContent.replaceAll(module.dataset.core, core)));
  }
  open.addEventListener('click', async () => {
    open.disabled = true;
    const three = await library();
    byId('model-live').hidden = false;
    byId('model-note').hidden = false;
    model = turnable(three, byId('model-live'));
    byId('model-still').hidden = true;
    open.hidden = true;
    listeners.push(model.follow);
    model.follow(now);
  });

  function bytes(text) {
    const raw = atob(text), out = new Uint8Array(raw.length);
    for (let k = 0; k < raw.length; k++) out[k] = raw.charCodeAt(k);
    return new Uint16Array(out.buffer);
  }

  function turnable(T, host) {
    // Maps the site's east, north and up to x, -z and y.
    const place = (p) => new T.Vector3(p[0], p[2], -p[1]);
    const scene = new T.Scene();
    const camera = new T.PerspectiveCamera(42, 1, 0.5, 4000);
    const renderer = new T.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    const canvas = renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', texts.model);
    host.appendChild(canvas);
    const sun = new T.DirectionalLight(0xffffff, 1.6);
    sun.position.set(-0.5, 1, 0.7);
    const sky = new T.HemisphereLight(0xffffff, 0x777770, 1.5);
    scene.add(sun, sky);

    // Bridges.
    const mesh = data.mesh, corners = bytes(mesh.corners);
    const points = new Float32Array(corners.length);
    for (let k = 0; k < corners.length; k += 3) {
      points[k] = mesh.origin[0] + mesh.step * corners[k];
      points[k + 1] = mesh.origin[2] + mesh.step * corners[k + 2];
      points[k + 2] = -(mesh.origin[1] + mesh.step * corners[k + 1]);
    }
    const solid = new T.BufferGeometry();
    solid.setAttribute('position', new T.BufferAttribute(points, 3));
    solid.setIndex(new T.BufferAttribute(bytes(mesh.triangles), 1));
    const structure = new T.Mesh(solid, new T.MeshLambertMaterial({ flatShading: true, side: T.DoubleSide }));
    scene.add(structure);

    // Terrain and water.
    const g = data.ground, relief = new T.PlaneGeometry(2 * g.half, 2 * g.half, g.side - 1, g.side - 1);
    const heights = relief.getAttribute('position');
    for (let row = 0; row < g.side; row++) {
      for (let column = 0; column < g.side; column++) {
        // The plane's rows run from north to south.
        heights.setZ((g.side - 1 - row) * g.side + column, g.heights[row * g.side + column]);
      }
    }
    const ground = new T.Mesh(relief, new T.MeshLambertMaterial({ flatShading: true }));
    ground.rotation.x = -Math.PI / 2;
    const water = new T.Mesh(new T.PlaneGeometry(2 * g.half, 2 * g.half), new T.MeshLambertMaterial({ transparent: true, opacity: 0.85 }));
    water.rotation.x = -Math.PI / 2;
    water.position.y = g.water;
    scene.add(ground, water);

    // Reference paths and flight path.
    const line = (list, material) => new T.Line(new T.BufferGeometry().setFromPoints(list), material);
    const pathStyle = new T.LineDashedMaterial({ dashSize: 2, gapSize: 1.4 });
    for (const task of data.tasks) {
      const way = task.path.map(place);
      if (task.closed && way.length) way.push(way[0]);
      const drawn = line(way, pathStyle);
      drawn.computeLineDistances();
      scene.add(drawn);
    }
    const flown = s.t.map((_, i) => new T.Vector3(s.e[i], s.u[i], -s.n[i]));
    const track = line(flown, new T.LineBasicMaterial({ vertexColors: true }));
    track.geometry.setAttribute('color', new T.BufferAttribute(new Float32Array(3 * count), 3));
    scene.add(track);
    // Most systems draw lines one pixel wide, so points make the flight path thicker.
    scene.add(new T.Points(track.geometry, new T.PointsMaterial({ size: 3.5, sizeAttenuation: false, vertexColors: true })));
    const shared = {};
    const ball = (at, kind, radius) => {
      shared[kind] = shared[kind] || new T.MeshBasicMaterial();
      const node = new T.Mesh(new T.SphereGeometry(radius, 14, 10), shared[kind]);
      node.position.copy(place(at));
      scene.add(node);
      return node;
    };
    for (const at of data.crashes) ball(at, 'crash', 0.9);
    for (const picture of data.pictures) ball(picture.at, picture.verdict, 0.9);
    for (const defect of data.defects) ball(defect.at, defect.found ? 'found' : 'missed', 0.5);
    const drone = ball([s.e[0], s.n[0], s.u[0]], 'drone', 1.1);

    const speedColors = ['--q1', '--q2', '--q3', '--q4', '--bad-fill'];
    const clearanceColors = ['--between', '--c4', '--c3', '--c2', '--c1'];
    const stateColors = ['--between', '--off', '--on'];
    const choose = {
      'by-path': (i) => stateColors[s.state[i]],
      'by-speed': (i) => speedColors[s.speed[i] > data.limits.speed ? 4 : Math.min(3, Math.max(0, Math.ceil(s.speed[i] / data.limits.speed * 4) - 1))],
      'by-clearance': (i) => clearanceColors[s.clearance[i] === null ? 0 : 4 - data.limits.clearances.filter((limit) => s.clearance[i] >= limit).length],
    };
    function paint() {
      const paintOf = (name) => new T.Color(color(name));
      scene.background = paintOf('--page');
      structure.material.color = paintOf('--steel');
      ground.material.color = paintOf('--ground');
      water.material.color = paintOf('--water');
      pathStyle.color = paintOf('--path');
      const styles = { crash: '--bad-fill', 'v-hit': '--good-fill', 'v-repeat': '--good-fill', 'v-near': '--warn-fill', 'v-false': '--bad-fill', found: '--good', missed: '--bad', drone: '--ink' };
      for (const kind of Object.keys(shared)) shared[kind].color = paintOf(styles[kind]);
      const chosen = choose[document.querySelector('input[name="coloring"]:checked').value];
      const known = {}, colors = track.geometry.getAttribute('color');
      for (let i = 0; i < count; i++) {
        const name = chosen(i);
        const c = known[name] = known[name] || paintOf(name);
        colors.setXYZ(i, c.r, c.g, c.b);
      }
      colors.needsUpdate = true;
      render();
    }
    all('input[name="coloring"]').forEach((input) => input.addEventListener('change', paint));

    // The view rotates about the center of the bridges.
    const box = new T.Box3().setFromObject(structure.geometry.getAttribute('position').count ? structure : track);
    const target = box.getCenter(new T.Vector3());
    let yaw = 0.5, pitch = 0.42, distance = Math.max(30, box.getSize(new T.Vector3()).length() * 0.62);
    function render() {
      const flat = Math.cos(pitch) * distance;
      camera.position.set(target.x - Math.sin(yaw) * flat, target.y + Math.sin(pitch) * distance, target.z + Math.cos(yaw) * flat);
      camera.lookAt(target);
      renderer.render(scene, camera);
    }
    function turn(dyaw, dpitch, factor) {
      yaw += dyaw;
      pitch = Math.min(1.5, Math.max(-0.1, pitch + dpitch));
      distance = Math.min(1500, Math.max(5, distance * factor));
      render();
    }
    let held = null;
    canvas.addEventListener('pointerdown', (event) => { held = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener('pointermove', (event) => {
      if (!held) return;
      turn((event.clientX - held[0]) * 0.006, (event.clientY - held[1]) * 0.006, 1);
      held = [event.clientX, event.clientY];
    });
    canvas.addEventListener('pointerup', () => { held = null; });
    canvas.addEventListener('wheel', (event) => { event.preventDefault(); turn(0, 0, Math.exp(event.deltaY * 0.001)); }, { passive: false });
    const keys = { ArrowLeft: [-0.08, 0, 1], ArrowRight: [0.08, 0, 1], ArrowUp: [0, 0.06, 1], ArrowDown: [0, -0.06, 1], '+': [0, 0, 0.88], '=': [0, 0, 0.88], '-': [0, 0, 1.14] };
    canvas.addEventListener('keydown', (event) => {
      const by = keys[event.key];
      if (by) { event.preventDefault(); turn(by[0], by[1], by[2]); }
    });
    function fit() {
      const width = host.clientWidth, height = host.clientHeight;
      if (width === 0 || height === 0) return;
      renderer.setSize(width, height);
      camera.aspect = width / height;
      camera.updateProjectionMatrix();
      render();
    }
    new ResizeObserver(fit).observe(host);
    const follow = (i) => { drone.position.set(s.e[i], s.u[i], -s.n[i]); render(); };
    fit();
    paint();
    return { paint, follow };
  }

  curves.draw();
  show(0);
  // The address may ask for a moment: the web page of a session links to it.
  const asked = /^#t=(\d+(?:\.\d+)?)$/.exec(location.hash);
  if (asked) {
    show(Flight.indexAt(s.t, Number(asked[1])));
    byId('flight').scrollIntoView({ behavior: 'instant' });
  }
})();
