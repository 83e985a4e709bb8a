// Rate, latency and asynchrony of the modalities, with the published thresholds; and their nodes.
import { NodeHealth, Pair, Presentation, ModalityReport, Threshold, colourOf, element, make } from "./messages";

const STATES = ["waiting", "running", "stale", "input lost", "output lost", "ready"];
const SPAN_MS = 250;  // of the scale of asynchrony, to both sides
const MEMORY_S = 30;

function row(cells: [string, string][], heading = false): HTMLElement {
  const tr = document.createElement("tr");
  for (const [text, className] of cells) tr.append(make(heading ? "th" : "td", className, text));
  return tr;
}
const quantile = (sorted: number[], q: number): number => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))]!;

export class ModalityTables {
  private latencies = new Map<string, [number, number][]>();
  private health: NodeHealth[] = [];
  private reports: ModalityReport[] = [];
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
      tr.title = h.note;
      tr.dataset.node = h.node;
      return tr;
    }));
  }
  updateReport(report: { senses: ModalityReport[]; pairs: Pair[] }): void {
    this.reports = report.senses;
    const box = element("pairs");
    const shown = report.pairs.filter((p) => p.n > 0);
    box.replaceChildren(...(shown.length ? shown.map((p) => this.pair(p)) : [make("p", "quiet", "no event has been presented by two senses yet")]));
    requestAnimationFrame(() => shown.forEach((p, i) => this.drawPair(box.children[i]!.querySelector("canvas")!, p)));
  }
  private pair(p: Pair): HTMLElement {
    const div = make("div", "pair");
    div.append(make("span", "", `${p.a} → ${p.b}`), document.createElement("canvas"), make("span", "value", `${p.p50_ms.toFixed(1)} ms`));
    div.title = `${p.n} events: 5 % ${p.p05_ms.toFixed(1)} ms, 50 % ${p.p50_ms.toFixed(1)} ms, 95 % ${p.p95_ms.toFixed(1)} ms; ${p.beyond_least < 0 ? "no threshold is published" : p.beyond_least + " beyond the least threshold"}${this.sources(p)}`;
    return div;
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
    g.fillStyle = "#20252d"; g.fillRect(0, 0, w, h);
    for (const [sign, of] of [[1, this.range(p.a, p.b)], [-1, this.range(p.b, p.a)]] as [number, [number, number] | undefined][]) {
      if (!of) continue;
      for (const [ms, colour] of [[of[1], "#36414d"], [of[0], "#3d5f47"]] as [number, string][]) {
        g.fillStyle = colour;
        g.fillRect(Math.min(x(0), x(sign * ms)), 0, Math.abs(x(ms) - x(0)), h);
      }
    }
    g.fillStyle = "#8b95a3"; g.fillRect(w / 2, 0, 1, h);
    g.fillStyle = colourOf(p.b); g.globalAlpha = 0.75;
    g.fillRect(x(p.p05_ms), h * 0.3, Math.max(2, x(p.p95_ms) - x(p.p05_ms)), h * 0.4);
    g.globalAlpha = 1; g.fillStyle = "#fff"; g.fillRect(x(p.p50_ms) - scale, h * 0.12, 2 * scale, h * 0.76);
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
      (tr.firstElementChild as HTMLElement).style.color = colourOf(m);
      tr.dataset.modality = m;
      return tr;
    });
    element("senses").replaceChildren(row([["sense", ""], ["rate", ""], ["latency", ""], ["95 %", ""], ["presented", ""], ["lost", ""]], true), ...rows);
  }
}
