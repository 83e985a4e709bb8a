// Operates the pages of a participant and of an observer in browsers. tests/cluster/live_question_test.cpp publishes the questions and
// compares the answers on the bus with the expected ones.
//
//   node study.test.mjs URL [FOLDER]     FOLDER: where screenshots go
import assert from "node:assert/strict";
import path from "node:path";
import { Browser, until, wait } from "./browser.mjs";

const [url, folder] = process.argv.slice(2);
const participant = await Browser.open(`${url}&participant`), observer = await Browser.open(url);
const asked = (it) => it.page.$eval("#study", (e) => (e.hidden ? "" : e.querySelector(".asked")?.innerText.trim() ?? ""));
const toast = (it) => it.page.$eval("#toast", (e) => (e.classList.contains("on") ? e.textContent : ""));
const is = (it, text) => until(`the page shows "${text}"`, async () => (await asked(it)) === text || asked(it));
const ready = () => until("the question can be answered", () => participant.page.$eval("#study", (e) => !e.classList.contains("sent")));
const keep = async (it, name) => { if (folder) await it.page.screenshot({ path: path.join(folder, name) }); };
// The server's reply to a message of another client that has the token.
function refusal(message) {
  return participant.page.evaluate((text) => new Promise((done) => {
    const socket = new WebSocket(`ws://${location.host}/ws?token=${new URLSearchParams(location.search).get("token")}`);
    socket.onopen = () => socket.send(text);
    socket.onmessage = (e) => {
      if (typeof e.data !== "string" || JSON.parse(e.data).t !== "reply") return;
      socket.close();
      done(JSON.parse(e.data).text);
    };
  }), JSON.stringify(message));
}

try {
  await participant.page.setViewport({ width: 1280, height: 720 });
  await participant.page.bringToFront();
  await is(participant, "You will see a ball fall and hear it.");
  for (const other of ["header h1", "#degrade", "#middle", "#right", "#rasterpanel"])
    assert.equal(await participant.page.$eval(other, (e) => getComputedStyle(e).display === "none" || getComputedStyle(e).visibility === "hidden"), true, `a participant must not see ${other}`);
  assert.ok(!(await participant.text("body")).includes("audio +80 ms"), "a participant must not see the condition");

  // Malformed answers and answers to another question are refused with a reason, and not published.
  const answer = { t: "answer", question: "1.2", choice: -1, number: 0, after_ns: 5 };
  for (const [message, reason] of [[answer, /no longer open/], [{ ...answer, choice: 0.5 }, /not a whole number/], [{ ...answer, after_ns: -1 }, /out of range/],
    [{ ...answer, number: "1" }, /no number/], [{ ...answer, question: 7 }, /not text/], [{ t: "answer" }, /names no question/]])
    assert.match(await refusal(message), reason);

  await ready();
  await keep(participant, "read.png");
  await participant.page.keyboard.press("1");  // no answer to a text
  await wait(300);
  await is(participant, "You will see a ball fall and hear it.");
  await participant.page.keyboard.press("Enter");

  // The observer's page shows the question, the condition and the progress, and has no answer controls.
  await is(participant, "Was it at the same time?");
  await observer.page.bringToFront();
  await is(observer, "Was it at the same time?");
  for (const shown of ["block 1 of 4", "trial 2", "audio +80 ms", "2 not at the same time", "waits for the participant"])
    assert.ok((await observer.text("#study")).includes(shown), `the observer's page must show "${shown}": ${await observer.text("#study")}`);
  assert.equal(await observer.page.$$eval("#study :is(button, input)", (all) => all.length), 0);
  await keep(observer, "observer.png");
  await observer.page.keyboard.press("1");
  await wait(500);
  await participant.page.bringToFront();
  await is(participant, "Was it at the same time?");
  await ready();
  await keep(participant, "choice.png");
  await (await participant.page.$$("#study button.answer"))[1].click();

  await is(participant, "Which was first?");
  await ready();
  await participant.page.keyboard.press("3");
  await until("the question disappears after its answer", async () => (await asked(participant)) === "");

  await is(participant, "How hard was it?");
  await ready();
  assert.equal(await participant.text("#study .marked"), "50", "the mark starts in the middle");
  await participant.slide("#mark", 64);
  assert.equal(await participant.text("#study .marked"), "64");
  assert.deepEqual(await participant.page.$$eval("#study .ends span", (all) => all.map((e) => e.innerText)), ["very soft", "very hard"]);
  await keep(participant, "number.png");
  await (await participant.page.$("#study button.answer")).click();

  // The same by keys: from the middle, 0, by a tenth of forty steps and by one less.
  await is(participant, "How warm was it?");
  await ready();
  await participant.page.keyboard.press("ArrowUp");
  await participant.page.keyboard.press("ArrowLeft");
  assert.equal(await participant.text("#study .marked"), "0.15");
  await participant.page.keyboard.press("Enter");
  await until("no question is shown during a trial", async () => (await asked(participant)) === "");
  await observer.page.bringToFront();
  await is(observer, "no question: a trial is in progress");
  assert.equal(await toast(participant), "");
  assert.deepEqual([...participant.errors, ...observer.errors], [], "the pages have reported errors");
  await wait(1500);  // no further answer is sent
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
} finally {
  await participant.close();
  await observer.close();
}
