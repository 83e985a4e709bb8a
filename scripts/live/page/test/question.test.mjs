// What a participant's keys, clicks and gamepad do to a question, without a browser.
//
//   node question.test.mjs
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

const page = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
if (!fs.existsSync(path.join(page, "node_modules/esbuild"))) {
  console.error("what the page is made with is not there; run scripts/live/bundle");
  process.exit(1);
}
const { buildSync } = await import("esbuild");
const { outputFiles } = buildSync({ entryPoints: [path.join(page, "src/question.ts")], bundle: true, format: "esm", write: false });
const { Desk, Mark, Pad, pressOfKey } = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);

const asked = (more) => ({ question: "5.11", kind: "choice", text: "Which was first?", choices: ["sound", "flash"], lowest: 0, highest: 0, step: 0,
  trial: 1, condition: "", progress: "", answered: false, leader: "conductor", ...more });
const number = (more) => asked({ kind: "number", choices: [], lowest: -1, highest: 1, step: 0.1, ...more });
function seen(study, at_ms = 1000) {
  const desk = new Desk();
  assert.ok(desk.take(study));
  desk.seen(study.question, at_ms);
  return desk;
}
const key = (desk, name, at_ms = 1350) => desk.press(pressOfKey(name), at_ms);
const tests = {
  "a digit chooses, and the answer says after how long"() {
    const desk = seen(asked());
    assert.deepEqual(key(desk, "3"), { used: false });
    assert.deepEqual(key(desk, "Enter"), { used: false });
    assert.deepEqual(key(desk, "2").answer, { t: "answer", question: "5.11", choice: 1, number: 0, after_ns: 350e6 });
  },
  "nothing answers before the question is seen, nor twice"() {
    const desk = new Desk();
    desk.take(asked());
    assert.equal(key(desk, "1").answer, undefined);
    desk.seen("5.10", 1100);  // another one
    assert.equal(desk.waits(1200), false);
    desk.seen("5.11", 1200);
    assert.equal(key(desk, "1", 1190).answer.after_ns, 0);
    assert.equal(key(desk, "2", 1300).answer, undefined);
    desk.take(asked({ answered: true }));
    assert.equal(desk.on, undefined);
    assert.equal(key(desk, "2", 5000).answer, undefined);
  },
  "an answer that the server has not taken can be given again"() {
    const desk = seen(asked());
    key(desk, "1", 1100);
    assert.equal(desk.take(asked()), false);  // the same is asked still
    assert.equal(key(desk, "2", 1100 + Desk.LOST_MS - 1).answer, undefined);
    assert.equal(key(desk, "2", 1100 + Desk.LOST_MS).answer.choice, 1);
  },
  "what is to be read is read with Enter and space alone"() {
    for (const name of ["Enter", " "]) assert.equal(key(seen(asked({ kind: "read", choices: [] })), name).answer.choice, -1);
    assert.equal(key(seen(asked({ kind: "read", choices: [] })), "1").used, false);
  },
  "a number begins in the middle; arrows move it finely and by a tenth, as far as its ends"() {
    const desk = seen(number());
    assert.equal(desk.mark.text(), "0.0");
    key(desk, "ArrowRight");
    key(desk, "ArrowUp");
    assert.equal(desk.mark.text(), "0.3");
    for (let i = 0; i < 40; ++i) key(desk, "ArrowDown");
    assert.equal(desk.mark.number, -1);
    assert.equal(key(desk, " ").answer, undefined);
    assert.deepEqual(key(desk, "Enter").answer, { t: "answer", question: "5.11", choice: -1, number: -1, after_ns: 350e6 });
    assert.ok(desk.take(number({ question: "5.12" })));
    assert.equal(desk.mark.text(), "0.0");
  },
  "both ends of any range are reached, and nothing beyond them"() {
    for (const [low, high, step] of [[0, 10, 1], [0, 10, 3], [1, 7, 6], [-1e9, 1e9, 1e-300], [0, 1e-9, 1e-9], [20.5, 36, 0.25]]) {
      const mark = new Mark(low, high, step);
      assert.ok(mark.steps >= 1 && mark.steps <= Mark.MOST_STEPS);
      mark.place = 1e12;
      assert.ok(mark.number <= high && high - mark.number < 1e-9 * Math.max(1, Math.abs(high)), `${low} ${high} ${step}: ${mark.number}`);
      mark.place = -1;
      assert.equal(mark.number, low);
    }
    assert.equal(new Mark(0, 100, 1).text(), "50");
    assert.equal(new Mark(0, 1, 0.25).text(), "0.50");
  },
  "nothing is on when a trial is under way or nobody leads"() {
    const desk = seen(asked());
    assert.ok(desk.take(asked({ kind: "nothing", question: "5.12" })));
    assert.equal(desk.on, undefined);
    assert.ok(desk.take(asked({ question: "5.13" })));
    assert.ok(desk.take(null));
    assert.deepEqual(key(desk, "1"), { used: false });
  },
  "a gamepad's buttons count once each, and a stick that is pushed is an arrow"() {
    const pad = new Pad(), buttons = (...down) => Array.from({ length: 17 }, (_, i) => down.includes(i)), rest = [0, 0, 0, 0];
    assert.deepEqual(pad.pressed(buttons(1), rest), []);  // was held when it was found
    assert.deepEqual(pad.pressed(buttons(0, 1), rest), [{ choice: 0, confirms: true, goesOn: true }]);
    assert.deepEqual(pad.pressed(buttons(0), rest), []);
    assert.deepEqual(pad.pressed(buttons(0, 3), rest), [{ choice: 3 }]);
    assert.deepEqual(pad.pressed(buttons(14), rest), [{ fine: -1 }]);
    assert.deepEqual(pad.pressed(buttons(), [0, 0, 0.7, 0.2]), [{ fine: 1 }]);
    assert.deepEqual(pad.pressed(buttons(), [0, 0, 0.5, 0.2]), []);
    assert.deepEqual(pad.pressed(buttons(), [0, 0, 0.7, 0]), []);
    assert.deepEqual(pad.pressed(buttons(), [0, -0.9, 0, 0]), [{ coarse: 1 }]);
    assert.deepEqual(pad.pressed([], []), []);  // one of few buttons
  },
  "keys that mean nothing to a question are left to the browser"() {
    for (const name of ["0", "a", "F5", "Tab", "Escape", "10"]) assert.equal(pressOfKey(name), undefined);
  },
};
let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try { test(); console.log(`ok: ${name}`); }
  catch (error) { ++failed; console.error(`FAILED: ${name}\n${error.message}`); }
}
process.exitCode = failed ? 1 : 0;
