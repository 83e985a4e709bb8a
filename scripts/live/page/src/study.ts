// The panel of a study: with ?participant in the address, the question and its answer controls; otherwise the leader and the
// question.
import { Study, element, make } from "./messages";
import { QuestionState, Pad, Press, pressOfKey } from "./question";
import { directionOf, glyphOf, nameOf, uncovered } from "./script";

export const participant = new URLSearchParams(location.search).has("participant");

// An element with a text of the study, in its own direction of writing.
function says(tag: string, className: string, text: string): HTMLElement {
  const e = make(tag, className, text);
  e.dir = "auto";
  return e;
}

// One sentence about characters that the browser cannot draw; undefined: it can.
function problemOf(m: Study): HTMLElement | undefined {
  const lacking = uncovered([m.text, ...m.choices, m.hint, m.progress], glyphOf(`20px ${getComputedStyle(document.body).fontFamily}`));
  return lacking.length === 0 ? undefined
    : make("p", "bad", `No font of this browser covers ${lacking.slice(0, 4).map(nameOf).join(", ")}${lacking.length > 4 ? " and others" : ""}: install a font that does on this machine, and reload the page.`);
}

export class StudyPanel {
  private state = new QuestionState();
  private pads = new Map<number, Pad>();
  private box = element("study");
  private shown = "";
  private slider: HTMLInputElement | undefined;
  constructor(private send: (m: object) => void) {
    document.body.classList.toggle("participant", participant);
    if (!participant) return;
    document.addEventListener("keydown", (e) => {
      if ((e.target as Element).closest?.("#display")) return;  // keys of its own
      const press = e.ctrlKey || e.altKey || e.metaKey ? undefined : pressOfKey(e.key);
      if (!press || (e.repeat && !press.fine && !press.coarse)) return;
      if (this.press(press, e.timeStamp)) e.preventDefault();
    });
    const poll = (): void => { this.pollGamepads(); requestAnimationFrame(poll); };
    requestAnimationFrame(poll);
  }
  update(study: Study | null): void {
    if (!participant) return this.showStatus(study);
    if (this.state.update(study)) this.showQuestion();
    this.box.classList.toggle("sent", !this.state.acceptsAnswer(performance.now()));
  }
  private press(p: Press, at_ms: number): boolean {
    const { used, answer } = this.state.press(p, at_ms);
    if (answer) this.send(answer);
    this.box.classList.toggle("sent", !this.state.acceptsAnswer(performance.now()));
    this.showMark();
    return used;
  }
  private pollGamepads(): void {
    const connected = navigator.getGamepads().flatMap((g) => (g ? [g] : []));
    for (const index of this.pads.keys()) if (!connected.some((g) => g.index === index)) this.pads.delete(index);
    for (const g of connected) {
      if (!this.pads.has(g.index)) this.pads.set(g.index, new Pad());
      for (const p of this.pads.get(g.index)!.pressed(g.buttons.map((b) => b.pressed), g.axes)) this.press(p, performance.now());
    }
  }
  private showQuestion(): void {
    const m = this.state.current;
    this.box.hidden = !m;
    this.slider = undefined;
    this.box.replaceChildren();
    if (!m) return;
    const problem = problemOf(m);
    if (problem) this.box.append(problem);
    this.box.append(says("h1", "asked", m.text));
    const answers = make("div", "answers");
    answers.dir = directionOf(m.text);  // the keys are where a line begins
    if (m.kind === "choice") m.choices.forEach((c, i) => answers.append(this.button(c, String(i + 1), { choice: i })));
    if (m.kind === "number") this.box.append(this.slide(m));
    // A hint of the study names the key itself.
    const enter = m.hint ? "" : "Enter";
    if (m.kind === "number") answers.append(this.button(m.hint || "answer", enter, { confirms: true }));
    if (m.kind === "read") answers.append(this.button(m.hint || "continue", enter, { continues: true }));
    this.box.append(answers);
    if (m.kind === "choice" && m.hint) this.box.append(says("p", "quiet", m.hint));
    this.box.append(says("p", "quiet", m.progress));
    this.showMark();
    // Measures the time after painting: a message that is posted just before a frame is drawn arrives just after it.
    requestAnimationFrame(() => {
      const channel = new MessageChannel();
      channel.port1.onmessage = () => { this.state.seen(m.question, performance.now()); this.box.classList.toggle("sent", !this.state.acceptsAnswer(performance.now())); };
      channel.port2.postMessage(0);
    });
  }
  private button(text: string, key: string, press: Press): HTMLElement {
    const button = make("button", "answer");
    if (key) button.append(make("kbd", "", key));
    button.append(says("span", "", text));
    button.addEventListener("click", (e) => this.press(press, e.timeStamp));
    return button;
  }
  private slide(m: Study): HTMLElement {
    const box = make("div", "slide"), input = document.createElement("input"), ends = make("div", "ends"), mark = this.state.mark!;
    Object.assign(input, { type: "range", id: "mark", min: "0", max: String(mark.steps), step: "1" });
    input.setAttribute("aria-label", m.text);
    input.addEventListener("input", () => { mark.place = Number(input.value); this.showMark(); });
    const words = m.choices.length === 2 ? m.choices : [mark.text(m.lowest), mark.text(m.highest)];
    ends.append(...words.map((w) => says("span", "", w)));
    box.append(make("output", "marked"), input, ends);
    this.slider = input;
    return box;
  }
  private showMark(): void {
    const mark = this.state.mark, output = this.box.querySelector("output");
    if (!mark || !this.slider || !output) return;
    this.slider.value = String(mark.place);
    this.slider.setAttribute("aria-valuetext", mark.text());
    output.textContent = mark.text();
  }
  // For observers: without answer controls.
  private showStatus(study: Study | null): void {
    const text = JSON.stringify(study);
    if (text === this.shown) return;
    this.shown = text;
    this.box.hidden = study === null;
    if (!study) return;
    const facts = [study.progress, study.trial ? `trial ${study.trial}` : "", study.condition].filter((s) => s !== "").join(" · ");
    const head = make("h2", "", "Study");
    head.append(make("span", "", `led by ${study.leader || "a program without health messages"}`));
    const asked = study.kind === "nothing" ? "no question: a trial is in progress" : study.text;
    const status = study.kind === "nothing" ? "" : study.answered ? "answered in a page" : "waits for the participant";
    const offered = study.kind === "number" ? `${study.lowest} to ${study.highest}${study.choices.length ? `: ${study.choices.join(" to ")}` : ""}`
      : study.choices.map((c, i) => `${i + 1} ${c}`).join("   ");
    this.box.replaceChildren(head, make("p", "facts", facts), says("p", "asked", asked), says("p", "offered quiet", offered), make("p", "quiet", status));
  }
}
