// @ts-check
/* The dialogs of the page: one at a time, over everything else, closed by Esc. */

import { html, useEffect, useLayoutEffect, useRef } from "../vendor/preact.js";
import { StopRobot } from "../panels/live_drive.js";
import { Cell, useData } from "../state.js";

/** @typedef {(props: {close: () => void}) => any} Content */

/** The dialog that is open. @type {Cell<{content: Content, number: number} | null>} */
const open = new Cell(/** @type {{content: Content, number: number} | null} */ (null));
let count = 0;
/** What is done once the dialog is gone. @type {(() => void) | null} */
let after = null;
/** What had the focus before. @type {Element | null} */
let before = null;

/** Show a dialog in place of the one that is open. @param {Content} content */
export function show(content) {
  if (!open.value) before = document.activeElement;
  open.set({ content, number: ++count });
}

/** When the dialog that is open closes, do something in the window, which has the focus for it.
 * @param {() => void} does */
export function leaveFor(does) {
  after = does;
}

/** The place of the dialogs in the window. */
export function Dialogs() {
  const now = open.use();
  useEffect(() => {
    if (now) return;
    const does = after;
    after = null;
    if (does) {
      before = null;
      if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
      return does();
    }
    if (
      before instanceof HTMLElement &&
      before.isConnected &&
      document.activeElement === document.body
    )
      before.focus();
    before = null;
  }, [now]);
  if (!now) return null;
  const close = () => {
    if (open.value === now) open.set(null);
  };
  return html`<${now.content} key=${now.number} close=${close} />`;
}

/**
 * The frame of a dialog: its title, and a form that Enter submits.
 * @param {{title: string, close: () => void, submit?: () => void, wide?: boolean, look?: string,
 *   children?: any}} props
 *   look: a class of its own
 */
export function Dialog({ title, close, submit, wide, look = "", children }) {
  /** @type {Ref<HTMLDialogElement>} */
  const element = useRef(null);
  const over = useRef(false);
  const label = useRef(`dialog${count}-title`).current;
  useLayoutEffect(() => {
    const dialog = element.current;
    dialog.showModal();
    dialog.querySelector("[data-first]")?.focus();
    return () => {
      // Its event comes when another dialog may be open already.
      over.current = true;
      dialog.close();
    };
  }, []);
  /** No key of the window acts while a dialog is open. @param {KeyboardEvent} event */
  const key = (event) => event.stopPropagation();
  return html`<dialog class=${wide ? "wide-dialog" : look} aria-labelledby=${label} ref=${element}
    onClose=${() => {
      if (!over.current) close();
    }}
      onKeyDown=${key} onKeyUp=${key}>
    <form onSubmit=${(/** @type {Event} */ event) => {
      event.preventDefault();
      submit?.();
    }}>
      <h2 id=${label}>${title}</h2>
      ${children}
    </form>
    <${StopRobot} />
  </dialog>`;
}

/**
 * What the server says to an action of a dialog, from the last try on.
 * @param {string} action such as "file/save-as"
 * @returns {{refused?: string, answer?: any, begin: () => void}} `begin` is called before each try
 */
export function useAnswer(action) {
  const [kind] = action.split("/");
  const notice = useData("notice"),
    answer = useData(`${kind}/answer`);
  const seen = useRef({ notice: notice?.number || 0, answer: answer?.number || 0 });
  const begin = () => {
    seen.current = { notice: notice?.number || 0, answer: answer?.number || 0 };
  };
  const refused =
    notice?.number > seen.current.notice && notice.row === action ? notice.text : undefined;
  const own =
    answer?.number > seen.current.answer && `${kind}/${answer.to}` === action ? answer : undefined;
  return { refused, answer: own, begin };
}
