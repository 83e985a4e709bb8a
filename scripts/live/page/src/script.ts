// Texts in any language: their direction, and characters that no font of this browser covers. Independent of the document, except glyphOf().

// Direction of a text by its first letter (Unicode Standard Annex 9, rule P2): Hebrew, Arabic and the scripts like them are written from right to left.
export function directionOf(text: string): "rtl" | "ltr" {
  const first = /\p{L}/u.exec(text)?.[0] ?? "";
  return /[\u0590-\u08ff\ufb1d-\ufdff\ufe70-\ufeff\u{10800}-\u{10fff}\u{1e800}-\u{1efff}]/u.test(first) ? "rtl" : "ltr";
}

// A character that no font has: the browser draws its replacement for it. Plane 15 is for private use.
const NOWHERE = "\u{ffffd}";

// The characters of a text whose drawing is that of a character that no font has. glyph: the drawing of a character, as text.
// Marks and invisible characters are left out, because they have no drawing of their own.
export function uncovered(texts: readonly string[], glyph: (character: string) => string): string[] {
  const characters = [...new Set(texts.flatMap((text) => [...text]))].filter((c) => c > "\x7f" && !/[\p{M}\p{C}\p{Z}]/u.test(c));
  if (characters.length === 0) return [];
  const replacement = glyph(NOWHERE);
  return characters.filter((c) => glyph(c) === replacement);
}

export const nameOf = (character: string): string => `${character} (U+${character.codePointAt(0)!.toString(16).toUpperCase().padStart(4, "0")})`;

// Draws a character with the fonts of the page.
export function glyphOf(font: string): (character: string) => string {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const g = canvas.getContext("2d", { willReadFrequently: true })!;
  g.font = font;
  return (character) => {
    g.clearRect(0, 0, 32, 32);
    g.fillText(character, 4, 24);
    return `${g.measureText(character).width} ${g.getImageData(0, 0, 32, 32).data.join()}`;
  };
}
