// The script of the HTML report.  The page is complete without it: it adds motion, plots that answer, copying and saving.
(() => {
'use strict';
const all = s => [...document.querySelectorAll(s)], one = s => document.querySelector(s);
// ---- appearance, print
one('#theme').onclick = () => {
  const r = document.documentElement;
  const dark = r.dataset.theme ? r.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme:dark)').matches;
  r.dataset.theme = dark ? 'light' : 'dark';
};
one('#print').onclick = () => print();
const closed = [];
addEventListener('beforeprint', () => all('details:not([open])').forEach(d => { closed.push(d); d.open = true; }));
addEventListener('afterprint', () => { while (closed.length) closed.pop().open = false; });
// ---- what scrolls sideways can be reached by keys
const reach = () => all('.eq .m,.scroll,.src,.card .big').forEach(e => {
  const wide = e.scrollWidth > e.clientWidth + 1;
  if (wide) { e.tabIndex = 0; e.setAttribute('role', 'group'); e.setAttribute('aria-label', document.documentElement.lang === 'de' ? 'seitlich verschiebbar' : 'scrolls sideways'); }
  else for (const a of ['tabindex', 'role', 'aria-label']) e.removeAttribute(a);
});
reach();
addEventListener('resize', reach);
if (document.fonts) document.fonts.ready.then(reach);
// ---- copying and saving
const save = (name, text, type) => {
  const a = document.createElement('a');
  a.href = URL.createObjectURL(new Blob([text], {type}));
  a.download = name;
  a.click();
  setTimeout(() => URL.revokeObjectURL(a.href), 1000);
};
const base = (document.title.replace(/ – pleuel$/, '').toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-+|-+$/g, '') || 'model').slice(0, 40);
const tex = e => e.querySelector('annotation').textContent;
one('#tex').onclick = () => save(base + '.tex', all('#derivation .eq').map(e => '\\[\n' + tex(e) + '\n\\]').join('\n\n') + '\n', 'text/x-tex');
const copyByHand = s => {
  const t = document.createElement('textarea');
  t.value = s;
  document.body.append(t);
  t.select();
  document.execCommand('copy');
  t.remove();
};
all('.cp').forEach(b => b.onclick = () => {
  const s = tex(b.parentElement), done = () => { b.textContent = '✓'; setTimeout(() => b.textContent = 'TeX', 900); };
  if (navigator.clipboard) navigator.clipboard.writeText(s).then(done, () => { copyByHand(s); done(); });
  else { copyByHand(s); done(); }
});
// ---- the motion: data
const block = one('#data');
if (!block) return;
const D = JSON.parse(block.textContent), de = document.documentElement.lang === 'de';
const bytes = b => Uint8Array.from(atob(b), c => c.charCodeAt(0)).buffer;
const floats = b => new Float32Array(bytes(b)), shorts = b => new Int16Array(bytes(b));
const columns = c => Object.fromEntries(Object.keys(c.x).map(k => [k, floats(c.x[k])]));
const X = columns(D.thin), N = D.thin.n, tt = X[0], t0 = tt[0], t1 = tt[N - 1];
const say = (en, ge) => de ? ge : en;
const number = (v, n) => {
  if (!isFinite(v)) return '–';
  let s = v === 0 ? '0' : Math.abs(v) >= 1e6 || Math.abs(v) < 1e-4 ? String(+v.toPrecision(n)).includes('e') ? String(+v.toPrecision(n)) : (+v.toPrecision(n)).toExponential() : String(+v.toPrecision(n));
  s = s.replace(/e([+-])(\d+)/, (m, a, b) => '·10' + [...(a === '-' ? '-' : '') + b].map(c => c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]).join(''));
  return (de ? s.replace('.', ',') : s).replace(/^-/, '−');
};
const csv = c => {
  const x = columns(c), keys = Object.keys(c.x), lines = [keys.map(k => c.head[k]).join(',')];
  for (let i = 0; i < c.n; i++) lines.push(keys.map(k => isFinite(x[k][i]) ? +x[k][i].toPrecision(8) : 'nan').join(','));
  return lines.join('\n') + '\n';
};
if (one('#csv')) one('#csv').onclick = () => save(base + '.csv', csv(D.full || D.thin), 'text/csv');

