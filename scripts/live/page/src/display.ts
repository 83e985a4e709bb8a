// Size of the text and contrast of the page. Both are stored in the browser; the address can set them: &size=150&contrast=high.
import { element } from "./messages";
import { forgetColours } from "./palette";

const SIZES = ["100", "125", "150", "200"], CONTRASTS = ["dark", "light", "high"];
const STORE = "tactus-live-display";

export class Display {
  private size = "100";
  private contrast = "dark";
  constructor(private changed: () => void) {
    let stored: Record<string, unknown> = {};
    try { stored = JSON.parse(localStorage.getItem(STORE) ?? "{}") as Record<string, unknown>; } catch { /* not allowed, or damaged: the defaults */ }
    const address = new URLSearchParams(location.search);
    this.size = this.valid(SIZES, address.get("size"), stored.size, "100");
    this.contrast = this.valid(CONTRASTS, address.get("contrast"), stored.contrast, matchMedia("(prefers-contrast: more)").matches ? "high" : "dark");
    const size = element<HTMLSelectElement>("textsize"), contrast = element<HTMLSelectElement>("contrast");
    size.value = this.size;
    contrast.value = this.contrast;
    size.addEventListener("change", () => { this.size = size.value; this.apply(true); });
    contrast.addEventListener("change", () => { this.contrast = contrast.value; this.apply(true); });
    // Escape closes the box, as it does for a menu.
    element("display").addEventListener("keydown", (e) => {
      if (e.key !== "Escape") return;
      element("display").removeAttribute("open");
      element("display").querySelector("summary")!.focus();
    });
    this.apply(false);
  }
  private valid(known: string[], ...wanted: unknown[]): string { return wanted.find((w): w is string => typeof w === "string" && known.includes(w))!; }
  private apply(store: boolean): void {
    document.documentElement.dataset.size = this.size;
    document.body.dataset.contrast = this.contrast;
    forgetColours();
    if (store) try { localStorage.setItem(STORE, JSON.stringify({ size: this.size, contrast: this.contrast })); } catch { /* not allowed: not stored */ }
    this.changed();
  }
}
