// @ts-check
/* What the server describes: rows, which trees show, data, which scripts read, and
 * commands, which the page can call.
 *
 * All of them come first, and then what changes. Some are of the session, for everyone, and
 * some of this client alone.
 */

/**
 * @typedef {{
 *   id: string, in: string, kind: string, name?: string, value?: any, unit?: string,
 *   min?: number, max?: number, step?: number, options?: string[], editable?: boolean,
 *   help?: string, icon?: string, level?: string, off?: boolean, fixed?: boolean, local?: boolean,
 *   open?: boolean, bold?: boolean, lazy?: boolean, emptiable?: boolean, part?: number, [key: string]: any,
 * }} Row
 *   local: viewers may set it too
 * @typedef {{id: string, kind: "data" | "command", value?: any, local?: boolean}} Other
 * @typedef {{all?: boolean, panels?: Record<string, (Row | Other)[]>, rows?: Record<string, any>}}
 *   Part
 *   all: nothing of what came before holds
 */

/** What a tree is laid out by, beside the list of its rows. @type {(keyof Row)[]} */
const LAYOUT = ["lazy", "open", "apart"];

export class Rows {
  constructor() {
    /** @type {Map<string, Row>} */
    this.byId = new Map();
    /** Data and commands. @type {Map<string, Other>} */
    this.others = new Map();
    /** The ids of the data and commands of each panel. @type {Map<string, string[]>} */
    this.othersOf = new Map();
    /** The ids of the rows of each panel, in order. @type {Map<string, string[]>} */
    this.panels = new Map();
    /** The ids of the rows below a row, by its id; those at the top by "panel:NAME".
     * @type {Map<string, string[]>} */
    this.below = new Map();
    /** The names of the panels, by whose rows they show. @type {Map<string, string[]>} */
    this.names = new Map();
    /** @type {Map<string, Set<() => void>>} */
    this.listeners = new Map();
    /** What the server has said of rows that show something newer. @type {Map<string, any>} */
    this.held = new Map();
    /** Whether this user only watches: what others see cannot be set here. */
    this.watching = false;
    /** Whether such a user cannot set what is of this browser alone either. */
    this.closed = false;
    /** @type {WeakMap<Row, Row>} */
    this.locked = new WeakMap();
  }

  /** Whether both parts of the window have come, that of the session and that of this browser. */
  get isWhole() {
    return this.names.has("session") && this.names.has("browser");
  }

  /** Whether this user only watches from now on. @param {boolean} on @param {boolean} [closed] */
  watch(on, closed = false) {
    if (this.watching === on && this.closed === closed) return;
    this.watching = on;
    this.closed = closed;
    for (const id of [...this.byId.keys(), ...this.others.keys()]) this.notify(id);
  }

  /**
   * Take what the server has sent.
   * @param {string} scope "session" or "browser"
   * @param {Part} part
   */
  take(scope, { all = false, panels = {}, rows: patches = {} }) {
    const touched = new Set();
    if (all) {
      // A server that was started again may have fewer panels.
      for (const name of this.names.get(scope) || [])
        if (!(name in panels)) this.replace(name, [], touched);
      this.names.set(scope, Object.keys(panels));
      touched.add(`whole:${scope}`);
    }
    for (const [name, items] of Object.entries(panels)) this.replace(name, items, touched);
    for (const [id, patch] of Object.entries(patches)) this.patch(id, patch, touched);
    for (const key of touched) this.notify(key);
  }

  /**
   * @param {string} name @param {(Row | Other)[]} items @param {Set<string>} touched
   */
  replace(name, items, touched) {
    const rows = /** @type {Row[]} */ (items.filter((item) => !isOther(item))).flatMap((row) => [
      row,
      ...partsOf(row),
    ]);
    this.replaceOthers(name, /** @type {Other[]} */ (items.filter(isOther)), touched);
    const before = this.panels.get(name) || [];
    const ids = rows.map((row) => row.id);
    const kept = new Set(ids);
    for (const id of before) {
      if (!kept.has(id)) {
        this.byId.delete(id);
        this.below.delete(id);
        touched.add(id);
      }
    }
    this.panels.set(name, ids);
    const below = new Map([[`panel:${name}`, /** @type {string[]} */ ([])]]);
    let moved = !same(before, ids);
    for (const row of rows) {
      const key = row.in || `panel:${name}`;
      if (!below.has(key)) below.set(key, []);
      /** @type {string[]} */ (below.get(key)).push(row.id);
      this.held.delete(row.id);
      const old = this.byId.get(row.id);
      if (!same(old, row)) {
        moved ||= LAYOUT.some((field) => old?.[field] !== row[field]);
        this.byId.set(row.id, row);
        touched.add(row.id);
      }
    }
    for (const id of ids) if (!below.has(id)) this.below.delete(id);
    for (const [key, list] of below) {
      if (!same(this.below.get(key), list)) {
        this.below.set(key, list);
        moved = true;
      }
    }
    if (moved) touched.add(`panel:${name}`);
  }

