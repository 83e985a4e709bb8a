// The page of a log, in a browser: played, stopped and sought. What it showed at each place is written to SEEN, and held against the
// log itself by tests/cluster/live_test.cpp.
//
//   node log.test.mjs URL SEEN
import assert from "node:assert/strict";
import fs from "node:fs";
import { Browser, until, wait } from "./browser.mjs";

const [url, seenFile] = process.argv.slice(2);
const kVariable = "WORLD_STATE:clock.sim_ns";
const it = await Browser.open(url);
try {
  await until("the page is connected, and a picture came", async () => /^connected/.test(await it.text("#link")) && (await it.pictures()) > 0);
  assert.ok(await it.page.$eval("#logbar", (e) => !e.hidden), "a log has a bar to seek with");
  for (const control of ["#controls", "#degrade", "#handlabel"])
    assert.ok(await it.page.$eval(control, (e) => e.hidden), `${control} must not be there: a log cannot be changed`);
  const place = async () => (await it.text("#place")).match(/[\d.]+/g).map(Number); // s, of s
  const [, length_s] = await place();
  await it.add(kVariable);

  await until("it plays", async () => (await place())[0] > 0.5);
  await it.click("#play");
  await until("it stands", async () => (await it.text("#play")) === "Play");
  const [stands_s] = await place();
  await wait(500);
  assert.equal((await place())[0], stands_s, "it stands still");

  // Forward and back: the variable that is shown is the world's own time, which knows where it is.
  const seen = { length_s, places: [] };
  for (const share of [0.6, 0.3, 0.9]) {
    const to_s = Math.round(share * length_s * 100) / 100;
    await it.slide("#seek", to_s);
    await until(`it is at ${to_s} s`, async () => Math.abs((await place())[0] - to_s) < 0.06 || place());
    await wait(700);
    const value = /([\d.e+]+) ns/.exec(await it.value(kVariable));
    assert.ok(value, `the page shows no value at ${to_s} s: ${await it.value(kVariable)}`);
    seen.places.push({ to_s, sim_ns: Number(value[1]) });
    await until("what lay shortly before is there too", async () => (await it.drawn(kVariable)) > 20 || it.drawn(kVariable));
  }
  await it.slide("#seek", Math.round(30 * length_s) / 100);
  await until("marks of events are there again", async () => (await it.marks()).world > 0 || it.marks());

  await it.page.select("#speed", "16");
  await it.click("#play");
  await until("it comes to its end", async () => { const [at, all] = await place(); return all - at < 0.2 || [at, all]; });
  fs.writeFileSync(seenFile, JSON.stringify(seen));
  assert.deepEqual(it.errors, [], "the page has reported errors");
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
} finally {
  await it.close();
}
