// Cards of variables: a graph over time, a bar or text, as selected by the user.
import uPlot from "uplot";
import { VariableInfo, NodeHealth, Value, element, figure, make } from "./messages";
import { MAX_CURVES, css, curve, sample, textScale } from "./palette";

const SPAN_S = 20;
const MAX_CARDS = 24;
type Kind = "graph" | "bar" | "text";
// The values of a variable from one sender: two hands both send TOOL_STATE.
interface Series { source: number; times: number[]; values: number[] }
interface Card { name: string; kind: Kind; box: HTMLElement; body: HTMLElement; value: HTMLElement; series: Series[]; min: number; max: number; plot?: uPlot }

export class Variables {
  private cards: Card[] = [];
  private units = new Map<string, string>();
  private nodes = new Map<number, string>();
  private known: VariableInfo[] = [];
  private tags: VariableInfo[] = [];
  constructor(private watch: (names: string[]) => void) {
    const choose = element<HTMLInputElement>("choose");
    choose.addEventListener("change", () => {
      const name = choose.value.trim();
      if (name) { this.add(name, "graph"); choose.value = ""; }
    });
    window.addEventListener("resize", () => this.rebuild());
  }
  rebuild(): void { this.cards.forEach((c) => this.build(c)); }
  catalog(known?: VariableInfo[], tags?: VariableInfo[]): void {
    if (known) this.known = known;
    if (tags) this.tags = tags;
    const list = element("names");
    list.replaceChildren(...[...this.tags, ...this.known].map((n) => {
      this.units.set(n.name, n.unit);
      const option = document.createElement("option");
      option.value = n.name;
      option.label = `${n.unit ? n.unit + " — " : ""}${n.about}`.slice(0, 90);
      return option;
    }));
  }
  senders(health: NodeHealth[]): void { for (const h of health) this.nodes.set(h.source, h.node); }
  restore(): void {
    let saved: [string, Kind][] = [["TOOL_STATE:force_N.z", "graph"], ["TOOL_STATE:proxy.position_m.z", "graph"], ["THERMAL_STATE:skin_degC", "text"]];
    try {
      const text = localStorage.getItem("tactus-live-variables");
      if (text) saved = JSON.parse(text) as [string, Kind][];
    } catch { /* a damaged store: as if there were none */ }
    for (const [name, kind] of saved) this.add(name, kind, false);
    this.changed();
  }
  names(): string[] { return this.cards.map((c) => c.name); }
  resend(): void { this.watch(this.names()); }
  private changed(): void {
    this.watch(this.names());
    try { localStorage.setItem("tactus-live-variables", JSON.stringify(this.cards.map((c) => [c.name, c.kind]))); } catch { /* not allowed: not saved */ }
  }
  add(name: string, kind: Kind, save = true): void {
    if (this.cards.length >= MAX_CARDS || this.cards.some((c) => c.name === name)) return;
    const box = make("div", "card");
    box.dataset.name = name;
    const head = make("div", "head"), value = make("span", "value"), body = make("div", "body");
    const select = document.createElement("select");
    for (const k of ["graph", "bar", "text"]) select.append(new Option(k, k, false, k === kind));
    const remove = make("button", "", "×");
    remove.title = "remove";
    remove.setAttribute("aria-label", `remove ${name}`);
    select.setAttribute("aria-label", `form of ${name}`);
    body.setAttribute("role", "img");
    head.append(make("span", "name", name), value, select, remove);
    head.firstElementChild!.setAttribute("title", name);
    box.append(head, body);
    const card: Card = { name, kind, box, body, value, series: [], min: Infinity, max: -Infinity };
    select.addEventListener("change", () => { card.kind = select.value as Kind; this.build(card); this.changed(); });
    remove.addEventListener("click", () => { card.plot?.destroy(); box.remove(); this.cards = this.cards.filter((c) => c !== card); this.changed(); });
    element("cards").append(box);
    this.cards.push(card);
    this.build(card);
    if (save) this.changed();
  }
  private build(card: Card): void {
    card.plot?.destroy();
    card.plot = undefined;
    card.body.replaceChildren();
    if (card.kind === "graph") {
      const scale = textScale(), quiet = { stroke: css("quiet"), grid: { stroke: css("line"), width: 1 }, ticks: { show: false }, font: `${10 * scale}px DejaVu Sans, sans-serif` };
      card.plot = new uPlot({
        width: Math.max(200, card.box.clientWidth - 18), height: 96 * scale, cursor: { show: false }, legend: { show: false },
        scales: { x: { time: false } },
        axes: [{ ...quiet, size: 22 * scale, splits: () => [-20, -15, -10, -5, 0], values: (_u: uPlot, ticks: number[]) => ticks.map((t) => `${t.toFixed(0)} s`) }, { ...quiet, size: 62 * scale, space: 24 * scale, values: (_u: uPlot, ticks: number[]) => ticks.map((v) => Math.abs(v) >= 1e5 || (v !== 0 && Math.abs(v) < 1e-3) ? v.toExponential(1) : String(+v.toPrecision(6))) }],
        series: [{}, ...card.series.map((_, k) => ({ stroke: curve(k).colour, dash: curve(k).dash, width: 1.5 * scale, spanGaps: true, points: { show: false } }))],
      }, [[], ...card.series.map(() => [])], card.body);
    } else if (card.kind === "bar") {
      const bar = make("div", "bar");
      bar.append(make("i"), make("em"));
      card.body.append(bar, make("div", "ends"));
      card.body.lastElementChild!.append(make("span"), make("span"));
    } else card.body.append(make("div", "big value"));
  }
  clear(): void { for (const c of this.cards) { for (const s of c.series) { s.times = []; s.values = []; } c.min = Infinity; c.max = -Infinity; } }
  addValues(values: Value[]): void {
    for (const [i, t, v, source] of values) {
      const c = this.cards[i];
      if (!c) continue;
      let s = c.series.find((of) => of.source === source);
      if (!s) {
        if (c.series.length >= MAX_CURVES) continue;
        c.series.push((s = { source, times: [], values: [] }));
        this.build(c);
      }
      s.times.push(t); s.values.push(v);
      c.min = Math.min(c.min, v); c.max = Math.max(c.max, v);
    }
  }
  draw(now: number): void {
    for (const c of this.cards) {
      for (const s of c.series) {
        const first = s.times.findIndex((t) => t >= now - SPAN_S);
        if (first > 200 || (first < 0 && s.times.length > 1)) { const n = first < 0 ? s.times.length - 1 : first; s.times.splice(0, n); s.values.splice(0, n); }
      }
      const unit = (this.units.get(c.name) ?? "").replace("degC", "°C"), lasts = c.series.map((s) => s.values[s.values.length - 1]).filter((v) => v !== undefined);
      c.box.dataset.values = String(c.series.reduce((n, s) => n + s.values.length, 0));
      c.box.dataset.series = String(c.series.length);
      this.show(c, lasts, unit && unit !== "1" ? " " + unit : "");
      if (c.plot) this.plot(c, now);
      else if (c.kind === "bar" && lasts.length) this.bar(c, lasts[0]!);
    }
  }
  // The newest values as text; with the line of its curve and the name of its process when several send it.
  private show(c: Card, lasts: number[], unit: string): void {
    const box = (c.kind === "text" ? c.body.firstElementChild : c.value) as HTMLElement;
    if (c.kind === "text") c.value.textContent = "";
    c.body.setAttribute("aria-label", `${c.name}: ${lasts.map((v) => figure(v)).join(", ") || "no value yet"}${unit}`);
    if (lasts.length < 2) { box.textContent = lasts.length ? figure(lasts[0]!) + unit : "–"; box.title = ""; return; }
    box.replaceChildren(...lasts.map((v, k) => {
      const span = make("span", "one"), node = this.nodes.get(c.series[k]!.source);
      span.append(sample(k), make("span", "quiet", node ?? "no health"), ` ${figure(v)}${k === lasts.length - 1 ? unit : ""}`);
      span.title = node ?? "a sender without health messages";
      return span;
    }));
  }
  private plot(c: Card, now: number): void {
    let lo = Infinity, hi = -Infinity;
    for (const s of c.series)
      for (let i = s.times.length; i-- > 0 && s.times[i]! >= now - SPAN_S;) { lo = Math.min(lo, s.values[i]!); hi = Math.max(hi, s.values[i]!); }
    c.plot!.batch(() => {
      const own: uPlot.AlignedData[] = c.series.map((s) => [s.times.map((t) => t - now), s.values]);
      c.plot!.setData(own.length > 1 ? uPlot.join(own) : own[0] ?? [[]], false);
      c.plot!.setScale("x", { min: -SPAN_S, max: 0 });
      if (hi >= lo) { const room = (hi - lo) * 0.08 || Math.abs(hi) * 0.05 || 1e-3; c.plot!.setScale("y", { min: lo - room, max: hi + room }); }
    });
  }
  private bar(c: Card, last: number): void {
    const lo = Math.min(0, c.min), hi = Math.max(0, c.max), span = hi - lo || 1;
    const at = (x: number) => `${(100 * (x - lo)) / span}%`;
    const bar = c.body.firstElementChild!.firstElementChild as HTMLElement, zero = c.body.firstElementChild!.lastElementChild as HTMLElement;
    bar.style.left = at(Math.min(0, last)); bar.style.width = `${(100 * Math.abs(last)) / span}%`; zero.style.left = at(0);
    const ends = c.body.lastElementChild!;
    ends.firstElementChild!.textContent = figure(lo); ends.lastElementChild!.textContent = figure(hi);
  }
}
