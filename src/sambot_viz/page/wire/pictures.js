// @ts-check
/* The pictures of cameras: the newest of each display, decoded while the page is quick enough. */

/**
 * @typedef {{id: string, type: string, width: number, height: number, file?: Blob,
 *   view?: import("../view/scene_camera.js").View | null}} Picture
 */

/** The first byte of a binary frame with a picture. */
export const PICTURE = 2;

/** What a frame with a picture says. @param {ArrayBuffer} data @returns {Picture} */
export function unpacked(data) {
  const length = new DataView(data).getUint32(1, true);
  const about = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 5, length)));
  const file = new Blob([new Uint8Array(data, 5 + length)], { type: about.type });
  return { ...about, file: about.type ? file : undefined };
}

/** @typedef {(bitmap: ImageBitmap | null, broken: boolean, view?: Picture["view"]) => void} Draw */

export class Pictures {
  /** @param {(file: Blob) => Promise<ImageBitmap>} [decode] */
  constructor(decode = (file) => createImageBitmap(file)) {
    this.decode = decode;
    /** @type {Map<string, Draw>} */
    this.draws = new Map();
    /** The picture that waits until the one before it is decoded. @type {Map<string, Picture>} */
    this.waiting = new Map();
    /** The displays of which one is being decoded. @type {Set<string>} */
    this.busy = new Set();
  }

  /**
   * Draw the pictures of a display from now on; returns a function that ends that.
   * @param {string} id @param {Draw} draw
   */
  follow(id, draw) {
    this.draws.set(id, draw);
    return () => {
      if (this.draws.get(id) === draw) this.draws.delete(id);
    };
  }

  /** Take a picture. Of those that come faster than they are decoded, the last one counts.
   * @param {Picture} picture */
  async take(picture) {
    const { id } = picture;
    this.waiting.set(id, picture);
    if (this.busy.has(id)) return;
    this.busy.add(id);
    for (let next; (next = this.waiting.get(id));) {
      this.waiting.delete(id);
      let bitmap = null,
        broken = false;
      try {
        if (next.file) bitmap = await this.decode(next.file);
      } catch {
        broken = true;
      }
      this.draws.get(id)?.(bitmap, broken, next.view);
      bitmap?.close();
    }
    this.busy.delete(id);
  }
}

export const pictures = new Pictures();
