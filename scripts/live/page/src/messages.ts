// The messages of the server: scripts/live/README.md.
export interface VariableInfo { name: string; unit: string; about: string }
export interface Threshold { earlier: string; later: string; ms: number; what: string; source: string }
export interface NodeHealth {
  node: string; source: number; modality: string; state: number; lost: boolean; note: string; rate_Hz: number; nominal_Hz: number; missed: number;
  ticks: number; rendered: number; profile: string; realtime: number; gaps: number; tick_max_us: number; wake_max_us: number;
}
export interface ModalityReport { modality: string; expected: number; presented: number; lost: number; dropped: number; late: number }
export interface Pair { a: string; b: string; n: number; p05_ms: number; p50_ms: number; p95_ms: number; beyond_least: number }
export type Event = [time_s: number, kind: number, body_a: number, body_b: number, speed_m_s: number];
export type Presentation = [time_s: number, modality: string, part: number, outcome: number, latency_ms: number | null];
// source: header.source of the sender; 0: the process with that tag.
export type Value = [variable: number, time_s: number, value: number, source: number];
export interface Common { now: number; health?: NodeHealth[]; report?: { senses: ModalityReport[]; pairs: Pair[] }; tags?: VariableInfo[] }
// deadband: a share of the value; choices: by the names of Choice.
export interface SliderValues { delay_ms: number; rate_Hz: number; loss: number; deadband: number; choices: Record<string, string> }
// A part of a rule that takes one of several names, the first of which changes nothing. of: the slider that must be above 0; "": none.
export interface Choice { name: string; of: string; values: string[] }
export interface Controls { deadband: boolean; choices: Choice[] }
// The profile in force; more: it contains operators of a modality that no control shows. stages: all stages of modalities, each a sense
// "MODALITY:STAGE"; controls: those of each stage beside delay, rate and loss.
export interface Degradation { name: string; senses: Record<string, SliderValues & { more: boolean }>; stages: string[]; controls: Record<string, Controls> }
// question: its name; kind "nothing": a trial is in progress. leader: the leading node; "": it publishes no health.
export interface Study {
  question: string; kind: "nothing" | "read" | "choice" | "number"; text: string; choices: string[]; lowest: number; highest: number; step: number;
  trial: number; condition: string; progress: string; hint: string; answered: boolean; leader: string;
}
export interface Hello extends Common { t: "hello"; live: boolean; title: string; thresholds: Threshold[]; catalog: VariableInfo[] }
export interface Frame extends Common {
  t: "frame"; values?: Value[]; events?: Event[]; presented?: Presentation[]; left_out?: number; wound?: boolean;
  world?: { known: boolean; sim_s: number; rate: number }; profile?: string; degradation?: Degradation;
  study?: Study | null;
  scene?: { name: string; bodies: string[]; tools: string[] };
  pages?: { open: number; dropped: number; refused: number };
  log?: { position_s: number; length_s: number; playing: boolean; rate: number; damaged: number; warnings: string[] };
}
export interface Reply { t: "reply"; text: string; good: boolean }
export type ServerMessage = Hello | Frame | Reply;

export function element<T extends HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page lacks #${id}`);
  return found as T;
}
// Text from the bus never becomes markup.
export function make(tag: string, className = "", text = ""): HTMLElement {
  const e = document.createElement(tag);
  e.className = className;
  e.textContent = text;
  return e;
}
export const figure = (x: number): string => {
  const size = Math.abs(x);
  return size !== 0 && (size >= 1e6 || size < 1e-3) ? x.toExponential(3) : x.toFixed(size >= 1000 ? 0 : size >= 10 ? 2 : 4);
};
