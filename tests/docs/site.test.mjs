// Opens the built site from the disk in a browser: search, no request to a network, WCAG 2.2 AA by axe-core in both colour schemes.
//
//   node site.test.mjs SITE [FOLDER]     FOLDER: where screenshots go
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

const live = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../../scripts/live/page"), [site, folder] = process.argv.slice(2);
for (const needed of ["/usr/bin/chromium", path.join(live, "node_modules/puppeteer-core"), path.join(live, "node_modules/axe-core")])
  if (!fs.existsSync(needed)) { console.error(`${needed} is missing; run scripts/setup test and scripts/live/bundle --for-tests`); process.exit(77); }
const { Browser, until } = await import(path.join(live, "test/browser.mjs"));
const axe = fs.readFileSync(path.join(live, "node_modules/axe-core/axe.min.js"), "utf8");
const it = await Browser.open("about:blank"), foreign = [];
it.page.on("request", (r) => { if (!/^(file|data|about|blob):/.test(r.url())) foreign.push(r.url()); });
const at = (page) => it.page.goto(`file://${path.resolve(site, page)}`);
try {
  await at("index.html");
  // The key of the search has an effect as soon as the scripts of the page are ready.
  const inSearch = () => it.page.evaluate(() => document.activeElement?.matches(".md-search__input") ?? false);
  await until("the key s opens the search", async () => {
    if (await inSearch()) return true;
    await it.page.keyboard.press("s");
    return inSearch();
  });
  await it.page.$eval(".md-search__input", (input) => { input.value = ""; });
  await it.page.keyboard.type("deadband");
  await until("the search finds pages", () => it.page.$$eval(".md-search-result__item", (all) => all.length > 3));
  await it.page.keyboard.press("Escape");
  const found = [];
  // Of the rules, only those of colours depend on the scheme.
  const rules = { light: { type: "tag", values: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"] }, dark: { type: "rule", values: ["color-contrast", "link-in-text-block"] } };
  for (const [scheme, runOnly] of Object.entries(rules)) {
    await it.page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
    for (const page of ["index.html", "tutorials/materials.html", "tutorials/modality.html", "concepts/degradation.html", "reference/messages.html", "code/sync/degradation/index.html"]) {
      await at(page);
      await it.page.evaluate(() => localStorage.clear());
      await at(page);
      await it.page.evaluate(axe);
      const { violations } = await it.page.evaluate((only) => window.axe.run(document, { runOnly: only }), runOnly);
      for (const v of violations) found.push(`${page} (${scheme}): ${v.id}: ${v.nodes.slice(0, 2).map((n) => `${n.target.join(" ")}: ${n.any.concat(n.all, n.none).map((c) => c.message)[0]}`).join(" | ")}`);
      if (folder) await it.page.screenshot({ path: path.join(folder, `${page.replaceAll("/", "_")}_${scheme}.png`) });
    }
  }
  assert.deepEqual(found, [], "violations of WCAG 2.2 AA");
  assert.deepEqual(foreign, [], "requests to a network");
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
} finally {
  await it.close();
}
