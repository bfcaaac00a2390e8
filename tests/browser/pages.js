// Opens each page in Chromium and says what it saw, one JSON object a line.  Started by report_test.py.
'use strict';
const fs = require('fs'), path = require('path');
const { chromium } = require('playwright-core');
const axe = fs.readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
const { chromium: executablePath, jobs, pictures } = JSON.parse(fs.readFileSync(process.argv[2], 'utf8'));
const none = async (name, list) => { const found = await list; say(name, !found.length, found); };
const say = (name, ok, detail) => console.log(JSON.stringify({ name, ok: !!ok, detail }));

async function open(browser, job, set, run) {
  const context = await browser.newContext({ viewport: { width: 1100, height: 900 }, ...set });
  const page = await context.newPage(), trouble = [], requests = [];
  page.on('console', m => { if (m.type() === 'error' || m.type() === 'warning') trouble.push(m.text()); });
  page.on('pageerror', e => trouble.push(e.message));
  page.on('request', r => { if (!/^(file|data|blob):/.test(r.url())) requests.push(r.url()); });
  await page.goto('file://' + job.path);
  await page.evaluate(() => document.fonts.ready);
  await run(page);
  await context.close();
  return { trouble, requests };
}

// Texts of a picture or plot: boxes that lie on each other, or outside.
const badTexts = page => page.evaluate(() => {
  const bad = [];
  for (const svg of document.querySelectorAll('#anim, .plot > svg')) {
    const frame = svg.getBoundingClientRect();
    const texts = [...svg.querySelectorAll('text')].filter(t => t.getClientRects().length && t.textContent).map(t => [t.textContent, t.getBoundingClientRect()]);
    texts.forEach(([s, a], i) => {
      if (a.left < frame.left - 1 || a.right > frame.right + 1 || a.top < frame.top - 1 || a.bottom > frame.bottom + 1) bad.push('outside: ' + s);
      for (const [s2, b] of texts.slice(i + 1)) {
        const x = Math.min(a.right, b.right) - Math.max(a.left, b.left), y = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (x > 2 && y > 4) bad.push(s + ' on ' + s2);
      }
    });
  }
  return bad;
});
const tooWide = page => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
const overlapping = page => page.evaluate(() => {
  const bad = [], boxes = [...document.querySelectorAll('main h1,main h2,main h3,main h4,main p,main .eq,main table,main figure,main .plot')]
    .filter(e => !e.closest('details:not([open])') && e.getClientRects().length && !e.classList.contains('vh'));
  boxes.forEach((e, i) => {
    const a = e.getBoundingClientRect();
    for (const f of boxes.slice(i + 1, i + 8)) {
      if (e.contains(f) || f.contains(e)) continue;
      const b = f.getBoundingClientRect();
      if (Math.min(a.right, b.right) - Math.max(a.left, b.left) > 2 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 3) bad.push(e.tagName + ' ' + e.textContent.slice(0, 30) + ' / ' + f.tagName + ' ' + f.textContent.slice(0, 30));
    }
  });
  return bad;
});
const accessibility = async page => {
  await page.evaluate(axe);
  const found = await page.evaluate(() => axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'best-practice'] }));
  return found.violations.map(v => v.id + ': ' + v.nodes.slice(0, 3).map(n => n.target.join(' ')).join(', '));
};
const state = page => page.evaluate(() => ({
  time: document.querySelector('#time').textContent,
  picture: [...document.querySelectorAll('#anim g[data-i]')].map(g => g.innerHTML).join(),
  cursors: [...document.querySelectorAll('.plot .cur')].map(c => c.getAttribute('x1')).join(),
  values: [...document.querySelectorAll('.plot output')].map(o => o.textContent).join(),
}));
const number = s => +s.replace('−', '-').replace(',', '.').replace(/·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/, (m, e) => 'e' + [...e].map(c => c === '⁻' ? '-' : '⁰¹²³⁴⁵⁶⁷⁸⁹'.indexOf(c)).join(''));

async function moves(page, name) {
  const before = await state(page);
  await page.locator('#scrub').evaluate(e => { e.value = 300; e.dispatchEvent(new Event('input')); });
  const after = await state(page);
  say(name + ': the scrubber moves time, picture and cursors', before.time !== after.time && before.picture !== after.picture && before.cursors !== after.cursors);
  const plot = page.locator('.plot > svg').first(), box = await plot.boundingBox();
  await page.mouse.move(box.x + box.width * .6, box.y + box.height / 2);
  const hovered = await state(page);
  say(name + ': hovering a plot moves the picture', hovered.time !== after.time && hovered.picture !== after.picture);
  await plot.focus();
  await page.keyboard.press('ArrowRight');
  say(name + ': arrow keys step', (await state(page)).time !== hovered.time);
  const ticks = () => page.evaluate(() => [...document.querySelectorAll('.plot > svg .m')].map(t => t.textContent).join());
  const wide = await ticks();
  await page.mouse.move(box.x + box.width * .4, box.y + 60);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * .6, box.y + 60, { steps: 4 });
  await page.mouse.up();
  const zoomed = await ticks();
  await page.mouse.dblclick(box.x + box.width * .5, box.y + 60);
  say(name + ': dragging zooms, a double-click resets', zoomed !== wide && (await ticks()) === wide);
}

