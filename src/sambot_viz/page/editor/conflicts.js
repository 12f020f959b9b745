// @ts-check
/* Marks the lines that another program has changed too. */

/** @typedef {{line: number, from: number, to: number, theirs: string}} Conflict */

export class ConflictMarks {
  /** @param {any} cm CodeMirror */
  constructor({ StateEffect, StateField, Decoration, EditorView }) {
    const set = StateEffect.define();
    const line = Decoration.line({ class: "cm-conflict" });
    /** @param {any} doc @param {Conflict[]} conflicts */
    this.of = (doc, conflicts) => set.of(Decoration.set(starts(doc, conflicts).map(mark)));
    /** @param {number} at */
    const mark = (at) => line.range(at);
    this.field = StateField.define({
      create: () => Decoration.none,
      /** @param {any} marks @param {any} transaction */
      update(marks, { changes, effects }) {
        const mapped = marks.map(changes);
        return effects.find((/** @type {any} */ one) => one.is(set))?.value ?? mapped;
      },
      provide: (/** @type {any} */ field) => EditorView.decorations.from(field),
    });
  }
}

/** Where the lines begin; of lines that are not here, the one behind.
 * @param {any} doc @param {Conflict[]} conflicts @returns {number[]} */
function starts(doc, conflicts) {
  const found = new Set();
  for (const { from, to } of conflicts)
    for (let at = from; at <= Math.max(from, to - 1); at = doc.lineAt(at).to + 1)
      found.add(doc.lineAt(Math.min(at, doc.length)).from);
  return [...found].sort((one, other) => one - other);
}
