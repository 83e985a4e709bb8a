// Delay, rate and loss of each modality; of a stage also the deadband and the choices that the server lists. The controls start at the values of the
// profile in force; the server changes only the moved controls' values in the profile, and keeps the rest.
import { Choice, Controls, Degradation, SliderValues, element, make } from "./messages";
import { swatch } from "./palette";

// Rates on a scale that a slider can show; the last: unlimited.
const RATES = [1, 2, 5, 10, 15, 20, 30, 60, 120, 250, 500, 0];
// A received profile may be older than the values that were just sent.
const SETTLE_MS = 1500;
const BANDS = 40; // largest deadband of the slider, %
const undegraded = (): SliderValues => ({ delay_ms: 0, rate_Hz: 0, loss: 0, deadband: 0, choices: {} });
const nearest = (rate_Hz: number): number => {
  if (rate_Hz === 0) return RATES.length - 1;
  const far = RATES.map((r) => (r ? Math.abs(Math.log(r / rate_Hz)) : Infinity));
  return far.indexOf(Math.min(...far));
};
const labels = {
  delay: (s: SliderValues) => `${+s.delay_ms.toFixed(1)} ms`,
  rate: (s: SliderValues) => (s.rate_Hz ? `${+s.rate_Hz.toFixed(1)} Hz` : "full"),
  loss: (s: SliderValues) => `${+(s.loss * 100).toFixed(1)} %`,
  deadband: (s: SliderValues) => `${+(s.deadband * 100).toFixed(1)} %`,
};

export class Sliders {
  private settings = new Map<string, SliderValues>();
  private controls: Record<string, Controls> = {};
  private more = new Set<string>();  // modalities with operators that no slider shows
  private timer = 0;
  private touched_ms = -Infinity;
  private shownProfile = "";
  constructor(private send: (senses: Record<string, SliderValues>, clear: boolean) => void) {
    element("clear").addEventListener("click", () => {
      clearTimeout(this.timer);
      for (const m of this.settings.keys()) this.settings.set(m, undegraded());
      this.more.clear();
      this.touch();
      this.build();
      this.send(Object.fromEntries(this.settings), true);
    });
  }
  modalities(names: string[]): void {
    const added = names.filter((n) => !this.settings.has(n));
    if (!added.length) return;
    for (const n of added) this.settings.set(n, undegraded());
    this.shownProfile = "";  // shows the profile in force for them, too, once it is received again
    this.build();
  }
  inForce(d: Degradation): void {
    this.controls = d.controls;
    this.modalities(d.stages.filter((s) => this.settings.has(s.split(":")[0]!)));
    element("inforce").textContent = d.name ? `in force: ${d.name}` : "";
    const text = JSON.stringify(d.senses);
    element("inforce").dataset.senses = text;
    if (text === this.shownProfile || performance.now() < this.touched_ms + SETTLE_MS) return;
    this.shownProfile = text;
    this.more = new Set(Object.entries(d.senses).filter(([, s]) => s.more).map(([m]) => m));
    for (const m of this.settings.keys()) {
      const { delay_ms, rate_Hz, loss, deadband, choices } = d.senses[m] ?? undegraded();
      this.settings.set(m, { delay_ms, rate_Hz, loss, deadband, choices: { ...choices } });
    }
    this.build();
  }
  private touch(): void { this.touched_ms = performance.now(); this.shownProfile = ""; }
  private changed(): void {
    this.touch();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.send(Object.fromEntries(this.settings), false), 150);  // once the hand rests
  }
  // The focus stays on its slider.
  build(): void {
    const focused = document.activeElement?.closest("#sliders") ? document.activeElement.id : "";
    element("sliders").replaceChildren(...[...this.settings.keys()].sort().map((m) => {
      const s = this.settings.get(m)!, box = make("div", "sense"), name = make("span", "name", this.more.has(m) ? `${m} +` : m);
      name.prepend(swatch(m));
      if (this.more.has(m)) name.title = "the profile in force has further operators of this modality, which the sliders keep";
      box.append(name,
        this.slider(m, "delay", 500, 5, s.delay_ms, labels.delay(s), (v) => { s.delay_ms = v; return labels.delay(s); }),
        this.slider(m, "rate", RATES.length - 1, 1, nearest(s.rate_Hz), labels.rate(s), (v) => { s.rate_Hz = RATES[v]!; return labels.rate(s); }),
        this.slider(m, "loss", 100, 1, s.loss * 100, labels.loss(s), (v) => { s.loss = v / 100; return labels.loss(s); }));
      const own = this.controls[m];
      const selects = (own?.choices ?? []).map((c) => this.choice(m, c, s));
      const follow = (): void => { for (const one of selects) one.follow(); };
      if (own?.deadband) box.append(this.slider(m, "deadband", BANDS, 1, s.deadband * 100, labels.deadband(s), (v) => { s.deadband = v / 100; return labels.deadband(s); }));
      box.append(...selects.map((one) => one.label));
      box.addEventListener("input", follow);
      follow();
      return box;
    }));
    if (focused) document.getElementById(focused)?.focus();
  }
  // A choice has no effect, and cannot be made, while its slider is at 0.
  private choice(modality: string, choice: Choice, s: SliderValues): { label: HTMLElement; follow: () => void } {
    const label = document.createElement("label"), select = document.createElement("select");
    select.id = `${modality}-${choice.name}`;
    select.setAttribute("aria-label", `${choice.name} of ${modality}`);
    for (const value of choice.values) select.append(new Option(value, value));
    select.value = s.choices[choice.name] ?? choice.values[0]!;
    select.addEventListener("change", () => { s.choices[choice.name] = select.value; this.changed(); });
    label.append(choice.name, select);
    const size = (): number => choice.of === "deadband" ? s.deadband : choice.of === "loss" ? s.loss : choice.of === "" ? 1 : 0;
    return { label, follow: () => { select.disabled = size() <= 0; } };
  }
  private slider(modality: string, title: string, max: number, step: number, value: number, text: string, set: (v: number) => string): HTMLElement {
    const label = document.createElement("label"), shown = make("b", "", text), input = document.createElement("input");
    Object.assign(input, { type: "range", id: `${modality}-${title}`, min: "0", max: String(max), step: String(step) });
    input.value = String(value);
    input.setAttribute("aria-label", `${title} of ${modality}`);
    input.setAttribute("aria-valuetext", text);
    input.addEventListener("input", () => { shown.textContent = set(Number(input.value)); input.setAttribute("aria-valuetext", shown.textContent); this.changed(); });
    label.append(title, shown, input);
    return label;
  }
}