// Values read at times of the file of `sim`, in the units of the file.
async function reads(page, name, sim) {
  const times = sim['t [s]'].map(Number), wrong = [];
  for (const i of [Math.floor(times.length * .3), Math.floor(times.length * .55), Math.floor(times.length * .8)]) {
    const shown = await page.evaluate(t => {
      const D = JSON.parse(document.querySelector('#data').textContent), x = s => new Float32Array(Uint8Array.from(atob(s), c => c.charCodeAt(0)).buffer);
      const tt = x(D.thin.x[0]), t0 = tt[0], t1 = tt[tt.length - 1], scrub = document.querySelector('#scrub');
      scrub.value = 1000 * (t - t0) / (t1 - t0);
      scrub.dispatchEvent(new Event('input'));
      return D.plots.map((p, k) => p.y.map((c, j) => [D.thin.head[c], document.querySelectorAll('.plot')[k].querySelectorAll('output')[j].textContent])).flat();
    }, times[i]);
    for (const [head, text] of shown) {
      const given = sim[head] || (head === 'λ/(m g)' ? sim['lambda_h [N]'].map(v => v / (75 * 9.81)) : Object.entries(sim).filter(([k]) => k === { 'ϑ [rad]': 'theta [rad]', 'φ [rad]': 'phi [rad]', 'x₂ [m]': 'x2 [m]' }[head]).map(e => e[1])[0]);
      if (!given) { wrong.push('no column ' + head); continue; }
      const size = Math.max(...given.map(v => Math.abs(v) || 0));
      if (Math.abs(number(text) - given[i]) > 2e-3 * size) wrong.push([head, times[i], text, given[i]]);
    }
  }
  say(name + ': hover reads the values of sim', wrong.length === 0, wrong);
}

async function deep(browser, job) {
  let printed = 0, dark = null, light = null;
  await open(browser, job, {}, async page => {
    await moves(page, job.name);
    if (job.sim && job.sim['t [s]']) await reads(page, job.name, job.sim);
    light = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await page.click('#theme');
    dark = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    say(job.name + ': the theme switches', dark !== light);
    await none(job.name + ': accessible in the other theme', accessibility(page));
    await page.evaluate(() => { window.copied = null; navigator.clipboard.writeText = s => { window.copied = s; return Promise.resolve(); }; });
    await page.locator('#derivation > .eq .cp').first().click({ force: true });
    const copied = await page.evaluate(() => window.copied), first = await page.locator('#derivation > .eq annotation').first().textContent();
    say(job.name + ': an equation is copied as LaTeX', copied && copied === first, copied);
    printed = (await page.pdf({ format: 'A4', printBackground: true, preferCSSPageSize: true })).length;
    await page.emulateMedia({ media: 'print' });
    say(job.name + ': printing hides the controls and writes pages', printed > 20000 && !(await page.locator('.ctl').first().isVisible()), printed);
  });
  await open(browser, job, { viewport: { width: 390, height: 844 }, colorScheme: 'dark' }, async page => {
    say(job.name + ': nothing sticks out on a phone', (await tooWide(page)) <= 0, await tooWide(page));
    await none(job.name + ': texts are apart on a phone', badTexts(page));
    await none(job.name + ': accessible on a phone, in the dark', accessibility(page));
    if (pictures) await page.screenshot({ path: path.join(pictures, job.name + '-phone.png'), fullPage: true });
  });
  await open(browser, job, { reducedMotion: 'reduce' }, async page => {
    const a = await state(page);
    await page.waitForTimeout(250);
    say(job.name + ': nothing moves by itself', JSON.stringify(a) === JSON.stringify(await state(page)));
  });
}

async function look(browser, job) {
  const seen = await open(browser, job, {}, async page => {
    await none(job.name + ': texts of pictures are apart and inside', badTexts(page));
    await none(job.name + ': nothing overlaps', overlapping(page));
    say(job.name + ': nothing sticks out', (await tooWide(page)) <= 0);
    await none(job.name + ': accessible', accessibility(page));
    if (job.hostile) {
      say('hostile: nothing of the model runs', !(await page.evaluate(() => window.hurt)));
      const text = await page.evaluate(() => [document.title, document.querySelector('h1').textContent, document.querySelector('.lead').textContent, document.querySelector('.src').textContent]);
      say('hostile: everything is shown as it is written', text[0].includes('<img src=x onerror=hurt=1>') && text[1].includes('</script>') && text[2].includes('<b onclick="hurt=1">') && text[2].includes('U+202E') && text[3].includes('</textarea>'), text);
    }
    if (job.german) say('ski-de: German words and decimal commas', await page.evaluate(() => document.documentElement.lang === 'de' && /Herleitung/.test(document.body.textContent) && /48,1897/.test(document.body.textContent)));
    if (pictures) await page.screenshot({ path: path.join(pictures, job.name + '.png'), fullPage: true });
  });
  say(job.name + ': no error, no warning', !seen.trouble.length, seen.trouble);
  say(job.name + ': no request', !seen.requests.length, seen.requests);
}

(async () => {
  const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-gpu'] });
  for (const job of jobs) {
    await look(browser, job);
    if (job.deep) await deep(browser, job);
  }
  await browser.close();
})().catch(e => { console.error(e); process.exit(1); });
