// @ts-check
/* The editor in the panel Model: one file at a time, each with its own undo. */

import { act, ONLINE, CUT, rows } from "../wire/channel.js";
import { refusals, tell } from "../window/notices.js";
import { hovered } from "../panels/pointed_joint.js";
import { ConflictMarks } from "./conflicts.js";
import { jointAround } from "./joint_around.js";
import { lookOf } from "./look.js";
import { TextSync } from "./text_sync.js";

/** What is typed is sent when no key was pressed for so long [ms]. */
const PAUSE = 300;

/**
 * @typedef {{file: string, version: number, text: string, most: number, why: string,
 *   changed: boolean, merges: number, asks: boolean, gone: boolean,
 *   conflicts: import("./conflicts.js").Conflict[]}} Content of the server
 * @typedef {{id: string, from: number, to: number, severity: string, message: string, hint: string,
 *   edits: [number, number, string][] | null, fix: boolean}} Found
 */

/** The files that were open in this page, and how often each was merged.
 * @type {Map<string, {sync: TextSync, state: any, merges: number}>} */
const opened = new Map();

/** The editor that is seen: texts that were open before have extensions that ask it.
 * @type {Editor | null} */
let current = null;
/** What changes in the extensions of all texts. @type {any} */
let parts = null;
/** The last place that was asked for and shown; one may be asked for before there is an editor. */
let went = 0;

export class Editor {
  /** @param {any} cm CodeMirror @param {HTMLElement} host where it is */
  constructor(cm, host) {
    this.cm = cm;
    this.file = "";
    /** The joint that is lit. */
    this.lit = "";
    parts ??= {
      access: new cm.Compartment(),
      conflicts: new ConflictMarks(cm),
      fromServer: cm.Annotation.define(),
    };
    current = this;
    this.view = new cm.EditorView({ parent: host, dispatchTransactions: this.dispatch });
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.timer = undefined;
    const listened = /** @type {[string, () => void][]} */ ([
      ["model/text", this.take],
      ["model/found", this.mark],
      ["model/wanted", this.goTo],
      ["model/type", this.follow],
      ["whole:browser", this.sendAgain],
      [ONLINE, this.sendAgain],
      [CUT, () => this.open?.sync.forget()],
    ]);
    this.ends = listened.map(([key, listener]) => rows.listen(key, listener));
    this.take();
  }

  /** The file that is open. */
  get open() {
    return opened.get(this.file);
  }

  /** Leave the page as it is; what was typed is sent. */
  close() {
    this.keep();
    for (const end of this.ends) end();
    if (this.lit) hovered.set("");
    this.view.destroy();
  }

  /** Show another file. @param {string} name */
  show(name) {
    this.keep();
    act("model/open", [name]);
  }

  keep() {
    this.send();
    if (this.open) this.open.state = this.view.state;
  }

  /** @param {any[]} transactions @param {any} view */
  dispatch = (transactions, view) => {
    view.update(transactions);
    this.light();
    for (const transaction of transactions) {
      if (!transaction.docChanged || transaction.annotation(parts.fromServer)) continue;
      this.open?.sync.type(transaction.changes, transaction.newDoc.toString());
      this.sendSoon();
    }
  };

  /** Light the joint that the cursor is in. */
  light() {
    const { doc, selection } = this.view.state;
    const name = this.view.hasFocus ? jointAround(doc.toString(), selection.main.head) : "";
    if (name === this.lit) return;
    this.lit = name;
    hovered.set(name && `j/${name}`);
  }

  sendSoon() {
    clearTimeout(this.timer);
    this.timer = setTimeout(this.send, PAUSE);
  }

  /** Send what was typed now. */
  send = () => {
    clearTimeout(this.timer);
    if (!rows.can("model/type")) return;
    for (const { version, from, to, text, more } of this.open?.sync.pieces() ?? [])
      act("model/type", [this.file, version, from, to, text, more]);
  };

  sendAgain = () => {
    this.open?.sync.forget();
    this.take();
    this.send();
  };

  /** Take what the server says of the text. */
  take = () => {
    /** @type {Content | undefined} */
    const content = rows.data("model/text");
    if (!content) return;
    if (content.file !== this.file) this.begin(content);
    else {
      const sync = /** @type {TextSync} */ (this.open?.sync);
      this.change(sync.take(content.version, content.text));
      // Others may have come in between.
      if (sync.isAhead && !sync.sent) this.sendSoon();
    }
    this.compare(content);
    this.mark();
    this.goTo();
  };

  /** Select what a click in the view has asked for, or write the numbers that were moved, as soon as
   * their file is shown. */
  goTo = () => {
    const { number = 0, file, extent, ...written } = rows.data("model/wanted") ?? {};
    if (number === went || file !== this.file) return;
    // What was typed before comes first.
    if (written.version > (this.open?.sync.version ?? 0)) return;
    went = number;
    if (!extent) return this.put(written);
    this.select(extent[0], extent[1]);
  };

  /** Select a part of the text, and show it. @param {number} from @param {number} to */
  select(from, to) {
    const [anchor, head] = [from, to].map((at) => Math.min(at, this.view.state.doc.length));
    const shown = this.cm.EditorView.scrollIntoView(anchor, { y: "center" });
    this.view.dispatch({ selection: { anchor, head }, effects: shown });
  }

