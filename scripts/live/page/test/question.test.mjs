// Tests of answers to a question by keys, clicks and gamepad, without a browser.
//
//   node question.test.mjs
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

const page = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
if (!fs.existsSync(path.join(page, "node_modules/esbuild"))) {
  console.error("the packages of the page are missing; run scripts/live/bundle");
  process.exit(1);
}
const { buildSync } = await import("esbuild");
const { outputFiles } = buildSync({ entryPoints: [path.join(page, "src/question.ts")], bundle: true, format: "esm", write: false });
const { QuestionState, Mark, Pad, pressOfKey } = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);

const asked = (more) => ({ question: "5.11", kind: "choice", text: "Which was first?", choices: ["sound", "flash"], lowest: 0, highest: 0, step: 0,
  trial: 1, condition: "", progress: "", answered: false, leader: "conductor", ...more });
const number = (more) => asked({ kind: "number", choices: [], lowest: -1, highest: 1, step: 0.1, ...more });
function seen(study, at_ms = 1000) {
  const state = new QuestionState();
  assert.ok(state.update(study));
  state.seen(study.question, at_ms);
  return state;
}
const key = (state, name, at_ms = 1350) => state.press(pressOfKey(name), at_ms);
const tests = {
  "a digit chooses, and the answer carries the reaction time"() {
    const state = seen(asked());
    assert.deepEqual(key(state, "3"), { used: false });
    assert.deepEqual(key(state, "Enter"), { used: false });
    assert.deepEqual(key(state, "2").answer, { t: "answer", question: "5.11", choice: 1, number: 0, after_ns: 350e6 });
  },
  "a question is answered once, and only after its display"() {
    const state = new QuestionState();
    state.update(asked());
    assert.equal(key(state, "1").answer, undefined);
    state.seen("5.10", 1100);  // another one
    assert.equal(state.acceptsAnswer(1200), false);
    state.seen("5.11", 1200);
    assert.equal(key(state, "1", 1190).answer.after_ns, 0);
    assert.equal(key(state, "2", 1300).answer, undefined);
    state.update(asked({ answered: true }));
    assert.equal(state.current, undefined);
    assert.equal(key(state, "2", 5000).answer, undefined);
  },
  "an answer that the server has not accepted can be repeated"() {
    const state = seen(asked());
    key(state, "1", 1100);
    assert.equal(state.update(asked()), false);  // the same question is still open
    assert.equal(key(state, "2", 1100 + QuestionState.ANSWER_TIMEOUT_MS - 1).answer, undefined);
    assert.equal(key(state, "2", 1100 + QuestionState.ANSWER_TIMEOUT_MS).answer.choice, 1);
  },
  "only Enter and space confirm a text"() {
    for (const name of ["Enter", " "]) assert.equal(key(seen(asked({ kind: "read", choices: [] })), name).answer.choice, -1);
    assert.equal(key(seen(asked({ kind: "read", choices: [] })), "1").used, false);
  },
  "a number starts in the middle, and arrows move it by a step or a tenth up to its ends"() {
    const state = seen(number());
    assert.equal(state.mark.text(), "0.0");
    key(state, "ArrowRight");
    key(state, "ArrowUp");
    assert.equal(state.mark.text(), "0.3");
    for (let i = 0; i < 40; ++i) key(state, "ArrowDown");
    assert.equal(state.mark.number, -1);
    assert.equal(key(state, " ").answer, undefined);
    assert.deepEqual(key(state, "Enter").answer, { t: "answer", question: "5.11", choice: -1, number: -1, after_ns: 350e6 });
    assert.ok(state.update(number({ question: "5.12" })));
    assert.equal(state.mark.text(), "0.0");
  },
  "the mark reaches both ends of any range and stays within them"() {
    for (const [low, high, step] of [[0, 10, 1], [0, 10, 3], [1, 7, 6], [-1e9, 1e9, 1e-300], [0, 1e-9, 1e-9], [20.5, 36, 0.25]]) {
      const mark = new Mark(low, high, step);
      assert.ok(mark.steps >= 1 && mark.steps <= Mark.MAX_STEPS);
      mark.place = 1e12;
      assert.ok(mark.number <= high && high - mark.number < 1e-9 * Math.max(1, Math.abs(high)), `${low} ${high} ${step}: ${mark.number}`);
      mark.place = -1;
      assert.equal(mark.number, low);
    }
    assert.equal(new Mark(0, 100, 1).text(), "50");
    assert.equal(new Mark(0, 1, 0.25).text(), "0.50");
  },
  "no question is open during a trial or without a trial runner"() {
    const state = seen(asked());
    assert.ok(state.update(asked({ kind: "nothing", question: "5.12" })));
    assert.equal(state.current, undefined);
    assert.ok(state.update(asked({ question: "5.13" })));
    assert.ok(state.update(null));
    assert.deepEqual(key(state, "1"), { used: false });
  },
  "each press of a gamepad button counts once, and a pushed stick is an arrow"() {
    const pad = new Pad(), buttons = (...down) => Array.from({ length: 17 }, (_, i) => down.includes(i)), rest = [0, 0, 0, 0];
    assert.deepEqual(pad.pressed(buttons(1), rest), []);  // held before the gamepad was found
    assert.deepEqual(pad.pressed(buttons(0, 1), rest), [{ choice: 0, confirms: true, continues: true }]);
    assert.deepEqual(pad.pressed(buttons(0), rest), []);
    assert.deepEqual(pad.pressed(buttons(0, 3), rest), [{ choice: 3 }]);
    assert.deepEqual(pad.pressed(buttons(14), rest), [{ fine: -1 }]);
    assert.deepEqual(pad.pressed(buttons(), [0, 0, 0.7, 0.2]), [{ fine: 1 }]);
    assert.deepEqual(pad.pressed(buttons(), [0, 0, 0.5, 0.2]), []);
    assert.deepEqual(pad.pressed(buttons(), [0, 0, 0.7, 0]), []);
    assert.deepEqual(pad.pressed(buttons(), [0, -0.9, 0, 0]), [{ coarse: 1 }]);
    assert.deepEqual(pad.pressed([], []), []);  // a gamepad without buttons
  },
  "keys without a meaning for the question are left to the browser"() {
    for (const name of ["0", "a", "F5", "Tab", "Escape", "10"]) assert.equal(pressOfKey(name), undefined);
  },
};
let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try { test(); console.log(`ok: ${name}`); }
  catch (error) { ++failed; console.error(`FAILED: ${name}\n${error.message}`); }
}
process.exitCode = failed ? 1 : 0;