  /** @param {string} name @param {Other[]} others @param {Set<string>} touched */
  replaceOthers(name, others, touched) {
    const before = this.othersOf.get(name) || [],
      ids = others.map((other) => other.id);
    for (const id of before)
      if (!ids.includes(id)) {
        this.others.delete(id);
        touched.add(id);
      }
    for (const other of others) {
      if (!same(this.others.get(other.id), other)) {
        this.others.set(other.id, other);
        touched.add(other.id);
      }
    }
    this.othersOf.set(name, ids);
  }

  /** @param {string} id @param {any} patch @param {Set<string>} touched */
  patch(id, patch, touched) {
    if ("value" in patch) this.held.delete(id);
    this.show(id, patch, touched);
  }

  /**
   * Show a value that the server has not confirmed yet.
   * @param {string} id @param {any} value
   */
  hope(id, value) {
    if (!this.held.has(id)) this.held.set(id, this.value(id));
    this.showNow(id, value);
  }

  /** Show what the server has said last: it has refused what is hoped for. @param {string} id */
  putBack(id) {
    if (!this.held.has(id)) return;
    const value = this.held.get(id);
    this.held.delete(id);
    this.showNow(id, value);
  }

  /** @param {string} id @param {any} value */
  showNow(id, value) {
    const touched = new Set();
    this.show(id, { value }, touched);
    for (const key of touched) this.notify(key);
  }

  /** @param {string} id @param {any} patch @param {Set<string>} touched */
  show(id, patch, touched) {
    const other = this.others.get(id),
      row = this.byId.get(id);
    if (other && !same(other.value ?? null, patch.value)) {
      this.others.set(id, { ...other, ...patch });
      touched.add(id);
    }
    if (!row) return;
    const changed = Object.keys(patch).filter((key) => !same(row[key] ?? null, patch[key]));
    if (!changed.length) return;
    /** @type {Row} */
    const next = { ...row };
    for (const key of changed) {
      if (patch[key] === null) delete next[key];
      else next[key] = patch[key];
    }
    this.byId.set(id, next);
    touched.add(id);
    if (changed.some((field) => LAYOUT.includes(field)))
      for (const [name, ids] of this.panels) if (ids.includes(id)) touched.add(`panel:${name}`);
    for (const part of partsOf(next)) {
      if (same(this.byId.get(part.id), part)) continue;
      this.byId.set(part.id, part);
      touched.add(part.id);
    }
  }

  /** @param {string} id */
  get(id) {
    const row = this.byId.get(id);
    if (!row || !this.watching || this.isOpen(row) || row.fixed || row.off) return row;
    if (!this.locked.has(row)) this.locked.set(row, { ...row, off: true });
    return this.locked.get(row);
  }

  /** The value of a row. @param {string} id */
  value(id) {
    return this.byId.get(id)?.value;
  }

  /** The value of data. @param {string} id */
  data(id) {
    return this.others.get(id)?.value ?? undefined;
  }

  /** Whether there is a command. @param {string} id */
  knows(id) {
    return this.others.get(id)?.kind === "command";
  }

  /** Whether a command can be called now by this user. @param {string} id */
  can(id) {
    return this.knows(id) && (!this.watching || this.isOpen(this.others.get(id)));
  }

  /** Whether who only watches can set a row, or call a command. @param {{local?: boolean} | undefined} item */
  isOpen(item) {
    return Boolean(item?.local) && !this.closed;
  }

  /** The ids below a row, or at the top of a panel ("panel:NAME"). @param {string} key */
  children(key) {
    return this.below.get(key) || [];
  }

  /**
   * Call a function after each change of a row, of data, of a command, of the list of a panel ("panel:NAME"), or
   * after all rows were sent ("whole:session", "whole:browser").
   * @param {string} key @param {() => void} listener @returns {() => void} stops it; again, it does nothing
   */
  listen(key, listener) {
    if (!this.listeners.has(key)) this.listeners.set(key, new Set());
    const set = /** @type {Set<() => void>} */ (this.listeners.get(key));
    set.add(listener);
    return () => {
      set.delete(listener);
      // Others may have begun to listen since the last one of these has stopped.
      if (!set.size && this.listeners.get(key) === set) this.listeners.delete(key);
    };
  }

  /** @param {string} key */
  notify(key) {
    for (const listener of [...(this.listeners.get(key) || [])]) listener();
  }
}

/** @param {{kind: string}} item */
const isOther = ({ kind }) => kind === "data" || kind === "command";

/** A row for each number of a vector. @param {Row} row @returns {Row[]} */
function partsOf(row) {
  if (row.kind !== "vector" || !row.parts) return [];
  const { unit, step, fixed, off, local, help } = row;
  const shared = Object.fromEntries(
    Object.entries({ unit, step, fixed, off, local, help }).filter(
      ([, value]) => value !== undefined,
    ),
  );
  return row.parts.map((/** @type {string} */ name, /** @type {number} */ part) => ({
    id: `${row.id}/.${name}`,
    in: row.id,
    kind: "float",
    name,
    value: row.value[part],
    part,
    ...shared,
  }));
}

/** Whether two values from JSON are equal. @param {any} a @param {any} b @returns {boolean} */
export function same(a, b) {
  if (a === b) return true;
  if (typeof a !== "object" || typeof b !== "object" || !a || !b) return false;
  const keys = Object.keys(a);
  return keys.length === Object.keys(b).length && keys.every((key) => same(a[key], b[key]));
}
