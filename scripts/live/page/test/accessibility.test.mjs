// Checks the page in a browser with messages of its own instead of a server: WCAG 2.2 AA by axe-core in every contrast and size, all controls by the
// keyboard alone, and no information by colour alone.
//
//   node accessibility.test.mjs [FOLDER]     FOLDER: where screenshots go
import assert from "node:assert/strict";
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import { fileURLToPath } from "node:url";

const page = path.dirname(path.dirname(fileURLToPath(import.meta.url))), [folder] = process.argv.slice(2);
for (const [needed, remedy] of [["/usr/bin/chromium", "scripts/setup test"], [path.join(page, "node_modules/puppeteer-core"), "scripts/live/bundle --for-tests"],
  [path.join(page, "node_modules/axe-core"), "scripts/live/bundle --for-tests"], [path.join(page, "dist/main.js"), "scripts/live/bundle"]])
  if (!fs.existsSync(needed)) { console.error(`${needed} is missing; run ${remedy}`); process.exit(77); }
const { Browser, until } = await import("./browser.mjs");
const axe = fs.readFileSync(path.join(page, "node_modules/axe-core/axe.min.js"), "utf8");
const TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];

const browser = await Browser.launch();
const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
const server = http.createServer((request, response) => {
  const file = path.join(page, "dist", path.basename(new URL(request.url, "http://x").pathname) || "index.html");
  if (!fs.existsSync(file)) { response.writeHead(404).end(); return; }
  response.writeHead(200, { "Content-Type": types[path.extname(file)] ?? "application/octet-stream" }).end(fs.readFileSync(file));
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const url = `http://127.0.0.1:${server.address().port}/`;

// The messages of a run with four modalities, two hands and a node that is slow.
const health = [["sim_node", "", 1, false, 1000, 1000], ["haptic_node", "haptic", 1, false, 1000, 1000], ["haptic_node_left", "haptic", 1, false, 1000, 1000], ["audio_node", "audio", 1, false, 375, 375],
  ["visual_node", "visual", 1, false, 21, 60], ["thermal_node", "thermal", 3, true, 50, 50]].map(([node, modality, state, lost, rate, nominal], i) =>
  ({ node, source: i + 1, modality, state, lost, note: lost ? "no message for 2 s" : "normal scheduling", rate_Hz: rate, nominal_Hz: nominal, missed: i, ticks: 1000, rendered: 5, profile: "0", realtime: 1, gaps: 0, tick_max_us: 900, wake_max_us: 90 }));
const report = { senses: ["audio", "haptic", "visual"].map((modality) => ({ modality, expected: 40, presented: 38, lost: modality === "visual" ? 2 : 0, dropped: 0, late: 1 })),
  pairs: [{ a: "audio", b: "visual", n: 30, p05_ms: -20, p50_ms: 12, p95_ms: 60, beyond_least: 3 }, { a: "haptic", b: "audio", n: 30, p05_ms: 5, p50_ms: 9, p95_ms: 15, beyond_least: 0 }] };
const thresholds = [{ earlier: "audio", later: "visual", ms: 45, what: "detected", source: "ITU-R BT.1359-1" }, { earlier: "audio", later: "visual", ms: 90, what: "accepted", source: "ITU-R BT.1359-1" },
  { earlier: "visual", later: "audio", ms: 125, what: "detected", source: "ITU-R BT.1359-1" }];
const hello = (live) => ({ t: "hello", live, title: "dark_room", thresholds, catalog: [{ name: "TOOL_STATE:force_N.z", unit: "N", about: "force" }], tags: [], now: 10, health, report });
const controls = { "haptic:force": { deadband: true, choices: [{ name: "predict", of: "deadband", values: ["hold", "linear"] }, { name: "passivity", of: "", values: ["none", "tdpa"] }] },
  "haptic:percept": { deadband: true, choices: [] } };
const frame = (more = {}) => ({ t: "frame", now: 12, health, report, world: { known: true, sim_s: 12, rate: 1 }, profile: "7", degradation: { name: "late sound", senses: { audio: { delay_ms: 40, rate_Hz: 0, loss: 0.1, deadband: 0, choices: {}, more: true } }, stages: ["haptic:force", "haptic:percept"], controls },
  values: Array.from({ length: 40 }, (_, i) => [[0, 2 + i / 4, Math.sin(i / 3), 2], [0, 2 + i / 4, Math.cos(i / 3), 3], [1, 2 + i / 4, i / 40, 2], [2, 2 + i / 4, 31 + i / 40, 6]]).flat(),
  events: [[9, 0, 1, 2, 0], [9.5, 1, 1, 2, 0.8], [10, 2, 1, 2, 0]], presented: [[9.5, "audio", 0, 0, 11], [9.5, "visual", 0, 3, null], [9.6, "haptic", 1, 0, 2], [9.7, "audio", 0, 4, null]], pages: { open: 1, dropped: 0, refused: 0 }, ...more });
const asked = (more) => ({ question: "5.11", kind: "choice", text: "Did sound and picture come together?", choices: ["together", "apart"], lowest: 0, highest: 0, step: 0, trial: 3, condition: "audio +80 ms",
  progress: "trial 3 of 40", hint: "", answered: false, leader: "trial_runner", ...more });

// The page with a socket that records its messages and receives those of the test.
async function open(query) {
  const it = await Browser.open("about:blank", browser);
  await it.page.evaluateOnNewDocument(() => {
    window.sent = [];
    window.WebSocket = class { static OPEN = 1; readyState = 1; constructor() { window.socket = this; setTimeout(() => this.onopen?.()); } send(text) { window.sent.push(JSON.parse(text)); } };
  });
  await it.page.goto(url + query);
  it.receive = (m) => it.page.evaluate((text) => window.socket.onmessage({ data: text }), JSON.stringify(m));
  it.sent = (t) => it.page.evaluate((kind) => window.sent.filter((m) => m.t === kind), t);
  it.axe = async () => {
    await it.page.evaluate(axe);
    const { violations } = await it.page.evaluate((tags) => window.axe.run(document, { runOnly: { type: "tag", values: tags } }), TAGS);
    return violations.map((v) => `${v.id} (${v.help}): ${v.nodes.slice(0, 3).map((n) => `${n.target.join(" ")}: ${n.any.concat(n.all, n.none).map((c) => c.message)[0] ?? ""}`).join(" | ")}`);
  };
  it.keep = async (name) => { if (folder) { await it.page.screenshot({ path: path.join(folder, name) }); } };
  it.focused = () => it.page.evaluate(() => { const e = document.activeElement; return e === document.body ? "" : e.id || e.getAttribute("aria-label") || e.innerText?.split("\n")[0] || e.tagName; });
  return it;
}
const settle = () => new Promise((done) => setTimeout(done, 400));

let failed = 0, checked = 0;
async function test(name, body) {
  try { await body(); console.log(`ok: ${name}`); } catch (error) { ++failed; console.error(`FAILED: ${name}\n${error.message}`); }
}
async function without_violations(it, what) {
  await settle();
  const found = await it.axe();
  ++checked;
  assert.deepEqual(found, [], `${what}: axe-core reports ${found.length} violations`);
}

for (const contrast of ["dark", "light", "high"]) for (const size of ["100", "200"]) {
  await test(`a run, a log and each question in contrast ${contrast} at ${size} % have no violation`, async () => {
    const it = await open(`?token=x&contrast=${contrast}&size=${size}`);
    try {
      await it.receive(hello(true));
      await it.receive(frame({ study: asked() }));
      await it.page.focus("#choose");
      await without_violations(it, "the page of a run");
      await it.keep(`run_${contrast}_${size}.png`);
      await it.receive({ t: "reply", text: "the world is paused", good: false });
      await it.page.click("#display summary");
      await it.page.$eval("#pairs details", (e) => { e.open = true; });
      await without_violations(it, "the page of a run with a message and open boxes");
      assert.ok(await it.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth + 1), "the page must not scroll sideways");
    } finally { await it.close(); }
    const log = await open(`?token=x&contrast=${contrast}&size=${size}`);
    try {
      await log.receive(hello(false));
      await log.receive(frame({ log: { position_s: 3, length_s: 20, playing: true, rate: 1, damaged: 0, warnings: [] } }));
      await without_violations(log, "the page of a log");
    } finally { await log.close(); }
    const person = await open(`?token=x&participant&contrast=${contrast}&size=${size}`);
    try {
      await person.receive(hello(true));
      for (const [name, question] of [["choice", asked()], ["number", asked({ question: "5.12", kind: "number", choices: ["very soft", "very hard"], lowest: 0, highest: 100, step: 1, text: "How hard was it?" })],
        ["read", asked({ question: "5.13", kind: "read", choices: [], text: "A hand taps on a board." })]]) {
        await person.receive(frame({ study: question }));
        await without_violations(person, `the question "${name}"`);
        await person.keep(`${name}_${contrast}_${size}.png`);
        assert.ok(await person.page.$eval("#study", (e) => e.getBoundingClientRect().right <= innerWidth && e.getBoundingClientRect().left >= 0), "the question must be within the page");
      }
    } finally { await person.close(); }
  });
}

await test("Tab reaches every control of the page, and each has a name and a visible focus", async () => {
  const it = await open("?token=x");
  try {
    await it.receive(hello(true));
    await it.receive(frame());
    await settle();
    // A disabled control is out of the order of Tab until its slider is above 0.
    const reaches_all = async (disabled) => {
      const [enabled, off] = await it.page.$$eval("button, select, input, summary, [tabindex='0']", (all) => {
        for (const e of all) delete e.dataset.seen;
        const visible = all.filter((e) => e.checkVisibility());
        return [visible.filter((e) => !e.disabled).length, visible.filter((e) => e.disabled).map((e) => e.id)];
      });
      assert.deepEqual(off, disabled, "the disabled controls");
      const seen = new Set();
      for (let i = 0; i < enabled + 5; ++i) {
        await it.page.keyboard.press("Tab");
        const at = await it.page.evaluate(() => {
          const e = document.activeElement;
          if (e === document.body) return "";
          e.dataset.seen ??= String(document.querySelectorAll("[data-seen]").length);
          return getComputedStyle(e).outlineStyle === "none" ? `no outline: ${e.outerHTML.slice(0, 80)}` : e.dataset.seen;
        });
        assert.ok(!at.startsWith("no outline"), at);
        if (at) seen.add(at);
      }
      assert.equal(seen.size, enabled, "the controls that Tab reaches");
    };
    await reaches_all(["haptic:force-predict"]);
    await it.page.focus("[id='haptic:force-deadband']");
    await it.page.keyboard.press("ArrowRight");
    await reaches_all([]);
  } finally { await it.close(); }
});

await test("a run is paused, stepped and degraded by the keyboard alone, and a slider keeps the focus", async () => {
  const it = await open("?token=x");
  try {
    await it.receive(hello(true));
    await it.receive(frame());
    await it.page.focus("#pause");
    await it.page.keyboard.press("Enter");
    await it.page.focus("#step");
    await it.page.keyboard.press("Space");
    assert.deepEqual((await it.sent("command")).map((m) => m.what), ["pause", "step"]);
    await it.page.focus("#audio-delay");
    await it.page.keyboard.press("ArrowRight");
    await until("the slider has sent its value", async () => (await it.sent("degrade")).at(-1)?.senses.audio.delay_ms === 45 || it.sent("degrade"));
    assert.equal(await it.page.$eval("#audio-delay", (e) => e.getAttribute("aria-valuetext")), "45 ms");
    await it.page.evaluate(() => new Promise((done) => setTimeout(done, 1600)));  // SETTLE_MS of sliders.ts
    await it.receive(frame({ degradation: { name: "other", senses: { audio: { delay_ms: 10, rate_Hz: 0, loss: 0, deadband: 0, choices: {}, more: false } }, stages: [], controls: {} } }));
    assert.equal(await it.focused(), "audio-delay");
    await it.page.focus("#pairs summary");
    await it.page.keyboard.press("Enter");
    await it.receive(frame());
    assert.match(await it.text("#pairs details[open] .sources"), /ITU-R BT.1359-1/);
  } finally { await it.close(); }
});

await test("the arrow keys move the hand, and it rests when the focus leaves", async () => {
  const it = await open("?token=x");
  try {
    await it.receive(hello(true));
    await it.page.focus("#hand");
    await it.page.keyboard.press("Space");
    await it.page.focus("#frame");
    await it.page.keyboard.down("ArrowRight");
    await until("the hand moves to the right", async () => (await it.sent("hand")).some((m) => m.x > 0.1 && m.y === 0) || (await it.sent("hand")).at(-1));
    await it.page.keyboard.up("ArrowRight");
    await it.page.keyboard.down("PageUp");
    await until("the hand is pushed", async () => (await it.sent("hand")).some((m) => m.push_m > 0));
    await it.page.keyboard.down(" ");
    await until("its button is pressed", async () => (await it.sent("hand")).at(-1)?.down === true);
    await it.page.focus("#choose");
    await until("its button is released", async () => (await it.sent("hand")).at(-1)?.down === false);
  } finally { await it.close(); }
});

await test("a question is answered by Tab and Enter, by digits and by arrows; its display settings do not answer it", async () => {
  const it = await open("?token=x&participant");
  try {
    await it.receive(hello(true));
    await it.receive(frame({ study: asked() }));
    await settle();
    await it.page.focus("#display summary");
    await it.page.keyboard.press("Enter");
    await it.page.focus("#textsize");
    await it.page.keyboard.press("1");
    await it.page.keyboard.press("ArrowDown");
    assert.deepEqual(await it.sent("answer"), []);
    await it.page.keyboard.press("Escape");
    assert.equal(await it.page.$eval("#display", (e) => e.open), false);
    for (let i = 0; i < 2; ++i) await it.page.keyboard.press("Tab");
    assert.match(await it.focused(), /apart|2/);
    await it.page.keyboard.press("Enter");
    assert.deepEqual((await it.sent("answer")).map((m) => m.choice), [1]);
    await it.receive(frame({ study: asked({ question: "5.12", kind: "number", lowest: 0, highest: 10, step: 1, choices: [] }) }));
    await settle();
    await it.page.keyboard.press("ArrowRight");
    await it.page.keyboard.press("Enter");
    assert.deepEqual((await it.sent("answer")).map((m) => m.number), [0, 6]);
  } finally { await it.close(); }
});

await test("size and contrast are kept for the next visit", async () => {
  const it = await open("?token=x");
  try {
    await it.page.$eval("#display", (e) => { e.open = true; });
    await it.page.select("#textsize", "150");
    await it.page.select("#contrast", "light");
    await it.page.goto(`${url}?token=x`);
    assert.deepEqual(await it.page.evaluate(() => [document.documentElement.dataset.size, document.body.dataset.contrast]), ["150", "light"]);
  } finally { await it.close(); }
});

await test("a slow node, a lost node, a dropped event and each of two curves have a sign besides their colour", async () => {
  const it = await open("?token=x");
  try {
    await it.receive(hello(true));
    await it.receive(frame());
    await settle();
    assert.match(await it.text('#senses tr[data-modality="visual"]'), /slow/);
    assert.match(await it.text('#senses tr[data-modality="thermal"]'), /lost/);
    assert.match(await it.text('#nodes tr[data-node="thermal_node"]'), /LOST[\s\S]*/);
    assert.match(await it.text('#nodes tr[data-node="thermal_node"]'), /no message for 2 s/);
    assert.match(await it.text('.card[data-name="TOOL_STATE:force_N.z"]'), /haptic_node .*haptic_node_left /s);
    const dashes = await it.page.$$eval('.card[data-name="TOOL_STATE:force_N.z"] .sample line', (all) => all.map((e) => e.getAttribute("stroke-dasharray")));
    assert.equal(new Set(dashes).size, 2, "the two curves have different dashes");
    assert.match(await it.page.$eval("#raster", (e) => e.getAttribute("aria-label")), /audio 1 presented/);
  } finally { await it.close(); }
});

await browser.close();
server.close();
console.log(`axe-core checked ${checked} pages`);
process.exitCode = failed ? 1 : 0;
