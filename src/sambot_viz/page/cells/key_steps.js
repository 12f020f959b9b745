// @ts-check
/* Which keys are one step for Undo: a key that is held is one, each press is another. */

/** @typedef {{key: string, repeat?: boolean, shiftKey?: boolean, altKey?: boolean}} Stroke */

/**
 * Whether a key goes on with the step that the one before has begun: it is held since then, and
 * does the same. A key that was let go of elsewhere, or while another went down, is not held.
 * @param {Stroke | null | undefined} before @param {Stroke} now
 */
export const goesOn = (before, now) =>
  Boolean(now.repeat) &&
  before?.key === now.key &&
  Boolean(before.shiftKey) === Boolean(now.shiftKey) &&
  Boolean(before.altKey) === Boolean(now.altKey);
