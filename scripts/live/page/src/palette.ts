// Colours of the page: those of Okabe and Ito (2008), which people with any colour vision distinguish. page.css defines them for each contrast.
// No information is given by a colour alone: a name, a mark or a line style goes with each.
const cache = new Map<string, string>();
const NAMED = ["haptic", "audio", "visual", "thermal", "world"];

// The value of a variable of page.css in the present contrast.
export function css(name: string): string {
  const known = cache.get(name);
  if (known !== undefined) return known;
  const value = getComputedStyle(document.body).getPropertyValue(`--${name}`).trim();
  cache.set(name, value);
  return value;
}
// To be called when the contrast changes.
export const forgetColours = (): void => cache.clear();
// A stage, such as haptic:force, has the colour of its modality.
export function colourOf(modality: string): string {
  const name = modality.split(":")[0]!;
  return css(NAMED.includes(name) ? name : "other");
}

// Curves of one graph, one for each sender that the server distinguishes: colour, and dashes as in setLineDash.
const DASHES = [[], [7, 4], [2, 3], [8, 3, 2, 3], [12, 4], [4, 2], [1, 5], [10, 2, 2, 2, 2, 2]];
export const MAX_CURVES = DASHES.length;
export const curve = (k: number): { colour: string; dash: number[] } => ({ colour: css(`curve-${k % MAX_CURVES}`), dash: DASHES[k % MAX_CURVES]! });

// Factor on sizes of text that is drawn on a canvas.
export const textScale = (): number => Number.parseFloat(getComputedStyle(document.documentElement).fontSize) / 13;

// A small field in the colour of a modality, beside its name.
export function swatch(modality: string): HTMLElement {
  const e = document.createElement("i");
  e.className = "swatch";
  e.style.background = colourOf(modality);
  return e;
}
// A short line as in the graph.
export function sample(k: number): SVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg"), line = document.createElementNS(svg.namespaceURI, "line") as SVGElement;
  svg.setAttribute("class", "sample");
  svg.setAttribute("viewBox", "0 0 26 6");
  svg.setAttribute("aria-hidden", "true");
  const { colour, dash } = curve(k);
  for (const [name, value] of [["x1", "0"], ["x2", "26"], ["y1", "3"], ["y2", "3"], ["stroke", colour], ["stroke-width", "2"], ["stroke-dasharray", dash.join(" ")]])
    line.setAttribute(name!, value!);
  svg.append(line);
  return svg as SVGElement;
}
