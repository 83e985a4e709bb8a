// Delay, rate and loss of each sense; the server makes a profile of them.
import { colourOf, element, make } from "./messages";

interface Setting { delay_ms: number; rate_Hz: number; loss: number }
// Rates on a scale that a slider can show; the last: as it comes.
const RATES = [1, 2, 5, 10, 15, 20, 30, 60, 120, 250, 500, 0];

export class Sliders {
  private settings = new Map<string, Setting>();
  private timer = 0;
  constructor(private send: (senses: Record<string, Setting>) => void) {
    element("clear").addEventListener("click", () => {
      for (const m of this.settings.keys()) this.settings.set(m, { delay_ms: 0, rate_Hz: 0, loss: 0 });
      this.build();
      this.send(Object.fromEntries(this.settings));
    });
  }
  modalities(names: string[]): void {
    const fresh = names.filter((n) => !this.settings.has(n));
    if (!fresh.length) return;
    for (const n of fresh) this.settings.set(n, { delay_ms: 0, rate_Hz: 0, loss: 0 });
    this.build();
  }
  private changed(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.send(Object.fromEntries(this.settings)), 150);  // once the hand rests
  }
  private build(): void {
    element("sliders").replaceChildren(...[...this.settings.keys()].sort().map((m) => {
      const s = this.settings.get(m)!, box = make("div", "sense"), name = make("span", "name", m);
      name.style.color = colourOf(m);
      box.append(name,
        this.slider(`${m}-delay`, "delay", 0, 500, 5, s.delay_ms, (v) => { s.delay_ms = v; return `${v} ms`; }),
        this.slider(`${m}-rate`, "rate", 0, RATES.length - 1, 1, RATES.indexOf(s.rate_Hz), (v) => { s.rate_Hz = RATES[v]!; return s.rate_Hz ? `${s.rate_Hz} Hz` : "full"; }),
        this.slider(`${m}-loss`, "loss", 0, 100, 1, s.loss * 100, (v) => { s.loss = v / 100; return `${v} %`; }));
      return box;
    }));
  }
  private slider(id: string, title: string, least: number, most: number, step: number, value: number, set: (v: number) => string): HTMLElement {
    const label = document.createElement("label"), shown = make("b", "", set(value)), input = document.createElement("input");
    Object.assign(input, { type: "range", id, min: String(least), max: String(most), step: String(step) });
    input.value = String(value);
    input.addEventListener("input", () => { shown.textContent = set(Number(input.value)); this.changed(); });
    label.append(title, shown, input);
    return label;
  }
}
