// Operates each control of the page of a running cluster in a browser, and checks the display. Writes the time of each action to
// MARKS; tests/cluster/live_test.cpp reads the effects on the bus from the log of the run.
//
//   node run.test.mjs URL MARKS [PICTURE.png]
import assert from "node:assert/strict";
import fs from "node:fs";
import http from "node:http";
import { Browser, now_ns, until, wait } from "./browser.mjs";

const [url, marksFile, screenshot] = process.argv.slice(2);
const marks = {}, begun = Date.now();
function mark(name) {
  marks[name] = now_ns();
  fs.writeFileSync(marksFile, JSON.stringify(marks));
  console.log(`${((Date.now() - begun) / 1000).toFixed(1)} s: ${name}`);
}
// The HTTP status of a WebSocket request with this origin and token; 101: it is opened.
function upgrade(origin, token) {
  const at = new URL(url);
  return new Promise((done, failed) => {
    const request = http.request({ host: at.hostname, port: at.port, path: `/ws?token=${token}`,
      headers: { Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", ...(origin ? { Origin: origin } : {}) } });
    request.on("upgrade", (response, socket) => { socket.destroy(); done(response.statusCode); });
    request.on("response", (response) => { response.resume(); done(response.statusCode); });
    request.on("error", failed);
    request.end();
  });
}
// Resident memory of the server, MB.
function server_MB() {
  for (const name of fs.readdirSync("/proc").filter((n) => /^\d+$/.test(n))) {
    try {
      if (fs.readFileSync(`/proc/${name}/comm`, "utf8").trim() === "live_server")
        return Number(/VmRSS:\s+(\d+)/.exec(fs.readFileSync(`/proc/${name}/status`, "utf8"))[1]) / 1024;
    } catch { /* ended meanwhile */ }
  }
  throw new Error("no live_server runs");
}

const it = await Browser.open(url);
// Number of nodes that have applied the profile in force.
const taken = () => it.page.$$eval("#nodes td:last-child", (cells) => cells.filter((c) => c.innerText === "taken").length);
try {
  await until("the page is connected and shows pictures", async () => /^connected/.test(await it.text("#link")) && (await it.pictures()) > 2);
  await until("all modalities are listed", async () => (await it.senses()).join() === "audio,haptic,thermal,visual" || it.senses());
  mark("shown");

  // The mouse as the hand: from above the floor down into it and up again, several times; then the page is silent.
  await it.click("#hand");
  const box = await (await it.page.$("#frame")).boundingBox();
  const at = (x, y) => it.page.mouse.move(box.x + box.width * (1 + x) / 2, box.y + box.height * (1 - y) / 2);
  mark("hand");
  for (let i = 0; i < 4; ++i) {
    await at(0, 0.15);
    await wait(350);
    await at(0.1, -0.45);
    await wait(350);
  }
  await at(0, 0.1);
  await wait(600);
  await it.click("#hand");
  mark("let_go");

  await until("the event raster has marks in every lane", async () => {
    const found = await it.marks();
    return ["world", "audio", "haptic", "thermal", "visual"].every((lane) => found[lane] > 0) || found;
  });
  await until("every modality has a rate, and two have a latency", async () => {
    const rows = await it.page.$$eval("#senses tr[data-modality]", (all) => all.map((r) => [...r.children].map((c) => c.innerText)));
    return rows.every((r) => / \/ \d+ Hz$/.test(r[1]) && Number.parseFloat(r[1]) > 0) && rows.filter((r) => /ms$/.test(r[2]) && /ms$/.test(r[3])).length >= 2 || rows;
  });
  await until("the asynchrony of pairs is drawn on published bands", async () => (await it.bands()).every((b) => b) || it.bands());
  mark("filled");

  // A tagged variable, and a field.
  await it.add("sim_node.work.collision");
  mark("tag");
  await it.add("WORLD_STATE:clock.sim_ns");
  for (const name of ["sim_node.work.collision", "WORLD_STATE:clock.sim_ns", "TOOL_STATE:force_N.z"])
    await until(`the graph of ${name} fills`, async () => (await it.drawn(name)) > 20 || it.drawn(name));
  // The same as a bar and as text, and a graph again.
  const card = '.card[data-name="sim_node.work.collision"]';
  await it.page.select(`${card} select`, "bar");
  await until("a bar has a length and its ends are named", () => it.page.$eval(card, (c) =>
    Number.parseFloat(c.querySelector(".bar i")?.style.width) > 0 && [...c.querySelectorAll(".ends span")].every((e) => e.innerText !== "") || c.innerText));
  await it.page.select(`${card} select`, "text");
  await until("text is a number with its unit", () => it.page.$eval(card, (c) => /^\d[\d.]* us$/.test(c.querySelector(".big")?.innerText) || c.innerText));
  await it.page.select(`${card} select`, "graph");
  if (screenshot) await it.page.screenshot({ path: screenshot });

  // Degrades modalities and restores them. The sliders start at the profile of the run.
  await until("the slider of warmth shows the profile in force", async () =>
    (await it.page.$eval("#thermal-delay", (e) => e.value)) === "30" && /late warmth/.test(await it.text("#inforce")) || it.text("#inforce"));
  await it.slide("#audio-delay", 80);
  await it.slide("#visual-rate", 3); // the fourth rate: 10 Hz
  await it.slide("#haptic-loss", 50);
  mark("degrade");
  // All three: the page sends after a pause of the sliders; a busy machine may cause a pause between two of them.
  await until("the profile has the values of all sliders", async () => {
    const s = JSON.parse(await it.page.$eval("#inforce", (e) => e.dataset.senses ?? "{}"));
    return s.audio?.delay_ms === 80 && s.visual?.rate_Hz === 10 && s.haptic?.loss === 0.5 || s;
  });
  await until("all modalities have the profile", async () =>
    /changed in the live page/.test(await it.text("#inforce")) && (await taken()) === 4 || it.text("#nodes"));
  mark("degraded");
  mark("clear");  // before the click: the message may be on the bus before the click returns
  await it.click("#clear");
  await until("all modalities are restored", async () =>
    (await it.page.$eval("#inforce", (e) => e.dataset.senses)) === "{}" && (await taken()) === 4 || it.text("#nodes"));
  mark("cleared");

  // Pauses the world, advances it by 25 steps, resumes it, and resets it.
  await it.click("#pause");
  await until("the world is paused", async () => /stands still/.test(await it.text("#world")) || it.text("#world"));
  await wait(300);
  mark("paused");
  await it.page.$eval("#steps", (e) => { e.value = "25"; });
  await it.click("#step");
  await until("the world has made 25 steps", async () => /25 steps/.test(await it.text("#toast")) || it.text("#toast"));
  await wait(600);
  mark("stepped");
  await it.click("#pause");
  await until("the world resumes", async () => !/stands still/.test(await it.text("#world")) || it.text("#world"));
  await wait(500);
  mark("reset");
  await it.click("#reset");
  await until("the world is reset", async () => /is reset/.test(await it.text("#toast")) || it.text("#toast"));
  await wait(500);
  mark("was_reset");

  // The server itself refuses foreign origins and wrong tokens.
  const token = new URL(url).searchParams.get("token"), own = new URL(url).origin;
  assert.equal(await upgrade(own, token), 101, "the page itself is accepted");
  for (const [origin, key] of [["http://evil.example", token], ["", token], ["null", token], [own.replace("http:", "https:"), token],
    [own, ""], [own, token.replace(/.$/, (c) => (c === "0" ? "1" : "0"))], [own, token + "0"]])
    assert.equal(await upgrade(origin, key), 403, `Origin "${origin}", token "${key}" must be refused`);

  assert.deepEqual(it.errors, [], "the page has reported errors");

  // A browser that is frozen, and one that is killed.
  const before_MB = server_MB();
  mark("freeze");
  it.signal("SIGSTOP");
  await wait(3000);
  mark("frozen");
  const frozen_MB = server_MB();
  it.signal("SIGKILL");
  mark("killed");
  await wait(3000);
  const after_MB = server_MB();
  mark("over");
  // Queues are bounded by 4 MiB a page plus kernel buffers; memory that grows with time would exceed this by far.
  for (const [when, MB] of [["before", before_MB], ["frozen", frozen_MB], ["after", after_MB]]) console.log(`server ${when}: ${MB.toFixed(1)} MB`);
  assert.ok(Math.max(frozen_MB, after_MB) < before_MB + 16, "the memory of the server grows with a page that does not read");

  // The next page is served like the first.
  const again = await Browser.open(url);
  await until("a new browser is served", async () => /^connected/.test(await again.text("#link")) && (await again.pictures()) > 0);
  await again.close();
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
  try { it.signal("SIGKILL"); } catch { /* gone */ }
}
