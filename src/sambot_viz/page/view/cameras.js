// @ts-check
/* Cameras in the scene beside that of the view: the Images panel brings them, if it is there. */

/** @type {{draw: (renderer: any, scene: any, main: any, helpers: any[], names: any) => void, has: (camera: any) => boolean}} */
export const others = { draw: () => {}, has: () => false };