  /** @param {any} changes of others */
  change(changes) {
    if (!changes) return;
    this.view.dispatch({
      changes,
      annotations: [parts.fromServer.of(true), this.cm.Transaction.addToHistory.of(false)],
    });
    const open = this.open;
    if (open) open.sync.text = this.view.state.doc.toString();
  }

  /** Show a file. @param {Content} content */
  begin(content) {
    if (this.open) this.keep();
    this.file = content.file;
    const before = opened.get(content.file);
    if (before) {
      this.view.setState(before.state);
      this.change(before.sync.take(content.version, content.text));
    } else {
      const state = this.made(content);
      opened.set(content.file, {
        sync: new TextSync(this.cm.ChangeSet, content.text, content.version),
        state,
        merges: content.merges,
      });
      this.view.setState(state);
    }
    this.follow();
  }

  /** @param {Content} content */
  made({ file, text, most }) {
    const { EditorState } = this.cm;
    return EditorState.create({
      doc: text,
      extensions: [
        lookOf(this.cm, file, () => Boolean(current?.save())),
        parts.access.of([]),
        parts.conflicts.field,
        EditorState.changeFilter.of((/** @type {any} */ one) => {
          if (one.newDoc.length <= most) return true;
          const limit = most.toLocaleString("en");
          tell(`A file may have ${limit} characters; nothing was added to this one`, "error");
          return false;
        }),
      ],
    });
  }

  /** Whether this user may write. */
  follow = () => {
    if (refusals.has("model/type")) this.open?.sync.forget();
    const reads = !rows.can("model/type");
    const { EditorState, EditorView } = this.cm;
    const only = [EditorState.readOnly.of(true), EditorView.editable.of(false)];
    this.view.dispatch({ effects: parts.access.reconfigure(reads ? only : []) });
  };

  /** Mark what another program has changed too, and say what was merged.
   * @param {Content} content */
  compare({ file, version, merges, conflicts }) {
    const open = this.open;
    if (!open) return;
    if (merges > open.merges && !conflicts.length)
      tell(`Another program has saved ${file}: the text has its changes and those of here`, "info");
    open.merges = merges;
    if (!open.sync.isAhead && version === open.sync.version)
      this.view.dispatch({ effects: parts.conflicts.of(this.view.state.doc, conflicts) });
  }

  /** Mark what is wrong with the text, if that is still the one that was checked. */
  mark = () => {
    const found = rows.data("model/found");
    const sync = this.open?.sync;
    if (!found || !sync || found.file !== this.file || sync.isAhead) return;
    if (found.version !== sync.version) return;
    const { doc } = this.view.state;
    const marks = found.problems.map((/** @type {Found} */ one) => this.diagnostic(one, doc));
    this.view.dispatch(this.cm.setDiagnostics(this.view.state, marks));
  };

  /** @param {Found} found @param {any} checked the text that it is of */
  diagnostic({ id, from, to, severity, message, hint, edits, fix }, checked) {
    const apply = (/** @type {any} */ view) => {
      if (view.state.doc !== checked) return tell("The text has changed since it was checked");
      if (!edits) return act("model/fix", [id]);
      const changes = edits.map(([start, end, insert]) => ({ from: start, to: end, insert }));
      view.dispatch({ changes, userEvent: "input.fix" });
      this.send();
      view.focus();
    };
    const may = fix && rows.can("model/type");
    return {
      from,
      to: Math.max(from, Math.min(to, checked.length)),
      severity,
      message,
      renderMessage: () => said([message, hint]),
      actions: may ? [{ name: "Apply", apply }] : [],
    };
  }

  /** Let the server say what is to be written here; what was typed is sent before.
   * @param {string} command @param {any[]} [values] */
  ask(command, values) {
    this.send();
    act(command, values);
  }

  /** @param {{version: number, changes: {from: number, to: number, insert: string}[],
   *   more: boolean}} written more: another file has some, too */
  put({ version, changes, more }) {
    const sync = this.open?.sync;
    if (!sync || sync.isAhead || sync.version !== version)
      return tell("The text has changed meanwhile; try again", "info");
    const shown = this.cm.EditorView.scrollIntoView(changes[0].from, { y: "center" });
    this.view.dispatch({ changes, effects: shown, userEvent: "input.written" });
    this.send();
    if (more) act("model/write");
  }

  save() {
    this.send();
    if (rows.can("model/save")) act("model/save", [this.file]);
    else tell("This program writes no files: Download keeps the text", "info");
    return true;
  }

  /** Let the browser keep the text as a file. */
  download() {
    const address = URL.createObjectURL(new Blob([this.view.state.doc.toString()]));
    const link = document.createElement("a");
    link.href = address;
    link.download = this.file.split("/").pop() || "model";
    link.click();
    URL.revokeObjectURL(address);
  }
}

/** @param {string[]} sentences */
function said(sentences) {
  const element = document.createElement("div");
  for (const sentence of sentences.filter(Boolean)) {
    const line = document.createElement("p");
    line.textContent = sentence;
    element.append(line);
  }
  return element;
}
