// Opens the page in a headless Chromium, and operates it with mouse and keys.
import assert from "node:assert/strict";
import fs from "node:fs";
import puppeteer from "puppeteer-core";

export const wait = (ms) => new Promise((done) => setTimeout(done, ms));
// CLOCK_MONOTONIC, which stamps the messages too.
export const now_ns = () => Number(process.hrtime.bigint());
export const TIMEOUT_MS = 60000; // liveness, not speed: the machine may be busy

// Waits until the condition holds; `what` names the condition in the error message.
export async function until(what, check, timeout_ms = TIMEOUT_MS) {
  const end = Date.now() + timeout_ms;
  let last;
  for (;;) {
    try { last = await check(); } catch (error) { last = error.message; }
    if (last === true) return;
    assert.ok(Date.now() < end, `timeout before ${what} (last: ${JSON.stringify(last)})`);
    await wait(100);
  }
}

export class Browser {
  static launch() {
    return puppeteer.launch({
      executablePath: "/usr/bin/chromium", headless: true,
      args: ["--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", ...(process.getuid() === 0 ? ["--no-sandbox"] : [])],
    });
  }
  // shared: a launched browser; the page has its own storage in it. Default: a browser of its own.
  static async open(url, shared) {
    const it = new Browser();
    it.errors = [];
    it.browser = shared ?? await Browser.launch();
    it.context = shared ? await shared.createBrowserContext() : it.browser;
    it.page = await it.context.newPage();
    await it.page.setViewport({ width: 1440, height: 1000 });
    it.page.on("pageerror", (error) => it.errors.push(error.message));
    it.page.on("console", (line) => { if (line.type() === "error") it.errors.push(line.text()); });
    await it.page.goto(url);
    return it;
  }
  text(selector) { return this.page.$eval(selector, (e) => e.innerText.trim()); }
  has(selector) { return this.page.$(selector).then((e) => e !== null); }
  pictures() { return this.page.$eval("#picture", (e) => Number(e.dataset.count ?? "0")); }
  // Sets a slider and releases it.
  slide(selector, value) {
    return this.page.$eval(selector, (e, v) => {
      e.value = String(v);
      e.dispatchEvent(new Event("input", { bubbles: true }));
      e.dispatchEvent(new Event("change", { bubbles: true }));
    }, value);
  }
  click(selector) { return this.page.$eval(selector, (e) => e.click()); }
  async add(name) {
    await this.page.focus("#choose");
    await this.page.keyboard.sendCharacter(name);
    await this.page.keyboard.press("Enter");
  }
  // The modalities in the order of their lanes.
  senses() { return this.page.$$eval("#senses tr[data-modality]", (rows) => rows.map((r) => r.dataset.modality)); }
  // Number of pixels of marks in each lane of the event raster: pixels nearer to the colour of the lane than to the background.
  marks() {
    return this.page.evaluate(() => {
      const canvas = document.getElementById("raster"), rows = [...document.querySelectorAll("#senses tr[data-modality]")];
      const rgb = (css) => { const c = document.createElement("canvas").getContext("2d"); c.fillStyle = css; c.fillRect(0, 0, 1, 1); return c.getImageData(0, 0, 1, 1).data; };
      const variable = (name) => getComputedStyle(document.body).getPropertyValue(name).trim();
      const lanes = [["world", variable("--world")], ...rows.map((r) => [r.dataset.modality, r.dataset.colour])];
      const scale = devicePixelRatio, lane = 24 * scale, left = Math.ceil(82 * scale), background = rgb(variable("--line"));
      const far = (d, i, c) => (d[i] - c[0]) ** 2 + (d[i + 1] - c[1]) ** 2 + (d[i + 2] - c[2]) ** 2;
      return Object.fromEntries(lanes.map(([name, css], n) => {
        const own = rgb(css), d = canvas.getContext("2d").getImageData(left, n * lane, canvas.width - left, lane).data;
        let count = 0;
        for (let i = 0; i < d.length; i += 4) if (d[i + 3] > 100 && far(d, i, own) < far(d, i, background)) ++count;
        return [name, count];
      }));
    });
  }
  // Number of values in the graph of this variable.
  drawn(name) { return this.page.$$eval(".card", (cards, wanted) => Number(cards.find((c) => c.dataset.name === wanted)?.dataset.values ?? "0"), name); }
  value(name) { return this.page.$$eval(".card", (cards, wanted) => cards.find((c) => c.dataset.name === wanted)?.innerText ?? "", name); }
  // Distinct colours of the first scale of asynchrony.
  bands() {
    return this.page.evaluate(() => {
      const rgb = (css) => { const c = document.createElement("canvas").getContext("2d"); c.fillStyle = css; c.fillRect(0, 0, 1, 1); return [...c.getImageData(0, 0, 1, 1).data].join(); };
      const wanted = [".band.least", ".band.largest"].map((s) => rgb(getComputedStyle(document.querySelector(s)).backgroundColor));
      const seen = new Set();
      for (const canvas of document.querySelectorAll(".pair canvas")) {
        const d = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
        for (let i = 0; i < d.length; i += 4) seen.add([...d.slice(i, i + 4)].join());
      }
      return wanted.map((c) => seen.has(c));
    });
  }
  // Every process of this browser: it and all its descendants.
  processes() {
    const children = new Map();
    for (const name of fs.readdirSync("/proc").filter((n) => /^\d+$/.test(n))) {
      try {
        const stat = fs.readFileSync(`/proc/${name}/stat`, "utf8"), parent = Number(stat.slice(stat.lastIndexOf(")") + 2).split(" ")[1]);
        children.set(parent, [...(children.get(parent) ?? []), Number(name)]);
      } catch { /* ended meanwhile */ }
    }
    const all = [this.browser.process().pid];
    for (let i = 0; i < all.length; ++i) all.push(...(children.get(all[i]) ?? []));
    return all;
  }
  signal(number) {
    for (const pid of this.processes()) try { process.kill(pid, number); } catch { /* ended meanwhile */ }
  }
  async close() { await this.context.close(); }
}