// The row at or before t; of rows at one time the last.
const rowAt = t => {
  let a = 0, b = N - 1;
  while (a < b) { const m = (a + b + 1) >> 1; if (tt[m] <= t) a = m; else b = m - 1; }
  return a;
};
const valueAt = (c, t) => {
  const i = rowAt(t), y = X[c];
  if (i >= N - 1 || tt[i] >= t || tt[i + 1] === tt[i]) return y[i];
  return y[i] + (y[i + 1] - y[i]) * (t - tt[i]) / (tt[i + 1] - tt[i]);
};

// ---- the picture
const NS = 'http://www.w3.org/2000/svg';
const el = (parent, name, set = {}, text) => {
  const e = document.createElementNS(NS, name);
  for (const k in set) e.setAttribute(k, set[k]);
  if (text != null) e.textContent = text;
  parent.append(e);
  return e;
};
const S = D.scene, f1 = v => v.toFixed(1), P = (x, y) => f1(x) + ' ' + f1(y);
const isOn = id => !one(id) || one(id).checked;
// ORDER COIL, DAMPER, ARROW, PLACES: as html_scene.c
const coil = (x, y, x2, y2) => {
  const l = Math.hypot(x2 - x, y2 - y) || 1, ux = (x2 - x) / l, uy = (y2 - y) / l, end = Math.min(12, l / 5), step = (l - 2 * end) / 16;
  let d = 'M' + P(x, y) + 'L' + P(x + ux * end, y + uy * end);
  for (let i = 1; i < 16; i += 2) {
    const side = i % 4 === 1 ? 7 : -7, a = end + i * step;
    d += 'L' + P(x + ux * a - uy * side, y + uy * a + ux * side);
  }
  return d + 'L' + P(x2 - ux * end, y2 - uy * end) + 'L' + P(x2, y2);
};
const damper = (x, y, x2, y2) => {
  const l = Math.hypot(x2 - x, y2 - y) || 1, ux = (x2 - x) / l, uy = (y2 - y) / l, m = l / 2, a = Math.min(10, l / 4);
  const Q = (along, across) => P(x + ux * along - uy * across, y + uy * along + ux * across);
  return 'M' + Q(0, 0) + 'L' + Q(m, 0) + 'M' + Q(m, 6) + 'L' + Q(m, -6) + 'M' + Q(m - a, 9) + 'L' + Q(m + a, 9) + 'L' + Q(m + a, -9) +
    'L' + Q(m - a, -9) + 'M' + Q(m + a, 0) + 'L' + P(x2, y2);
};
const arrow = (x, y, x2, y2) => {
  const l = Math.hypot(x2 - x, y2 - y);
  if (l < 3) return '';
  const ux = (x2 - x) / l, uy = (y2 - y) / l, a = Math.min(9, l * .6), b = a * .45;
  return 'M' + P(x, y) + 'L' + P(x2 - ux * a, y2 - uy * a) + 'M' + P(x2, y2) + 'L' + P(x2 - ux * a - uy * b, y2 - uy * a + ux * b) +
    'L' + P(x2 - ux * a + uy * b, y2 - uy * a - ux * b) + 'Z';
};
const shapes = [], labels = [], marksOf = [];
let ft = null;
if (S) {
  ft = floats(S.t);
  const tracks = S.tracks.map(shorts);
  for (const s of S.shapes) {
    const g = one(`#anim g[data-i="${s.i}"]`);
    shapes.push({k: s.k, n: s.p.length, p: s.p.map(j => tracks[j]), i: s.i, g, e: g.firstElementChild, off: g.dataset.off === '1' && s.k !== 'velocity', now: null});
  }
  const byIndex = Object.fromEntries(shapes.map(s => [s.i, s]));
  for (const e of all('#anim text[data-l]')) {
    const s = byIndex[e.dataset.l], width = 8.2 * [...e.textContent].length + 2;
    labels.push({e, s, width, kind: e.classList[0], fixed: s ? null : e.style.display === 'none' ? undefined : [+e.getAttribute('x'), +e.getAttribute('y') - 13]});
  }
}
// Points of a shape between two frames; null where it is not there.
const trackAt = (r, i, u) => {
  if (r.length === 2) return r[0] === -32768 ? null : [r[0] / 32, r[1] / 32];
  const a = 2 * i, b = u > 0 ? a + 2 : a;
  if (r[a] === -32768) return null;
  if (r[b] === -32768) return u > .5 ? null : [r[a] / 32, r[a + 1] / 32];
  return [(r[a] + (r[b] - r[a]) * u) / 32, (r[a + 1] + (r[b + 1] - r[a + 1]) * u) / 32];
};
const pointsAt = (s, i, u) => {
  const out = [];
  for (const r of s.p) {
    const p = trackAt(r, i, u);
    if (!p) return null;
    out.push(p[0], p[1]);
  }
  return out;
};
// The circle through three points, from the first to the last.
const arc = (x1, y1, x2, y2, x3, y3) => {
  const d = 2 * (x1 * (y2 - y3) + x2 * (y3 - y1) + x3 * (y1 - y2));
  if (Math.abs(d) < 1) return 'M' + P(x1, y1) + 'L' + P(x3, y3);
  const a = x1 * x1 + y1 * y1, b = x2 * x2 + y2 * y2, c = x3 * x3 + y3 * y3;
  const cx = (a * (y2 - y3) + b * (y3 - y1) + c * (y1 - y2)) / d, cy = (a * (x3 - x2) + b * (x1 - x3) + c * (x2 - x1)) / d, r = Math.hypot(x1 - cx, y1 - cy);
  const sweep = d > 0 ? 1 : 0;
  return 'M' + P(x1, y1) + `A${f1(r)} ${f1(r)} 0 0 ${sweep} ` + P(x2, y2) + `A${f1(r)} ${f1(r)} 0 0 ${sweep} ` + P(x3, y3);
};
const line = (p, closed, round) => { let d = ''; if (round && p.length > 8) return smooth(p); for (let k = 0; k < p.length; k += 2) d += (k ? 'L' : 'M') + P(p[k], p[k + 1]); return closed ? d + 'Z' : d; };
const smooth = p => {
  let d = 'M' + P(p[0], p[1]);
  for (let k = 2; k < p.length - 2; k += 2) d += 'Q' + P(p[k], p[k + 1]) + ' ' + P((p[k] + p[k + 2]) / 2, (p[k + 1] + p[k + 3]) / 2);
  return d + 'L' + P(p[p.length - 2], p[p.length - 1]);
};
const trailTo = (r, i, u) => {
  let d = '', open = false;
  if (r.length === 2) return d;
  for (let k = 0; k <= i; k++) {
    const there = r[2 * k] !== -32768;
    if (there) d += (open ? 'L' : 'M') + P(r[2 * k] / 32, r[2 * k + 1] / 32);
    open = there;
  }
  const tip = open && u > 0 ? trackAt(r, i, u) : null;
  return d + (tip ? 'L' + P(tip[0], tip[1]) : '');
};
const hidden = s => s.off || (s.k === 'force' && !isOn('#forces')) || (s.k === 'velocity' && !isOn('#velocity')) || (s.k === 'trail' && !isOn('#trail'));
const drawShape = (s, i, u) => {
  if (s.k === 'trail') {
    s.g.style.display = hidden(s) ? 'none' : '';
    if (hidden(s)) return;
    s.e.setAttribute('d', trailTo(s.p[0], i, u));
    return;
  }
  const p = s.now = pointsAt(s, i, u);
  const show = p && !hidden(s);
  s.g.style.display = show ? '' : 'none';
  if (!show) { s.now = null; return; }
  if (s.k === 'mass' || s.k === 'point') { s.e.setAttribute('cx', f1(p[0])); s.e.setAttribute('cy', f1(p[1])); return; }
  const make = {spring: coil, damper, force: arrow, velocity: arrow, axis: arrow, angle: s.n === 3 ? arc : null}[s.k];
  s.e.setAttribute('d', make ? make(...p) : line(p, s.k === 'body', s.k === 'curve'));
};
const around = [[.9, -.7], [.9, .8], [-.9, -.7], [-.9, .8], [0, -1], [0, 1], [1, 0], [-1, 0]];
// Small boxes along lines, which labels keep clear of.
const along = (p, out) => {
  for (let k = 2; k < p.length; k += 2) {
    const x = p[k - 2], y = p[k - 1], dx = p[k] - x, dy = p[k + 1] - y, n = Math.floor(Math.hypot(dx, dy) / 9) + 1;
    for (let j = 0; j <= n; j++) out.push([x + dx * j / n - 2, y + dy * j / n - 2, 4, 4]);
  }
};
const still = [];
for (const e of all('#anim g:not([data-i]):not(.scale) path:not(.hatch)')) {
  const n = Math.min(200, Math.floor(e.getTotalLength() / 9));
  for (let j = 0; j <= n && n; j++) { const q = e.getPointAtLength(j / n * e.getTotalLength()); still.push([q.x - 2, q.y - 2, 4, 4]); }
}
const placeLabels = () => {
  const taken = [], lines = [...still];
  for (const s of shapes) if (s.now && s.k !== 'mass' && s.k !== 'point') along(s.now, lines);
  for (const s of shapes) if (s.k === 'mass' && s.now) taken.push([s.now[0] - 8, s.now[1] - 8, 16, 16]);
  for (const c of all('#anim g.mass:not([data-i]) circle')) taken.push([c.getAttribute('cx') - 8, c.getAttribute('cy') - 8, 16, 16]);
  for (const l of labels) if (l.fixed) taken.push([l.fixed[0], l.fixed[1], l.width, 16]);
  for (const l of labels) {
    if (!l.s) continue;
    const p = l.s.now, tip = l.kind === 'force' || l.kind === 'velocity' || l.kind === 'axis';
    let k = tip ? 1 : Math.floor(l.s.n / 2), ux = 0, uy = 0;
    if (p && tip) {
      const dx = p[2] - p[0], dy = p[3] - p[1], len = Math.hypot(dx, dy);
      if (len < 9) k = -1; else { ux = dx / len; uy = dy / len; }
    }
    l.e.style.display = p && k >= 0 ? '' : 'none';
    if (!p || k < 0) continue;
    let best = null, least = Infinity;
    for (let i = 0; i < 16; i++) {
      const far = i < 8 ? 1 : 1.9, own = i === 0 && (ux || uy), dx = own ? ux : around[i % 8][0] * far, dy = own ? uy : around[i % 8][1] * far;
      const b = [p[2 * k] + dx * (l.width / 2 + 11) - l.width / 2, p[2 * k + 1] + dy * 17 - 8, l.width, 16];
      b[0] = Math.min(Math.max(b[0], 2), S.w - 2 - l.width);
      b[1] = Math.min(Math.max(b[1], 2), S.h - 18);
      const hits = (list, w) => list.reduce((n, o) => n + (b[0] < o[0] + o[2] && o[0] < b[0] + b[2] && b[1] < o[1] + o[3] && o[1] < b[1] + b[3] ? w : 0), 0);
      const cost = hits(taken, 20) + hits(lines, 1) + .4 * i;
      if (cost < least) { best = b; least = cost; }
    }
    taken.push(best);
    l.e.setAttribute('x', f1(best[0]));
    l.e.setAttribute('y', f1(best[1] + 13));
  }
};
const drawPicture = t => {
  if (!S) return;
  let i = 0;
  while (i < ft.length - 2 && ft[i + 1] <= t) i++;
  const u = ft.length < 2 ? 0 : Math.min(1, Math.max(0, (t - ft[i]) / (ft[i + 1] - ft[i] || 1)));
  if (u >= 1) for (const s of shapes) drawShape(s, i + 1, 0);
  else for (const s of shapes) drawShape(s, i, u);
  const off = isOn('#forces') ? '' : 'none', offV = one('#velocity') && one('#velocity').checked ? '' : 'none';
  all('#anim .force.scale').forEach(e => e.style.display = off);
  all('#anim .velocity.scale').forEach(e => e.style.display = offV);
  placeLabels();
};

