// Rate, latency and asynchrony of the modalities, with the published thresholds; and their nodes.
import { NodeHealth, Pair, Presentation, ModalityReport, Threshold, element, make } from "./messages";
import { colourOf, css, swatch } from "./palette";

const STATES = ["waiting", "running", "stale", "input lost", "output lost", "ready"];
const SPAN_MS = 250;  // of the scale of asynchrony, to both sides
const MEMORY_S = 30;

function row(cells: [string, string][], heading = false): HTMLElement {
  const tr = document.createElement("tr");
  for (const [text, className] of cells) tr.append(make(heading ? "th" : "td", className, text));
  if (heading) for (const cell of tr.children) cell.setAttribute("scope", "col");
  return tr;
}
const quantile = (sorted: number[], q: number): number => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))]!;

export class ModalityTables {
  private latencies = new Map<string, [number, number][]>();
  private health: NodeHealth[] = [];
  private reports: ModalityReport[] = [];
  private pairs = new Map<string, HTMLElement>();
  thresholds: Threshold[] = [];
  presented(list: Presentation[]): void {
    for (const [t, modality, part, , latency] of list) {
      if (latency === null || part === 1) continue;  // touch: of the hit transient; its constraint force is never scheduled
      const of = this.latencies.get(modality) ?? [];
      of.push([t, latency]);
      if (of.length > 2000) of.shift();
      this.latencies.set(modality, of);
    }
  }
  clear(): void { this.latencies.clear(); }
  modalities(): string[] { return [...new Set(this.health.map((h) => h.modality).filter((m) => m))].sort(); }
  updateHealth(health: NodeHealth[], wanted: string): void {
    this.health = health;
    const table = element("nodes");
    table.replaceChildren(row([["node", ""], ["state", ""], ["missed", ""], ["gaps", ""], ["tick max", ""], ["profile", ""]], true), ...health.map((h) => {
      const state = h.lost ? "LOST" : STATES[h.state] ?? "?";
      const tr = row([[h.node, "name"], [state, state === "running" ? "good" : "bad"], [String(h.missed), "n"], [String(h.gaps), "n"],
        [`${(h.tick_max_us / 1000).toFixed(1)} ms`, "n"], [h.modality ? (wanted !== "0" && h.profile === wanted ? "taken" : h.profile === "0" ? "none" : "other") : "", "quiet"]]);
      if (h.note) tr.firstElementChild!.append(make("div", "quiet status", h.note));
      tr.dataset.node = h.node;
      return tr;
    }));
  }
  updateReport(report: { senses: ModalityReport[]; pairs: Pair[] }): void {
    this.reports = report.senses;
    const shown = report.pairs.filter((p) => p.n > 0), names = new Set(shown.map((p) => `${p.a} → ${p.b}`));
    const box = element("pairs");
    for (const [name, e] of this.pairs) if (!names.has(name)) { e.remove(); this.pairs.delete(name); }
    if (!shown.length) box.replaceChildren(make("p", "quiet", "no event has been presented by two senses yet"));
    else box.querySelector("p.quiet:not(.sources)")?.remove();
    for (const p of shown) this.showPair(box, p);
    requestAnimationFrame(() => shown.forEach((p) => this.drawPair(this.pairs.get(`${p.a} → ${p.b}`)!.querySelector("canvas")!, p)));
  }
  // One row, which opens to the numbers and the published thresholds. It stays the same element, so that focus and state remain.
  private showPair(box: HTMLElement, p: Pair): void {
    const name = `${p.a} → ${p.b}`;
    let e = this.pairs.get(name);
    if (!e) {
      const summary = make("summary", "pair"), canvas = document.createElement("canvas");
      canvas.setAttribute("aria-hidden", "true");
      summary.append(make("span", "", name), canvas, make("span", "value"));
      e = make("details");
      e.append(summary, make("p", "quiet sources"));
      box.append(e);
      this.pairs.set(name, e);
    }
    e.querySelector(".value")!.textContent = `${p.p50_ms.toFixed(1)} ms`;
    const text = `${p.n} events: 5 % ${p.p05_ms.toFixed(1)} ms, 50 % ${p.p50_ms.toFixed(1)} ms, 95 % ${p.p95_ms.toFixed(1)} ms; ${p.beyond_least < 0 ? "no threshold is published" : p.beyond_least + " beyond the least threshold"}${this.sources(p)}`;
    e.querySelector(".sources")!.textContent = text;
    e.title = text;
  }
  // The published thresholds of a pair, in both directions: the studies disagree, so all are listed.
  private sources(p: Pair): string {
    const of = (earlier: string, later: string) => this.thresholds.filter((t) => t.earlier === earlier && t.later === later)
      .map((t) => `\n${later} after ${earlier}, ${t.ms} ms: ${t.what} (${t.source})`);
    return [...of(p.a, p.b), ...of(p.b, p.a)].join("");
  }
  private range(earlier: string, later: string): [number, number] | undefined {
    const of = this.thresholds.filter((t) => t.earlier === earlier && t.later === later).map((t) => t.ms);
    return of.length ? [Math.min(...of), Math.max(...of)] : undefined;
  }
  private drawPair(canvas: HTMLCanvasElement, p: Pair): void {
    const scale = devicePixelRatio, w = (canvas.width = canvas.clientWidth * scale), h = (canvas.height = canvas.clientHeight * scale);
    const g = canvas.getContext("2d")!;
    const x = (ms: number) => w / 2 + (Math.max(-SPAN_MS, Math.min(SPAN_MS, ms)) / SPAN_MS) * (w / 2 - 2);
    g.fillStyle = css("field"); g.fillRect(0, 0, w, h);
    for (const [sign, of] of [[1, this.range(p.a, p.b)], [-1, this.range(p.b, p.a)]] as [number, [number, number] | undefined][]) {
      if (!of) continue;
      // The inner band has the full height, the outer one half of it.
      for (const [ms, colour, part] of [[of[1], css("largest"), 0.5], [of[0], css("least"), 1]] as [number, string, number][]) {
        g.fillStyle = colour;
        g.fillRect(Math.min(x(0), x(sign * ms)), (h * (1 - part)) / 2, Math.abs(x(ms) - x(0)), h * part);
      }
    }
    g.fillStyle = css("quiet"); g.fillRect(w / 2, 0, 1, h);
    g.fillStyle = colourOf(p.b); g.globalAlpha = 0.75;
    g.fillRect(x(p.p05_ms), h * 0.3, Math.max(2, x(p.p95_ms) - x(p.p05_ms)), h * 0.4);
    g.globalAlpha = 1; g.fillStyle = css("text"); g.fillRect(x(p.p50_ms) - scale, h * 0.12, 2 * scale, h * 0.76);
  }
  draw(now: number): void {
    const rows = this.modalities().map((m) => {
      const nodes = this.health.filter((h) => h.modality === m), h = nodes[0]!;
      const of = (this.latencies.get(m) ?? []).filter(([t]) => t > now - MEMORY_S).map(([, l]) => l).sort((a, b) => a - b);
      const report = this.reports.find((s) => s.modality === m);
      const slow = h.lost || h.rate_Hz < 0.9 * h.nominal_Hz;
      const tr = row([[m, "name"], [`${h.rate_Hz.toFixed(0)} / ${h.nominal_Hz.toFixed(0)} Hz`, slow ? "n bad" : "n"],
        [of.length ? `${quantile(of, 0.5).toFixed(1)} ms` : "–", "n"], [of.length ? `${quantile(of, 0.95).toFixed(1)} ms` : "–", "n"],
        [report ? `${report.presented} / ${report.expected}` : "–", "n"], [report ? String(report.lost) : "–", report && report.lost ? "n bad" : "n"]]);
      const name = tr.firstElementChild!;
      name.prepend(swatch(m));
      if (slow) name.append(make("span", "bad", h.lost ? " ⚠ lost" : " ⚠ slow"));
      tr.dataset.modality = m;
      tr.dataset.colour = colourOf(m);
      return tr;
    });
    element("senses").replaceChildren(row([["sense", ""], ["rate", ""], ["latency", ""], ["95 %", ""], ["presented", ""], ["lost", ""]], true), ...rows);
  }
}
