// The rendered picture, and the mouse in it as the hand while its box is ticked.
import { element } from "./messages";

const REPEAT_MS = 50;  // the server releases the device after 350 ms without a message

export class Picture {
  private url = "";
  private at: { x: number; y: number; down: boolean } | undefined;
  private push_m = 0;
  constructor(send: (m: object) => void) {
    const frame = element("frame"), hand = element<HTMLInputElement>("hand"), cursor = element("cursor");
    hand.addEventListener("change", () => { frame.classList.toggle("hand", hand.checked); this.at = undefined; cursor.hidden = true; });
    const place = (e: MouseEvent): void => {
      const box = frame.getBoundingClientRect();
      const clamp = (v: number) => Math.max(-1, Math.min(1, v));
      this.at = { x: clamp((2 * (e.clientX - box.left)) / box.width - 1), y: clamp(1 - (2 * (e.clientY - box.top)) / box.height), down: (e.buttons & 1) !== 0 };
      cursor.hidden = !hand.checked;
      cursor.style.left = `${e.clientX - box.left}px`;
      cursor.style.top = `${e.clientY - box.top}px`;
    };
    for (const kind of ["mousemove", "mousedown", "mouseup"] as const) frame.addEventListener(kind, (e) => { if (hand.checked) { place(e); e.preventDefault(); } });
    frame.addEventListener("wheel", (e) => { if (hand.checked) { this.push_m = Math.max(-1, Math.min(1, this.push_m - e.deltaY * 2e-4)); e.preventDefault(); } }, { passive: false });
    setInterval(() => {
      if (!hand.checked || !this.at) return;
      send({ t: "hand", ...this.at, push_m: this.push_m });
      this.push_m = 0;
    }, REPEAT_MS);
  }
  show(jpeg: Blob): void {
    const image = element<HTMLImageElement>("picture"), old = this.url;
    this.url = URL.createObjectURL(new Blob([jpeg], { type: "image/jpeg" }));
    image.onload = () => { element("frame").style.aspectRatio = `${image.naturalWidth} / ${image.naturalHeight}`; if (old) URL.revokeObjectURL(old); };
    image.src = this.url;
    element("nopicture").hidden = true;
    image.dataset.count = String(Number(image.dataset.count ?? "0") + 1);
  }
}
