// @ts-check
/* How texts look in the editor, and its keys: those of VS Code, as CodeMirror has them. */

import { rows } from "../wire/channel.js";
import { offeredIn } from "./yaml_words.js";

const IS_MODEL = /\.(xacro|urdf|sdf|xml)$/;

/** Load CodeMirror, which is no part of the page. @type {Promise<any> | null} */
let loading = null;

/** @returns {Promise<any>} its module */
export function loadCodeMirror() {
  const address = new URL("sambot/codemirror.js", document.baseURI).href;
  loading ??= import(address).catch((error) => {
    // A later try may find the server again.
    loading = null;
    throw error;
  });
  return loading;
}

/**
 * @param {any} cm CodeMirror @param {string} name of the file @param {() => boolean} save a key
 * @returns {any[]} extensions
 */
export function lookOf(cm, name, save) {
  return [
    cm.lineNumbers(),
    cm.highlightActiveLineGutter(),
    cm.highlightSpecialChars(),
    cm.history(),
    cm.foldGutter(),
    cm.drawSelection(),
    cm.EditorState.allowMultipleSelections.of(true),
    cm.indentOnInput(),
    cm.syntaxHighlighting(colors(cm)),
    cm.bracketMatching(),
    cm.closeBrackets(),
    cm.highlightActiveLine(),
    cm.highlightSelectionMatches(),
    cm.search({ top: true }),
    cm.lintGutter(),
    cm.EditorState.tabSize.of(2),
    language(cm, name),
    completion(cm, name),
    cm.keymap.of([
      { key: "Mod-s", run: save, preventDefault: true },
      { key: "Ctrl-g", run: cm.gotoLine },
      ...cm.closeBracketsKeymap,
      ...cm.defaultKeymap,
      ...cm.searchKeymap,
      ...cm.historyKeymap,
      ...cm.foldKeymap,
      ...cm.completionKeymap,
      ...cm.lintKeymap,
      cm.indentWithTab,
    ]),
    cm.EditorView.contentAttributes.of({ "aria-label": `Text of ${name}` }),
  ];
}

/** @param {any} cm @param {string} name */
function language(cm, name) {
  if (/\.py$/.test(name)) return cm.python();
  if (/\.(yaml|yml|rviz)$/.test(name)) return cm.yaml();
  return /\.(xacro|urdf|sdf|xml|launch|world)$/.test(name) ? cm.xml() : [];
}

/** Offer the words that the checks know, and the names of the model: those of now, when asked.
 * @param {any} cm @param {string} name */
function completion(cm, name) {
  if (/\.ya?ml$/.test(name)) return cm.autocompletion({ override: [offerKeys] });
  if (!IS_MODEL.test(name)) return cm.autocompletion();
  /** @param {any} context */
  const offer = (context) => {
    const words = rows.data("model/words");
    return words ? cm.completeFromSchema(words, [])(context) : null;
  };
  return cm.autocompletion({ override: [offer] });
}

/** Offer keys and values of a parameter file. @param {any} context */
function offerKeys({ state, pos, explicit }) {
  const words = rows.data("model/words");
  const found = words && offeredIn(state.sliceDoc(0, pos), words);
  if (!found || (!explicit && found.from === pos)) return null;
  const { from, labels, ends } = found;
  const options = labels.map((/** @type {string} */ label) => ({ label, apply: label + ends }));
  return { from, options, validFor: /^[\w:./]*$/ };
}

/** @param {any} cm */
function colors(cm) {
  const { tags } = cm;
  /** @param {any} tag @param {string} color */
  const of = (tag, color) => ({ tag, color: `var(--code-${color})` });
  return cm.HighlightStyle.define([
    of([tags.tagName, tags.keyword, tags.typeName], "tag"),
    of([tags.attributeName, tags.propertyName, tags.definition(tags.propertyName)], "name"),
    of([tags.attributeValue, tags.string, tags.number, tags.bool], "value"),
    of([tags.comment, tags.processingInstruction, tags.documentMeta], "comment"),
    of([tags.invalid], "invalid"),
  ]);
}
