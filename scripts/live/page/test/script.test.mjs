// Tests of texts in any language on the page, without a browser.
//
//   node script.test.mjs
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
const { outputFiles } = buildSync({ entryPoints: [path.join(page, "src/script.ts")], bundle: true, format: "esm", write: false });
const { directionOf, uncovered, nameOf } = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);

const tests = {
  "the first letter sets the direction of a text"() {
    for (const text of ["Did they come together?", "Пришли вместе?", "क्या दोनों साथ आए?", "同时到来吗？", "Ήρθαν μαζί;"]) assert.equal(directionOf(text), "ltr");
    for (const text of ["هل جاءا معا؟", "האם באו יחד?", "12 של", "(1) نعم, OK"]) assert.equal(directionOf(text), "rtl");
    for (const text of ["", "1 + 1"]) assert.equal(directionOf(text), "ltr");
  },
  "a character with the drawing of a missing one is named"() {
    const glyph = (c) => (/[a-z\u0400-\u04ff]/.test(c) ? c : "box");
    assert.deepEqual(uncovered(["да, नमस्ते", "ok"], glyph), ["न", "म", "स", "त"]);
    assert.deepEqual(uncovered(["да", "ok"], glyph), []);
    assert.deepEqual(uncovered(["\u200d\u0301\u00a0"], glyph), []);  // joiner, mark and blank have no drawing of their own
    assert.equal(nameOf("न"), "न (U+0928)");
  },
};

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    test();
    console.log(`ok: ${name}`);
  } catch (error) {
    ++failed;
    console.error(`failed: ${name}\n${error.stack}`);
  }
}
process.exit(failed ? 1 : 0);