// ---- the plots
document.documentElement.classList.add('js');
let now = t0, zoom = [t0, t1];
const plots = [];
const tickStep = (span, n) => { const w = span / n, p = 10 ** Math.floor(Math.log10(w)); return [1, 2, 5, 10].find(m => m * p >= w * (1 - 1e-9)) * p; };
const ticks = (lo, hi, n) => { const s = tickStep(hi - lo, n), o = []; for (let v = Math.ceil(lo / s - 1e-9) * s; v <= hi + 1e-9 * s; v += s) o.push(Math.abs(v) < 1e-9 * s ? 0 : v); return o; };
const widthOf = s => 6.8 * [...s].length;
const ink = ['z', 'w', 'v', 'c4', 'c5'];
const span = (xs, from, to, room, wide) => {
  let lo = Infinity, hi = -Infinity;
  for (const x of xs) for (let i = from; i <= to; i++) if (isFinite(x[i])) { lo = Math.min(lo, x[i]); hi = Math.max(hi, x[i]); }
  if (!(lo <= hi)) return [0, 1];
  const size = Math.max(Math.abs(lo), Math.abs(hi));
  if (hi - lo < 1e-7 * size || size === 0) { const a = size ? .5 * size : 1; return [lo - a, hi + a]; }
  if (wide && lo > 0 && lo < .35 * hi) lo = 0;
  if (wide && hi < 0 && hi > .35 * lo) hi = 0;
  const s = hi - lo;
  return [lo - room * s * (lo ? 1 : .5), hi + room * s * (hi ? 1 : .5)];
};
const makePlot = svg => {
  const spec = D.plots[svg.dataset.p], timed = spec.x === 0, outs = [...svg.parentElement.querySelectorAll('output')];
  const M = {l: 46, r: 14, t: 10, b: 30}, id = 'clip' + svg.dataset.p;
  let W, H, xr, yr, drag = null, sel, cur, dots;
  const px = x => M.l + (x - xr[0]) / (xr[1] - xr[0]) * (W - M.l - M.r), py = y => H - M.b - (y - yr[0]) / (yr[1] - yr[0]) * (H - M.t - M.b);
  const inv = p => xr[0] + (p - M.l) / (W - M.l - M.r) * (xr[1] - xr[0]);
  const axes = () => {
    for (const v of ticks(yr[0], yr[1], 4)) {
      el(svg, 'line', {class: v === 0 ? 'ax' : 'gr', x1: M.l, x2: W - M.r, y1: py(v), y2: py(v)});
      el(svg, 'text', {class: 'e', x: M.l - 7, y: py(v) + 4}, number(v, 6));
    }
    const room = W - M.r - widthOf(spec.xl) - 8, list = ticks(xr[0], xr[1], Math.max(2, Math.min(7, Math.floor(W / 75))));
    let free = -Infinity;
    for (const v of list) {
      const s = number(v, 6), half = widthOf(s) / 2;
      el(svg, 'line', {class: 'ax', x1: px(v), x2: px(v), y1: H - M.b, y2: H - M.b + 4});
      if (px(v) + half > room || px(v) - half < free) continue;
      el(svg, 'text', {class: 'm', x: px(v), y: H - M.b + 17}, s);
      free = px(v) + half + 6;
    }
    el(svg, 'text', {class: 'e', x: W - M.r, y: H - M.b + 17}, spec.xl);
  };
  const marks = () => {
    let free = M.l;
    D.marks.forEach(([t, label], i) => {
      const x = px(t), w = widthOf(label) + 8;
      if (x < M.l - 1 || x > W - M.r + 1) return;
      const next = i + 1 < D.marks.length ? Math.min(px(D.marks[i + 1][0]), W - M.r) : W - M.r;
      const left = x - w >= free, right = !left && x + w <= next;
      el(svg, 'line', {class: 'ev', x1: x, x2: x, y1: M.t - 6, y2: H - M.b});
      if (left || right) el(svg, 'text', {class: left ? 'e evt' : 'evt', x: left ? x - 4 : x + 4, y: M.t + 5}, label);
      free = right ? x + w : x;
    });
  };
  const curve = (g, c, k) => {
    let d = '', open = false;
    for (let i = 0; i < N; i++) {
      const x = X[spec.x][i], y = X[c][i], there = isFinite(x) && isFinite(y);
      if (there) d += (open ? 'L' : 'M') + P(px(x), py(y));
      open = there;
    }
    el(g, 'path', {class: 'cv k' + k % 5, style: `stroke:var(--${ink[k % 5]})`, d});
  };
  const draw = () => {
    W = svg.clientWidth || 500;
    H = svg.clientHeight || 190;
    const from = Math.max(0, rowAt(zoom[0])), to = Math.min(N - 1, rowAt(zoom[1]) + 1);
    xr = timed ? zoom : span([X[spec.x]], 0, N - 1, .04, false);
    yr = span(spec.y.map(c => X[c]), timed ? from : 0, timed ? to : N - 1, .06, true);
    M.l = Math.max(40, ...ticks(yr[0], yr[1], 4).map(v => widthOf(number(v, 6)) + 14));
    svg.replaceChildren();
    svg.setAttribute('viewBox', `0 0 ${W} ${H}`);
    el(el(el(svg, 'defs'), 'clipPath', {id}), 'rect', {x: M.l, y: M.t - 6, width: W - M.l - M.r, height: H - M.t - M.b + 8});
    axes();
    if (timed) marks();
    const g = el(svg, 'g', {'clip-path': `url(#${id})`});
    spec.y.forEach((c, k) => curve(g, c, k));
    cur = timed ? el(svg, 'line', {class: 'cur', y1: M.t - 6, y2: H - M.b}) : null;
    dots = spec.y.map((c, k) => el(svg, 'circle', {r: 4, style: `fill:var(--${ink[k % 5]});stroke:var(--card);stroke-width:1.5`}));
    sel = el(svg, 'rect', {class: 'sel', y: M.t - 6, height: H - M.t - M.b + 6, width: 0});
    cursor();
  };
  const cursor = () => {
    const x = px(valueAt(spec.x, now)), on = x >= M.l - 1 && x <= W - M.r + 1;
    if (cur) { cur.setAttribute('x1', x); cur.setAttribute('x2', x); cur.style.display = on ? '' : 'none'; }
    spec.y.forEach((c, k) => {
      const v = valueAt(c, now), y = py(v);
      dots[k].style.display = on && isFinite(v) && y > M.t - 8 && y < H - M.b + 4 ? '' : 'none';
      dots[k].setAttribute('cx', isFinite(x) ? x : 0);
      dots[k].setAttribute('cy', isFinite(y) ? y : 0);
      outs[k].textContent = number(Math.abs(v) < 1e-10 * Math.max(Math.abs(yr[0]), Math.abs(yr[1])) ? 0 : v, 5);
    });
  };
  const nearest = (mx, my) => {
    let best = 0, least = Infinity;
    for (let i = 0; i < N; i++) for (const c of spec.y) {
      const d = (px(X[spec.x][i]) - mx) ** 2 + (py(X[c][i]) - my) ** 2;
      if (d < least) { least = d; best = i; }
    }
    return tt[best];
  };
  const at = e => { const b = svg.getBoundingClientRect(); return [(e.clientX - b.left) * W / b.width, (e.clientY - b.top) * H / b.height]; };
  const clamp = t => Math.min(zoom[1], Math.max(zoom[0], t));
  svg.addEventListener('pointermove', e => {
    const [x, y] = at(e);
    if (drag != null) { sel.setAttribute('x', Math.min(drag, x)); sel.setAttribute('width', Math.abs(x - drag)); }
    stop();
    show(timed ? clamp(inv(x)) : nearest(x, y));
  });
  svg.addEventListener('pointerdown', e => { if (timed) { drag = at(e)[0]; svg.setPointerCapture(e.pointerId); } });
  svg.addEventListener('pointerup', e => {
    const x = at(e)[0];
    if (drag != null && Math.abs(x - drag) > 8) zoomTo(clamp(inv(Math.min(x, drag))), clamp(inv(Math.max(x, drag))));
    drag = null;
    sel.setAttribute('width', 0);
  });
  svg.addEventListener('pointercancel', () => { drag = null; sel.setAttribute('width', 0); });
  svg.addEventListener('dblclick', () => zoomTo(t0, t1));
  svg.addEventListener('keydown', e => {
    const step = (zoom[1] - zoom[0]) / (e.shiftKey ? 10 : 200), go = {ArrowLeft: now - step, ArrowRight: now + step, Home: t0, End: t1}[e.key];
    if (go != null) { e.preventDefault(); stop(); show(Math.min(t1, Math.max(t0, go))); }
    if (e.key === 'Escape') zoomTo(t0, t1);
    if (e.key === '+' || e.key === '-') {
      const w = (zoom[1] - zoom[0]) * (e.key === '+' ? .25 : 1);
      zoomTo(Math.max(t0, now - w), Math.min(t1, now + w));
    }
  });
  svg.setAttribute('tabindex', 0);
  plots.push({draw, cursor});
};
const zoomTo = (a, b) => { if (b - a > 1e-6 * (t1 - t0)) { zoom = [a, b]; plots.forEach(p => p.draw()); } };

