// @ts-check
/* What belongs to this page alone: folds, the selected row, sizes, units. Kept in the
 * browser's storage where it should survive. */

import { useEffect, useLayoutEffect, useReducer } from "./vendor/preact.js";
import { rows } from "./wire/channel.js";

const STORAGE = "sambot-viz";

/** A value that components follow. @template T */
export class Cell {
  /** @param {T} value @param {string} [kept] its name in the browser's storage */
  constructor(value, kept) {
    this.kept = kept;
    this.value = value;
    /** @type {Set<() => void>} */
    this.listeners = new Set();
    if (kept && kept in stored) this.value = stored[kept];
  }

  /** @param {T} value @param {boolean} [keeps] else it holds for this page alone */
  set(value, keeps = true) {
    if (this.value === value) return;
    this.value = value;
    if (this.kept && keeps) {
      stored[this.kept] = value;
      store();
    }
    for (const listener of [...this.listeners]) listener();
  }

  /** The value, in a component that is drawn again when it changes. @returns {T} */
  use() {
    const [, again] = useReducer((/** @type {number} */ n) => n + 1, 0);
    const drawn = this.value;
    useLayoutEffect(() => {
      const listener = () => again(0);
      this.listeners.add(listener);
      // It may have changed while the component was drawn for the first time.
      if (this.value !== drawn) listener();
      return () => {
        this.listeners.delete(listener);
      };
    }, [this]);
    return this.value;
  }
}

/** @type {Record<string, any>} */
const stored = (() => {
  try {
    return JSON.parse(localStorage.getItem(STORAGE) || "{}");
  } catch {
    return {};
  }
})();

function store() {
  try {
    localStorage.setItem(STORAGE, JSON.stringify(stored));
  } catch {
    /* private windows have none */
  }
}

/** Follow a row, or the list of a panel ("panel:NAME"), in a component. @param {string} key */
export function useRow(key) {
  const [, again] = useReducer((/** @type {number} */ n) => n + 1, 0);
  useLayoutEffect(() => rows.listen(key, () => again(0)), [key]);
  return rows.get(key);
}

/** Follow data in a component. @param {string} id */
export function useData(id) {
  useRow(id);
  return rows.data(id);
}

/** Follow whether a command can be called. @param {string} id */
export function useCommand(id) {
  useRow(id);
  return rows.can(id);
}

/** Call a function when the page has been drawn, and what it returns at the end.
 * @param {() => void | (() => void)} effect @param {any[]} of */
export const useAfter = (effect, of) => useEffect(effect, of);

/**
 * Which rows are unfolded or folded, when not as the server says.
 * @type {Cell<Record<string, boolean>>}
 */
export const folds = new Cell({});
/** The selected row of each panel. @type {Cell<Record<string, string>>} */
export const selected = new Cell({});
/** The row that a button leads to. @type {Cell<{panel: string, id: string} | null>} */
export const wantedRow = new Cell(/** @type {any} */ (null));
/** Angles in degrees. @type {Cell<boolean>} */
export const degrees = new Cell(false, "degrees");

/**
 * How wide the names of a panel's rows are, as a part of the panel.
 * @type {Cell<Record<string, number>>}
 */
export const splits = new Cell({}, "splits");
/** @param {string} id */
export function isOpen(id) {
  return folds.value[id] ?? Boolean(rows.get(id)?.open);
}

/** @param {string} id @param {boolean} open */
export function fold(id, open) {
  folds.set({ ...folds.value, [id]: open });
}

/** @param {string} panel @param {string} id */
export function select(panel, id) {
  if (selected.value[panel] !== id) selected.set({ ...selected.value, [panel]: id });
}

/** The ids of the unfolded rows of the displays, which are saved with the config. */
export function unfolded() {
  return (rows.panels.get("displays") || []).filter(
    (id) => isOpen(id) && (rows.children(id).length > 0 || rows.get(id)?.lazy),
  );
}
