// Plays, pauses and seeks the page of a log in a browser. Writes the shown values of each position to SEEN, which
// tests/cluster/live_test.cpp compares with the log.
//
//   node log.test.mjs URL SEEN
import assert from "node:assert/strict";
import fs from "node:fs";
import { Browser, until, wait } from "./browser.mjs";

const [url, seenFile] = process.argv.slice(2);
const kVariable = "WORLD_STATE:clock.sim_ns";
const it = await Browser.open(url);
try {
  await until("the page is connected and shows a picture", async () => /^connected/.test(await it.text("#link")) && (await it.pictures()) > 0);
  assert.ok(await it.page.$eval("#logbar", (e) => !e.hidden), "the page of a log has a seek bar");
  for (const control of ["#controls", "#degrade", "#handlabel"])
    assert.ok(await it.page.$eval(control, (e) => e.hidden), `${control} must be hidden: a log cannot be changed`);
  const place = async () => (await it.text("#place")).match(/[\d.]+/g).map(Number); // s, of s
  const [, length_s] = await place();
  await it.add(kVariable);

  await until("the log plays", async () => (await place())[0] > 0.5);
  await it.click("#play");
  await until("the log is paused", async () => (await it.text("#play")) === "Play");
  const [paused_s] = await place();
  await wait(500);
  assert.equal((await place())[0], paused_s, "a paused log keeps its position");

  // Forward and back: the shown variable is the simulated time, which identifies the position.
  const seen = { length_s, places: [] };
  for (const share of [0.6, 0.3, 0.9]) {
    const to_s = Math.round(share * length_s * 100) / 100;
    await it.slide("#seek", to_s);
    await until(`the position is ${to_s} s`, async () => Math.abs((await place())[0] - to_s) < 0.06 || place());
    await wait(700);
    const value = /([\d.e+]+) ns/.exec(await it.value(kVariable));
    assert.ok(value, `the page shows no value at ${to_s} s: ${await it.value(kVariable)}`);
    seen.places.push({ to_s, sim_ns: Number(value[1]) });
    await until("the graph also has the values before the position", async () => (await it.drawn(kVariable)) > 20 || it.drawn(kVariable));
  }
  // The raster shows ten seconds. How long the run took, and so where its events are, depends on the machine.
  let marks = {};
  for (let to_s = 5; to_s < length_s && !(marks.world > 0); to_s += 5) {
    await it.slide("#seek", to_s);
    await wait(700);
    marks = await it.marks();
  }
  assert.ok(marks.world > 0, `the event raster has no marks at any position: ${JSON.stringify(marks)}`);

  await it.page.select("#speed", "16");
  await it.click("#play");
  await until("the log reaches its end", async () => { const [at, all] = await place(); return all - at < 0.2 || [at, all]; });
  fs.writeFileSync(seenFile, JSON.stringify(seen));
  assert.deepEqual(it.errors, [], "the page has reported errors");
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
} finally {
  await it.close();
}
