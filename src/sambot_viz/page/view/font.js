// @ts-check
/* Names in the view are in RViz's font on every machine. viser writes them into a canvas in the
 * first font of its list that the machine has; ours comes before that list, and what ours has no
 * letter for is still written by the list.
 * This runs before viser, not as a module: the font has to be there before the first name. */

{
  const data = document.getElementById("sambot-font")?.textContent || "";
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  // From bytes, a font is there at once; from an address it would have to be waited for.
  document.fonts.add(new FontFace("SambotNames", bytes));
  const slot = Object.getOwnPropertyDescriptor(CanvasRenderingContext2D.prototype, "font");
  if (slot?.set) {
    const set = slot.set;
    Object.defineProperty(CanvasRenderingContext2D.prototype, "font", {
      ...slot,
      /** @this {CanvasRenderingContext2D} @param {string} font */
      set(font) {
        set.call(this, font.replace(/^([\d.]+px )(?=-apple-system,)/, "$1SambotNames, "));
      },
    });
  }
}
