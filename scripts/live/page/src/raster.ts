// Events over the last seconds, with a lane for the world and one for each modality.
import { Event, Presentation, element, make } from "./messages";
import { colourOf, css, textScale } from "./palette";

const SPAN_S = 10;
const MAX_EVENTS = 6000;
// Values of presentation_t.outcome; 0 and 1 mean presented.
const DROPPED_LATE = 2, DROPPED_BY_PROFILE = 3, INAUDIBLE = 4;

export class Raster {
  private events: Event[] = [];
  private presented: Presentation[] = [];
  constructor() {
    const legend = element("rasterlegend");
    legend.append(make("span", "quiet", "world: │ begin  ◆ hit  · end    senses: │ presented  ○ inaudible  × dropped"));
  }
  clear(): void { this.events = []; this.presented = []; }
  addEvents(events: Event[] = [], presented: Presentation[] = []): void {
    this.events.push(...events);
    this.presented.push(...presented);
    if (this.events.length > MAX_EVENTS) this.events.splice(0, this.events.length - MAX_EVENTS);
    if (this.presented.length > MAX_EVENTS) this.presented.splice(0, this.presented.length - MAX_EVENTS);
  }
  draw(now: number, modalities: string[]): void {
    const canvas = element<HTMLCanvasElement>("raster"), scale = devicePixelRatio * textScale();
    const lanes = ["world", ...modalities];
    canvas.style.height = `${(lanes.length * 24 + 20) * textScale()}px`;
    const w = (canvas.width = canvas.clientWidth * devicePixelRatio), h = (canvas.height = canvas.clientHeight * devicePixelRatio);
    const g = canvas.getContext("2d")!, left = 80 * scale, lane = 24 * scale;
    const x = (t: number) => left + ((t - now + SPAN_S) / SPAN_S) * (w - left - 8 * scale);
    g.font = `${11 * scale}px DejaVu Sans, sans-serif`;
    g.textBaseline = "middle";
    lanes.forEach((m, i) => {
      const y = (i + 0.5) * lane;
      g.fillStyle = css("line"); g.fillRect(left, y, w - left, 1);
      g.fillStyle = colourOf(m); g.fillRect(0, y - 4 * scale, 8 * scale, 8 * scale);
      g.fillStyle = css("text"); g.fillText(m, 12 * scale, y);
    });
    g.fillStyle = css("quiet"); g.textAlign = "center";
    for (let s = 0; s <= SPAN_S; s += 2) {
      const at = Math.min(w - 20 * scale, x(now - SPAN_S + s));
      g.fillText(s === SPAN_S ? "now" : `${s - SPAN_S} s`, at, h - 9 * scale);
    }
    g.textAlign = "left";
    canvas.setAttribute("aria-label", `events of the last ${SPAN_S} s: ${this.events.filter(([t]) => t >= now - SPAN_S && t <= now).length} in the world; `
      + modalities.map((m) => `${m} ${this.presented.filter(([t, of, , outcome]) => of === m && outcome <= 1 && t >= now - SPAN_S && t <= now).length} presented`).join(", "));
    g.fillStyle = colourOf("world");
    for (const [t, kind, , , speed] of this.events) {
      if (t < now - SPAN_S || t > now) continue;
      const y = 0.5 * lane, at = x(t);
      if (kind === 0) g.fillRect(at, y - 0.35 * lane, scale, 0.7 * lane);
      else if (kind === 1) { const r = scale * (2.5 + Math.min(4, 2 * speed)); g.beginPath(); g.moveTo(at, y - r); g.lineTo(at + r, y); g.lineTo(at, y + r); g.lineTo(at - r, y); g.fill(); }
      else g.fillRect(at, y - scale, 2 * scale, 2 * scale);
    }
    for (const [t, modality, part, outcome] of this.presented) {
      const i = lanes.indexOf(modality);
      if (i < 0 || t < now - SPAN_S || t > now) continue;
      const y = (i + 0.5) * lane, at = x(t);
      g.fillStyle = outcome === DROPPED_LATE || outcome === DROPPED_BY_PROFILE ? css("bad") : colourOf(modality);
      if (outcome <= 1) g.fillRect(at, y - (part === 1 ? 0.2 : 0.35) * lane, 1.5 * scale, (part === 1 ? 0.4 : 0.7) * lane);
      else g.fillText(outcome === INAUDIBLE ? "○" : "×", at - 4 * scale, y);
    }
  }
}
