// Cards of variables: a graph over time, a bar or text, as one chooses.
import uPlot from "uplot";
import { Named, element, figure, make } from "./messages";

const SPAN_S = 20;
const MOST = 24;
type Kind = "graph" | "bar" | "text";
interface Card { name: string; kind: Kind; box: HTMLElement; body: HTMLElement; value: HTMLElement; times: number[]; values: number[]; least: number; most: number; plot?: uPlot }

export class Variables {
  private cards: Card[] = [];
  private units = new Map<string, string>();
  private known: Named[] = [];
  private tags: Named[] = [];
  constructor(private watch: (names: string[]) => void) {
    const choose = element<HTMLInputElement>("choose");
    choose.addEventListener("change", () => {
      const name = choose.value.trim();
      if (name) { this.add(name, "graph"); choose.value = ""; }
    });
    window.addEventListener("resize", () => this.cards.forEach((c) => this.build(c)));
  }
  catalog(known?: Named[], tags?: Named[]): void {
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
  restore(): void {
    let kept: [string, Kind][] = [["TOOL_STATE:force_N.z", "graph"], ["TOOL_STATE:proxy.position_m.z", "graph"], ["THERMAL_STATE:skin_degC", "text"]];
    try {
      const text = localStorage.getItem("tactus-live-variables");
      if (text) kept = JSON.parse(text) as [string, Kind][];
    } catch { /* a damaged store: as if there were none */ }
    for (const [name, kind] of kept) this.add(name, kind, false);
    this.changed();
  }
  names(): string[] { return this.cards.map((c) => c.name); }
  resend(): void { this.watch(this.names()); }
  private changed(): void {
    this.watch(this.names());
    try { localStorage.setItem("tactus-live-variables", JSON.stringify(this.cards.map((c) => [c.name, c.kind]))); } catch { /* not allowed: not kept */ }
  }
  add(name: string, kind: Kind, tell = true): void {
    if (this.cards.length >= MOST || this.cards.some((c) => c.name === name)) return;
    const box = make("div", "card");
    box.dataset.name = name;
    const head = make("div", "head"), value = make("span", "value"), body = make("div", "body");
    const select = document.createElement("select");
    for (const k of ["graph", "bar", "text"]) select.append(new Option(k, k, false, k === kind));
    const remove = make("button", "", "×");
    remove.title = "take away";
    head.append(make("span", "name", name), value, select, remove);
    head.firstElementChild!.setAttribute("title", name);
    box.append(head, body);
    const card: Card = { name, kind, box, body, value, times: [], values: [], least: Infinity, most: -Infinity };
    select.addEventListener("change", () => { card.kind = select.value as Kind; this.build(card); this.changed(); });
    remove.addEventListener("click", () => { card.plot?.destroy(); box.remove(); this.cards = this.cards.filter((c) => c !== card); this.changed(); });
    element("cards").append(box);
    this.cards.push(card);
    this.build(card);
    if (tell) this.changed();
  }
  private build(card: Card): void {
    card.plot?.destroy();
    card.plot = undefined;
    card.body.replaceChildren();
    if (card.kind === "graph") {
      const quiet = { stroke: "#8b95a3", grid: { stroke: "#2b313b", width: 1 }, ticks: { show: false }, font: "10px DejaVu Sans, sans-serif" };
      card.plot = new uPlot({
        width: Math.max(200, card.box.clientWidth - 18), height: 96, cursor: { show: false }, legend: { show: false },
        scales: { x: { time: false } },
        axes: [{ ...quiet, size: 22, values: (_u: uPlot, ticks: number[]) => ticks.map((t) => `${t.toFixed(0)} s`) }, { ...quiet, size: 62, space: 24, values: (_u: uPlot, ticks: number[]) => ticks.map((v) => Math.abs(v) >= 1e5 || (v !== 0 && Math.abs(v) < 1e-3) ? v.toExponential(1) : String(+v.toPrecision(6))) }],
        series: [{}, { stroke: "#7aa7e0", width: 1.5, points: { show: false } }],
      }, [[], []], card.body);
    } else if (card.kind === "bar") {
      const bar = make("div", "bar");
      bar.append(make("i"), make("em"));
      card.body.append(bar, make("div", "ends"));
      card.body.lastElementChild!.append(make("span"), make("span"));
    } else card.body.append(make("div", "big value"));
  }
  clear(): void { for (const c of this.cards) { c.times = []; c.values = []; c.least = Infinity; c.most = -Infinity; } }
  take(values: [number, number, number][]): void {
    for (const [i, t, v] of values) {
      const c = this.cards[i];
      if (!c) continue;
      c.times.push(t); c.values.push(v);
      c.least = Math.min(c.least, v); c.most = Math.max(c.most, v);
    }
  }
  draw(now: number): void {
    for (const c of this.cards) {
      const first = c.times.findIndex((t) => t >= now - SPAN_S);
      if (first > 200 || (first < 0 && c.times.length > 1)) { const n = first < 0 ? c.times.length - 1 : first; c.times.splice(0, n); c.values.splice(0, n); }
      const unit = this.units.get(c.name) ?? "", last = c.values[c.values.length - 1];
      const text = last === undefined ? "–" : `${figure(last)}${unit && unit !== "1" ? " " + unit : ""}`;
      c.value.textContent = c.kind === "text" ? "" : text;
      if (c.kind === "text") c.body.firstElementChild!.textContent = text;
      else if (c.plot) {
        c.plot.batch(() => {
          c.plot!.setData([c.times.map((t) => t - now), c.values], false);
          c.plot!.setScale("x", { min: -SPAN_S, max: 0 });
          let lo = Infinity, hi = -Infinity;
          for (let i = Math.max(0, c.times.findIndex((t) => t >= now - SPAN_S)); i < c.values.length; ++i) { lo = Math.min(lo, c.values[i]!); hi = Math.max(hi, c.values[i]!); }
          if (hi >= lo) { const room = (hi - lo) * 0.08 || Math.abs(hi) * 0.05 || 1e-3; c.plot!.setScale("y", { min: lo - room, max: hi + room }); }
        });
      } else if (last !== undefined) {
        const lo = Math.min(0, c.least), hi = Math.max(0, c.most), span = hi - lo || 1;
        const at = (x: number) => `${(100 * (x - lo)) / span}%`;
        const bar = c.body.firstElementChild!.firstElementChild as HTMLElement, zero = c.body.firstElementChild!.lastElementChild as HTMLElement;
        bar.style.left = at(Math.min(0, last)); bar.style.width = `${(100 * Math.abs(last)) / span}%`; zero.style.left = at(0);
        const ends = c.body.lastElementChild!;
        ends.firstElementChild!.textContent = figure(lo); ends.lastElementChild!.textContent = figure(hi);
      }
    }
  }
}
