// Interprets a participant's input to a question, from any input device, and creates the answer. Independent of the document.
import { Study } from "./messages";

// One press can have several meanings; the current question decides which one counts.
export interface Press { choice?: number; fine?: number; coarse?: number; confirms?: boolean; continues?: boolean }
// An answer in the form that live_server parses.
export interface Answer { t: "answer"; question: string; choice: number; number: number; after_ns: number }

// key: KeyboardEvent.key.
export function pressOfKey(key: string): Press | undefined {
  if (/^[1-9]$/.test(key)) return { choice: Number(key) - 1 };
  switch (key) {
    case "ArrowLeft": return { fine: -1 };
    case "ArrowRight": return { fine: 1 };
    case "ArrowDown": return { coarse: -1 };
    case "ArrowUp": return { coarse: 1 };
    case "Enter": return { confirms: true, continues: true };
    case " ": return { continues: true };
    default: return undefined;
  }
}

// The mark on a number scale: it begins in the middle; both ends can be reached, though the last step may be shorter.
export class Mark {
  static readonly MAX_STEPS = 10000;  // design: the finest resolution of a mark
  readonly steps: number;
  private readonly step: number;
  private at: number;
  constructor(private readonly lowest: number, private readonly highest: number, step: number) {
    const steps = Math.ceil((highest - lowest) / step - 1e-9);
    this.steps = steps <= Mark.MAX_STEPS ? steps : Mark.MAX_STEPS;
    this.step = steps <= Mark.MAX_STEPS ? step : (highest - lowest) / Mark.MAX_STEPS;
    this.at = Math.floor(this.steps / 2);
  }
  get place(): number { return this.at; }
  set place(at: number) { this.at = Math.max(0, Math.min(this.steps, Math.round(at))); }
  move(fine: number, coarse: number): void { this.place = this.at + fine + coarse * Math.max(1, Math.round(this.steps / 10)); }
  get number(): number { return Math.min(this.lowest + this.at * this.step, this.highest); }
  text(number = this.number): string {
    let decimals = 0;
    for (let s = this.step; decimals < 6 && Math.abs(s - Math.round(s)) > 1e-6 * Math.max(1, s); s *= 10) ++decimals;
    return (number === 0 ? 0 : number).toFixed(decimals);
  }
}

// The current question, the time of its display, and whether its answer is in transfer. Times: performance.now(), ms.
export class QuestionState {
  static readonly ANSWER_TIMEOUT_MS = 1500;  // design: after this time without acceptance by the server, the answer may be given again
  private question: Study | undefined;
  private seen_ms: number | undefined;
  private sent_ms: number | undefined;
  mark: Mark | undefined;

  // Returns true when the current question has changed or ended.
  update(study: Study | null): boolean {
    const open = study && study.kind !== "nothing" && !study.answered ? study : undefined;
    const changed = open?.question !== this.question?.question;
    this.question = open;
    if (changed) {
      this.seen_ms = this.sent_ms = undefined;
      this.mark = open?.kind === "number" ? new Mark(open.lowest, open.highest, open.step) : undefined;
    }
    return changed;
  }
  get current(): Study | undefined { return this.question; }
  seen(question: string, at_ms: number): void { if (this.question?.question === question && this.seen_ms === undefined) this.seen_ms = at_ms; }
  // No answer is accepted before the question was seen, or while an answer is in transfer.
  acceptsAnswer(at_ms: number): boolean {
    return this.question !== undefined && this.seen_ms !== undefined && !(this.sent_ms !== undefined && at_ms < this.sent_ms + QuestionState.ANSWER_TIMEOUT_MS);
  }
  // used: true when the press has a meaning for the current question.
  press(p: Press, at_ms: number): { used: boolean; answer?: Answer } {
    const m = this.question;
    if (!m) return { used: false };
    if (m.kind === "read") return p.continues ? { used: true, answer: this.answer(-1, at_ms) } : { used: false };
    if (m.kind === "choice") return p.choice !== undefined && p.choice < m.choices.length ? { used: true, answer: this.answer(p.choice, at_ms) } : { used: false };
    if (p.fine || p.coarse) { this.mark?.move(p.fine ?? 0, p.coarse ?? 0); return { used: true }; }
    return p.confirms ? { used: true, answer: this.answer(-1, at_ms) } : { used: false };
  }
  private answer(choice: number, at_ms: number): Answer | undefined {
    if (!this.question || !this.acceptsAnswer(at_ms)) return undefined;
    this.sent_ms = at_ms;
    return { t: "answer", question: this.question.question, choice, number: this.mark?.number ?? 0, after_ns: Math.max(0, Math.round((at_ms - this.seen_ms!) * 1e6)) };
  }
}

// Presses of a gamepad with the W3C's standard mapping: A, B, X and Y choose, sticks and pad move the mark.
export class Pad {
  private before: boolean[] | undefined;
  private static readonly presses: Press[] = [
    { choice: 0, confirms: true, continues: true }, { choice: 1 }, { choice: 2 }, { choice: 3 }, { fine: -1 }, { fine: 1 }, { coarse: 1 }, { coarse: -1 }];
  // The new presses; buttons held at the first call count as pressed before.
  pressed(buttons: readonly boolean[], axes: readonly number[]): Press[] {
    const held = [0, 1, 2, 3, 14, 15, 12, 13].map((i) => buttons[i] ?? false);
    for (const stick of [0, 2]) {
      const x = axes[stick] ?? 0, y = axes[stick + 1] ?? 0, sideways = Math.abs(x) >= Math.abs(y), far = sideways ? x : y;
      const direction = (sideways ? 4 : 6) + (far < 0 ? 0 : 1);
      // Design: a stick counts as pushed beyond 0.6, and as released within 0.35.
      held[direction] = held[direction]! || Math.abs(far) > (this.before?.[direction] ? 0.35 : 0.6);
    }
    const pressed = this.before ? held.flatMap((h, i) => (h && !this.before![i] ? [Pad.presses[i]!] : [])) : [];
    this.before = held;
    return pressed;
  }
}
