// @ts-check
/* The model without xacro, as ROS gets it: it follows what is typed, and can only be read. */

import { html, useEffect, useRef } from "../vendor/preact.js";
import { act } from "../wire/channel.js";
import { loadCodeMirror, lookOf } from "./look.js";
import { replacement } from "./text_sync.js";
import { useData } from "../state.js";

const NAME = "expanded.urdf";

export function Expanded() {
  /** @type {Ref} */
  const host = useRef(null);
  const view = useRef(/** @type {any} */ (null));
  /** @type {string | undefined} */
  const text = useData("model/expanded");
  const latest = useRef("");
  latest.current = text || "";
  useEffect(() => {
    act("model/expand", [true]);
    loadCodeMirror().then((cm) => {
      if (host.current) view.current = made(cm, host.current, latest.current);
    });
    return () => {
      act("model/expand", [false]);
      view.current?.destroy();
    };
  }, []);
  useEffect(() => {
    const { current } = view;
    if (!current || !text) return;
    // What is read stays in its place.
    const { from, to, text: insert } = replacement(current.state.doc.toString(), text);
    current.dispatch({ changes: { from, to, insert } });
  }, [text]);
  return html`<div class="text" ref=${host}></div>`;
}

/** @param {any} cm CodeMirror @param {HTMLElement} parent @param {string} doc */
function made(cm, parent, doc) {
  const { EditorState, EditorView } = cm;
  const only = [EditorState.readOnly.of(true), EditorView.editable.of(false)];
  const extensions = [lookOf(cm, NAME, () => true), ...only];
  return new EditorView({ parent, state: EditorState.create({ doc, extensions }) });
}
