// The rendered picture, and the mouse or the keys in it as the hand while its box is ticked.
import { element } from "./messages";

const REPEAT_MS = 50;  // the server releases the device after 350 ms without a message
const STEP = 0.02;     // design: of half the picture in REPEAT_MS; with shift four times that
const PUSH_M = 0.004;  // design: in REPEAT_MS; the server limits the speed to 1 m/s
const clamp = (v: number): number => Math.max(-1, Math.min(1, v));
const KEYS: Record<string, [number, number, number]> = { ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0], PageUp: [0, 0, 1], PageDown: [0, 0, -1] };

export class Picture {
  private url = "";
  private at: { x: number; y: number; down: boolean } | undefined;
  private push_m = 0;
  private held = new Set<string>();
  private fast = false;
  private frame = element("frame");
  private hand = element<HTMLInputElement>("hand");
  private cursor = element("cursor");
  constructor(send: (m: object) => void) {
    this.hand.addEventListener("change", () => {
      this.frame.classList.toggle("hand", this.hand.checked);
      for (const [name, value] of [["tabindex", "0"], ["role", "application"], ["aria-label", "the hand: arrows move it, page up and page down push and pull it, space is its button"]])
        if (this.hand.checked) this.frame.setAttribute(name!, value!);
        else this.frame.removeAttribute(name!);
      this.at = undefined;
      this.held.clear();
      this.cursor.hidden = true;
    });
    for (const kind of ["mousemove", "mousedown", "mouseup"] as const) this.frame.addEventListener(kind, (e) => { if (this.hand.checked) { this.place(e); e.preventDefault(); } });
    this.frame.addEventListener("wheel", (e) => { if (this.hand.checked) { this.push_m = clamp(this.push_m - e.deltaY * 2e-4); e.preventDefault(); } }, { passive: false });
    this.frame.addEventListener("keydown", (e) => this.key(e, true));
    this.frame.addEventListener("keyup", (e) => this.key(e, false));
    this.frame.addEventListener("blur", () => { this.held.clear(); if (this.at) this.at.down = false; });
    setInterval(() => {
      if (!this.hand.checked) return;
      this.step();
      if (!this.at) return;
      send({ t: "hand", ...this.at, push_m: this.push_m });
      this.push_m = 0;
    }, REPEAT_MS);
  }
  private place(e: MouseEvent): void {
    const box = this.frame.getBoundingClientRect();
    this.at = { x: clamp((2 * (e.clientX - box.left)) / box.width - 1), y: clamp(1 - (2 * (e.clientY - box.top)) / box.height), down: (e.buttons & 1) !== 0 };
    this.showCursor();
  }
  private showCursor(): void {
    if (!this.at) return;
    this.cursor.hidden = !this.hand.checked;
    this.cursor.style.left = `${50 * (this.at.x + 1)}%`;
    this.cursor.style.top = `${50 * (1 - this.at.y)}%`;
  }
  // Arrows move the hand, page up and page down push and pull it, space is its button.
  private key(e: KeyboardEvent, down: boolean): void {
    if (!this.hand.checked || e.ctrlKey || e.altKey || e.metaKey || !(e.key in KEYS || e.key === " ")) return;
    e.preventDefault();
    this.at ??= { x: 0, y: 0, down: false };
    this.fast = e.shiftKey;
    if (e.key === " ") this.at.down = down;
    else if (down) this.held.add(e.key);
    else this.held.delete(e.key);
  }
  private step(): void {
    if (!this.at || this.held.size === 0) return;
    const step = STEP * (this.fast ? 4 : 1);
    for (const key of this.held) {
      const [x, y, push] = KEYS[key]!;
      this.at.x = clamp(this.at.x + step * x);
      this.at.y = clamp(this.at.y + step * y);
      this.push_m = clamp(this.push_m + PUSH_M * push);
    }
    this.showCursor();
  }
  show(jpeg: Blob): void {
    const image = element<HTMLImageElement>("picture"), old = this.url;
    this.url = URL.createObjectURL(new Blob([jpeg], { type: "image/jpeg" }));
    image.onload = () => { this.frame.style.aspectRatio = `${image.naturalWidth} / ${image.naturalHeight}`; if (old) URL.revokeObjectURL(old); };
    image.src = this.url;
    element("nopicture").hidden = true;
    image.dataset.count = String(Number(image.dataset.count ?? "0") + 1);
  }
}
