// The live page: shows a cluster or a log, and offers its controls.
import "uplot/dist/uPlot.min.css";
import "./page.css";
import { Connection } from "./connection";
import { Common, Frame, Hello, ServerMessage, element } from "./messages";
import { Display } from "./display";
import { Picture } from "./picture";
import { Raster } from "./raster";
import { ModalityTables } from "./modalities";
import { Sliders } from "./sliders";
import { StudyPanel } from "./study";
import { Variables } from "./variables";

let live = true, paused = false, playing = true, now_s = 0, at_ms = 0, profile = "0", seeking = false, restored = false;
const send = (m: object): void => connection.send(m);
const variables = new Variables((names) => send({ t: "watch", names }));
const tables = new ModalityTables(), raster = new Raster();
const picture = new Picture(send);
const study = new StudyPanel(send);
const sliders = new Sliders((senses, clear) => send({ t: "degrade", senses, clear }));

new Display(() => { variables.rebuild(); sliders.build(); });

let toastTimer = 0;
function toast(text: string, good: boolean): void {
  const box = element("toast");
  box.textContent = good ? text : `\u26a0 ${text}`;  // a sign, not only a colour
  box.className = good ? "on" : "on bad";
  clearTimeout(toastTimer);
  toastTimer = window.setTimeout(() => { box.className = ""; }, 4000);
}
function common(m: Common): void {
  now_s = m.now;
  at_ms = performance.now();
  if (m.tags) variables.catalog(undefined, m.tags);
  if (m.health) { variables.senders(m.health); tables.updateHealth(m.health, profile); if (live) sliders.modalities(tables.modalities()); }
  if (m.report) tables.updateReport(m.report);
}
function hello(m: Hello): void {
  live = m.live;
  document.body.dataset.live = String(live);
  element("title").textContent = m.title;
  element("logbar").hidden = live;
  element("controls").hidden = !live;
  element("degrade").hidden = !live;
  element("handlabel").hidden = !live;
  tables.thresholds = m.thresholds;
  variables.catalog(m.catalog, m.tags);
  common(m);
  if (restored) variables.resend();
  else variables.restore();
  restored = true;
}
function frame(m: Frame): void {
  if (m.wound) { variables.clear(); tables.clear(); raster.clear(); }
  if (m.profile) profile = m.profile;
  common(m);
  if (m.degradation) sliders.inForce(m.degradation);
  if (m.values) variables.addValues(m.values);
  raster.addEvents(m.events, m.presented);
  if (m.presented) tables.presented(m.presented);
  if (m.study !== undefined) study.update(m.study);
  if (m.scene) element("title").textContent = m.scene.name;
  if (m.world?.known) {
    paused = m.world.rate === 0;
    element("world").textContent = `${m.world.sim_s.toFixed(1)} s ${paused ? "stands still" : ""}`;
    element("pause").textContent = paused ? "Resume" : "Pause";
  }
  if (m.pages) element("link").textContent = `connected${m.pages.dropped ? `, ${m.pages.dropped} dropped` : ""}`;
  if (m.log) {
    playing = m.log.playing;
    const seek = element<HTMLInputElement>("seek");
    seek.max = String(Math.max(0.01, m.log.length_s));
    if (!seeking) seek.value = String(m.log.position_s);
    element("place").textContent = `${m.log.position_s.toFixed(1)} / ${m.log.length_s.toFixed(1)} s${m.log.damaged ? `, ${m.log.damaged} damaged regions` : ""}`;
    element("place").title = m.log.warnings.join("\n");
    if (m.log.warnings.length > 0) element("place").textContent += ` (${m.log.warnings.join("; ")})`;
    element("play").textContent = playing ? "Pause" : "Play";
  }
}
const connection = new Connection((m: ServerMessage) => {
  if (m.t === "hello") hello(m);
  else if (m.t === "frame") frame(m);
  else toast(m.text, m.good);
}, (jpeg) => picture.show(jpeg), (open) => {
  element("link").textContent = open ? "connected" : "not connected";
  element("link").className = open ? "good" : "bad";
  if (!open) study.update(null);
});

element("pause").addEventListener("click", () => send({ t: "command", what: paused ? "resume" : "pause" }));
element("reset").addEventListener("click", () => send({ t: "command", what: "reset" }));
element("step").addEventListener("click", () => send({ t: "command", what: "step", steps: Math.max(1, Math.min(10000, Math.round(Number(element<HTMLInputElement>("steps").value)) || 1)) }));
const speed = (): number => Number(element<HTMLSelectElement>("speed").value);
element("play").addEventListener("click", () => send({ t: "play", play: !playing, rate: speed() }));
element("speed").addEventListener("change", () => send({ t: "play", play: playing, rate: speed() }));
const seek = element<HTMLInputElement>("seek");
seek.addEventListener("input", () => { seeking = true; });
seek.addEventListener("change", () => { seeking = false; send({ t: "seek", to_s: Number(seek.value) }); });

// Extrapolates the time between two frames, so that curves move smoothly; not for a paused world or a log.
function draw(): void {
  const ahead = live ? Math.min(0.2, (performance.now() - at_ms) / 1000) : 0;
  variables.draw(now_s + ahead);
  raster.draw(now_s + ahead, tables.modalities());
}
setInterval(draw, 50);
setInterval(() => tables.draw(now_s), 250);