// ---- one time for all
const scrub = one('#scrub');
const show = t => {
  now = t;
  scrub.value = 1000 * (t - t0) / (t1 - t0);
  const words = 't = ' + number(t, 4) + (D.unit ? ' ' + D.unit : '');
  one('#time').textContent = words;
  scrub.setAttribute('aria-valuetext', words);
  drawPicture(t);
  plots.forEach(p => p.cursor());
};
let running = 0, last = 0;
// A motion between one second and a minute runs in its own time, others in ten seconds.
const length = t1 - t0, pace = length >= 1 && length <= 60 ? 1 : length / 10;
const stop = () => { if (running) { cancelAnimationFrame(running); running = 0; one('#play').textContent = '▶'; } };
const step = at => {
  const t = now + (at - last) / 1000 * pace * one('#speed').value;
  last = at;
  if (t >= t1) { show(t1); stop(); return; }
  show(t);
  running = requestAnimationFrame(step);
};
one('#play').onclick = () => {
  if (running) return stop();
  if (now >= t1 - 1e-9 * length) show(t0);
  last = performance.now();
  one('#play').textContent = '❚❚';
  running = requestAnimationFrame(step);
};
scrub.oninput = () => { stop(); show(t0 + (t1 - t0) * scrub.value / 1000); };
all('.marks button').forEach(b => b.onclick = () => { stop(); show(+b.dataset.t); });
for (const id of ['#forces', '#velocity', '#trail']) if (one(id)) one(id).onchange = () => show(now);
all('.plot > svg').forEach(makePlot);
const wanted = location.hash.match(/t=([\d.]+)/);
now = wanted ? Math.min(t1, Math.max(t0, +wanted[1])) : S ? ft[S.best] : D.marks.length ? D.marks[0][0] : t0;
plots.forEach(p => p.draw());
show(now);
let waiting = 0;
addEventListener('resize', () => { clearTimeout(waiting); waiting = setTimeout(() => plots.forEach(p => p.draw()), 60); });
addEventListener('beforeprint', () => plots.forEach(p => p.draw()));
})();
